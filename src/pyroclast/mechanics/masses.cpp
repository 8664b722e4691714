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

}  // namespace

template <int Dim>
void Masses<Dim>::measure_stiffness() {
  FlatArray<double> scratch = body_.make_scratch();
  body_.step.passes.sum_stiffness(body_.state, scratch.data());
  body_.stiffness.resize(body_.model.position.size());
  for (int g = 0; g < body_.model.gridpoint_count(); ++g)
    body_.stiffness[g] = body_.state.stiffness[body_.layout.gridpoint_slot[g]];
  if constexpr (Dim == 2)
    if (body_.found) FoundContacts(body_).add_stiffness(body_.stiffness);
  set_least_force();
}

/// Sets the sum of the forces that a strain of kNoStrain puts on all gridpoints.
template <int Dim>
void Masses<Dim>::set_least_force() {
  body_.least_force = kNoStrain * body_.mean_height *
                      chunked_sum(body_.layout.chunks.gridpoints, [&](int g) { return body_.stiffness[g]; });
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

  if (body_.parameters.mass == MassChoice::real) {
    body_.mass = body_.gravity_mass;
    body_.moving_mass = body_.real_mass;
    body_.state.time_step = real_mass_limit().step;
    set_step_over_mass();
  } else {
    scale();
  }
}

/// Returns the mass with which a gridpoint's own limit is the common step (density scaling).
template <int Dim>
double Masses<Dim>::scaled_mass(int gridpoint) const {
  const double half = 0.5 * body_.parameters.time_step / body_.parameters.safety;
  return body_.stiffness[gridpoint] * (1.0 + body_.parameters.local_damping) * half * half;
}

template <int Dim>
void Masses<Dim>::scale() {
  body_.state.time_step = body_.parameters.time_step;
  body_.mass.resize(body_.stiffness.size());
  // the half step already begun had the old mass; nothing moves yet when the first masses are made
  body_.books.begun_mass_scaling += chunked_sum(body_.layout.chunks.gridpoints, [&](int g) {
    const Vec<Dim> v = Reader<Dim>(body_).velocity(g);
    return 0.5 * (scaled_mass(g) - body_.mass[g]) * dot(v, v);
  });
  set_moving_mass();
}

template <int Dim>
void Masses<Dim>::set_moving_mass() {
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) body_.mass[g] = scaled_mass(g);
  forget_gone();
}

template <int Dim>
void Masses<Dim>::forget_gone() {
  for (int g = 0; g < body_.model.gridpoint_count(); ++g)
    if (body_.gravity_mass[g] == 0.0) body_.mass[g] = 0.0;
  body_.moving_mass = chunked_sum(body_.layout.chunks.gridpoints, [&](int g) { return body_.mass[g]; });
  set_step_over_mass();
}

template <int Dim>
void Masses<Dim>::set_step_over_mass() {
  auto& step_over_mass = body_.arrays.step_over_mass;
  std::fill(step_over_mass.begin(), step_over_mass.end(), 1.0);  // idle slots never move
  for (std::size_t g = 0; g < body_.mass.size(); ++g)
    if (body_.mass[g] > 0.0)
      step_over_mass[body_.layout.gridpoint_slot[g]] = body_.time_step() / body_.mass[g];
  if constexpr (Dim == 2)
    if (body_.found) FoundContacts(body_).follow_masses();
}

template <int Dim>
TimeStepLimit Masses<Dim>::real_mass_limit() const {
  // Local damping multiplies a force that opposes motion by up to 1 + lambda, which acts as stiffness.
  TimeStepLimit limit{std::numeric_limits<double>::infinity(), 0};
  const auto [first, last] = body_.layout.chunks.gridpoints.own();
  for (int g = first; g < last; ++g) {
    if (body_.gravity_mass[g] == 0.0) continue;  // gone
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
  set_least_force();
  if (body_.parameters.mass == MassChoice::scaled)
    set_moving_mass();
  else
    forget_gone();
}

template class Masses<2>;
template class Masses<3>;

}  // namespace pyroclast
