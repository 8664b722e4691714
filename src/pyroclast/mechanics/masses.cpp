#include "pyroclast/mechanics/masses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/mechanics/found/found_contacts.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Strain whose forces count as none beside the forces that a body bears: some 3 Pa in concrete.
constexpr double kNoStrain = 1e-10;
/// Growth of a gridpoint's stiffness from which on scaled masses follow. A safety of 0.8 bears so much.
constexpr double kMuchStiffer = 1.5;

}  // namespace

template <int Dim>
void Masses<Dim>::measure_stiffness() {
  FlatArray<double> scratch = body_.make_scratch();
  body_.step.passes.sum_stiffness(body_.state, scratch.data());
  body_.stiffness.resize(body_.model.position.size());
  for (int g = 0; g < body_.model.gridpoint_count(); ++g)
    body_.stiffness[g] = body_.state.stiffness[body_.layout.gridpoint_slot[g]];
  if (body_.found) FoundContacts<Dim>(body_).add_stiffness(body_.stiffness);
}

template <int Dim>
void Masses<Dim>::follow_stiffness() {
  if (!are_scaled()) return;
  std::vector<double> before = body_.stiffness;
  measure_stiffness();
  bool is_stiffer = false;
  for (std::size_t g = 0; g < before.size(); ++g)
    is_stiffer = is_stiffer || body_.stiffness[g] > kMuchStiffer * before[g];
  if (!body_.model.ranks().any(is_stiffer)) {
    body_.stiffness = std::move(before);
    return;
  }
  const std::vector<double> mass_before = scale();
  take(body_.model.ranks().together([&] { return sums(mass_before); }));
}

template <int Dim>
void Masses<Dim>::set(const std::vector<double>& densities) {
  body_.gravity_mass.assign(body_.model.position.size(), 0.0);
  for (int b = 0; b < body_.model.block_count(); ++b)
    for (int z = body_.model.block_zones[b]; z < body_.model.block_zones[b + 1]; ++z)
      for (int g : body_.model.zones[z])
        body_.gravity_mass[g] +=
            densities[body_.model.block_material[b]] * body_.geometry.volume[z] / (Dim + 1);
  body_.real_mass = chunked_sum(body_.layout.chunks.gridpoints, [&](int g) { return body_.gravity_mass[g]; });
  if (norm(body_.parameters.gravity) > 0.0) {
    body_.arrays.real_mass = body_.template made<double>(body_.arrays.displacement.size());
    for (int g = 0; g < body_.model.gridpoint_count(); ++g)
      body_.arrays.real_mass[body_.layout.gridpoint_slot[g]] = body_.gravity_mass[g];
    body_.refresh_views();
  }

  if (!are_scaled()) {
    body_.mass = body_.gravity_mass;
    body_.moving_mass = body_.real_mass;
    body_.state.time_step = real_mass_limit().step;
  }
  const std::vector<double> before = scale();
  take(body_.model.ranks().together([&] { return sums(before); }));
  if (!are_scaled()) set_step_over_mass();
}

/// Returns the mass with which a gridpoint's own limit is the common step (density scaling).
template <int Dim>
double Masses<Dim>::scaled_mass(int gridpoint) const {
  const double half = 0.5 * body_.parameters.time_step / body_.parameters.safety;
  return body_.stiffness[gridpoint] * (1.0 + body_.parameters.local_damping) * half * half;
}

template <int Dim>
std::vector<double> Masses<Dim>::scale() {
  if (!are_scaled()) return body_.mass;
  body_.state.time_step = body_.parameters.time_step;
  body_.mass.resize(body_.stiffness.size());
  std::vector<double> before = body_.mass;
  for (int g = 0; g < body_.model.gridpoint_count(); ++g)
    body_.mass[g] = body_.has_left(g) ? 0.0 : scaled_mass(g);
  return before;
}

template <int Dim>
void Masses<Dim>::forget_gone() {
  for (int g = 0; g < body_.model.gridpoint_count(); ++g)
    if (body_.has_left(g)) body_.mass[g] = 0.0;
  body_.moving_mass = chunked_sum(body_.layout.chunks.gridpoints, [&](int g) { return body_.mass[g]; });
  set_step_over_mass();
}

template <int Dim>
MassSums Masses<Dim>::sums(const std::vector<double>& before) const {
  const ChunkList& gridpoints = body_.layout.chunks.gridpoints;
  MassSums all;
  all.stiffness = chunked_sum(gridpoints, [&](int g) { return body_.stiffness[g]; });
  if (Ranks& ranks = body_.model.ranks(); body_.found && ranks.count() > 1) {
    const auto [first, last] = gridpoints.own();
    all.of_owners =
        ranks.collect(std::vector<double>(body_.stiffness.begin() + first, body_.stiffness.begin() + last));
  }
  if (!are_scaled()) return all;
  all.moving = chunked_sum(gridpoints, [&](int g) { return body_.mass[g]; });
  all.scaling = chunked_sum(gridpoints, [&](int g) {
    const Vec<Dim> v = Reader<Dim>(body_).velocity(g);
    return 0.5 * (body_.mass[g] - before[g]) * dot(v, v);
  });
  return all;
}

template <int Dim>
void Masses<Dim>::take(const MassSums& sums) {
  body_.least_force = kNoStrain * body_.mean_height * sums.stiffness;
  if (!sums.of_owners.empty()) {
    body_.stiffness = sums.of_owners;
    scale();
  }
  if (are_scaled()) {
    body_.moving_mass = sums.moving;
    // the half step already begun had the old mass; nothing moves yet when the first masses are made
    body_.books.begun_mass_scaling += sums.scaling;
    set_step_over_mass();
  }
}

template <int Dim>
void Masses<Dim>::set_step_over_mass() {
  auto& step_over_mass = body_.arrays.step_over_mass;
  std::fill(step_over_mass.begin(), step_over_mass.end(), 1.0);  // idle slots never move
  for (std::size_t g = 0; g < body_.mass.size(); ++g)
    if (!body_.has_left(static_cast<int>(g)))
      step_over_mass[body_.layout.gridpoint_slot[g]] = body_.time_step() / body_.mass[g];
  if (body_.found) FoundContacts<Dim>(body_).follow_masses();
}

template <int Dim>
TimeStepLimit Masses<Dim>::real_mass_limit() const {
  // Local damping multiplies a force that opposes motion by up to 1 + lambda, which acts as stiffness.
  TimeStepLimit limit{std::numeric_limits<double>::infinity(), 0};
  const auto [first, last] = body_.layout.chunks.gridpoints.own();
  for (int g = first; g < last; ++g) {
    if (body_.has_left(g)) continue;
    const double step =
        body_.parameters.safety * 2.0 *
        std::sqrt(body_.gravity_mass[g] / (body_.stiffness[g] * (1.0 + body_.parameters.local_damping)));
    if (step < limit.step) limit = {step, g};
  }
  limit.step = body_.model.ranks().least(limit.step);
  return limit;
}

template <int Dim>
void Masses<Dim>::follow_state() {
  scale();
  take(body_.model.ranks().together([&] { return sums(body_.mass); }));
  if (!are_scaled()) forget_gone();
}

template class Masses<2>;
template class Masses<3>;

}  // namespace pyroclast
