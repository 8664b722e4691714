#include "pyroclast/mechanics/totals.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/mechanics/found/of_all_pairs.hpp"

namespace pyroclast {

namespace {

/// Returns the sum of a number of found pairs over the whole body: a collective.
/// \param in_pair, in_row  places of the number
template <int Dim>
double sum_of_pairs(const Body<Dim>& body, double FoundPair<Dim>::*in_pair, Line FoundRow<Dim>::*in_row) {
  const auto give = [&](const FoundPair<Dim>& pair, auto add) {
    const double number =
        pair.slot < 0 ? pair.*in_pair
                      : (body.found->arrays.rows[pair.slot / kLanes].*in_row).number[pair.slot % kLanes];
    if (number != 0.0) add(number);
  };
  double sum = 0.0;
  for (const double number : of_all_pairs<double>(body, give)) sum += number;
  return sum;
}

}  // namespace

template <int Dim>
Vec<Dim> Totals<Dim>::mean_displacement(const GridpointSet& set) const {
  const auto sum = chunked_sum<Vec<Dim>>(
      set.chunks, [&](int i, Vec<Dim>& total) { total += read_.displacement(set.gridpoints[i]); });
  return sum * (1.0 / set.whole_count);
}

template <int Dim>
Vec<Dim> Totals<Dim>::net_force() const {
  return chunked_sum<Vec<Dim>>(body_.layout.chunks.gridpoints, [&](int g, Vec<Dim>& total) {
    const Vec<Dim> on_all = read_.force(g);
    for (int i = 0; i < Dim; ++i)
      if (!read_.is_prescribed(g, i)) total[i] += on_all[i];
  });
}

template <int Dim>
Vec<Dim> Totals<Dim>::total_force(const GridpointSet& set) const {
  return chunked_sum<Vec<Dim>>(set.chunks,
                               [&](int i, Vec<Dim>& total) { total += read_.force(set.gridpoints[i]); });
}

template <int Dim>
Vec<Dim> Totals<Dim>::total_applied_force(const GridpointSet& set) const {
  return chunked_sum<Vec<Dim>>(
      set.chunks, [&](int i, Vec<Dim>& total) { total += read_.applied_force(set.gridpoints[i]); });
}

template <int Dim>
Vec<Dim> Totals<Dim>::total_weight(const GridpointSet& set) const {
  return body_.state.gravity *
         chunked_sum(set.chunks, [&](int i) { return body_.gravity_mass[set.gridpoints[i]]; });
}

template <int Dim>
double Totals<Dim>::total_moving_mass(const GridpointSet& set) const {
  return chunked_sum(set.chunks, [&](int i) { return body_.mass[set.gridpoints[i]]; });
}

template <int Dim>
double Totals<Dim>::mobility(const GridpointSet& set, std::span<const double> weights) const {
  return chunked_sum(set.chunks,
                     [&](int i) { return weights[i] * weights[i] / body_.mass[set.gridpoints[i]]; });
}

template <int Dim>
Dissipation Totals<Dim>::dissipated() const {
  struct Sums {
    std::array<double, Body<Dim>::kMostDissipations> energy{};
    void operator+=(const Sums& o) {
      for (std::size_t i = 0; i < energy.size(); ++i) energy[i] += o.energy[i];
    }
  };
  // places of each law's losses among the dissipations; -1 for a loss that is no energy
  std::vector<std::vector<int>> places;
  for (const LawTable* law : body_.laws)
    for (auto& of_law = places.emplace_back(); const LossInfo& loss : law->losses) {
      const int place = place_in(body_.dissipations, std::string_view(loss.name));
      of_law.push_back(place < std::ssize(body_.dissipations) ? place : -1);
    }
  const Sums sums = chunked_sum<Sums>(body_.layout.chunks.face_packs, [&](int pack, Sums& sum) {
    const Line* line = body_.state.loss.data() + body_.state.first_loss[pack];
    for (int point = body_.layout.first_point_of(pack); point < body_.layout.first_point_of(pack + 1);
         ++point) {
      const double* const area = body_.layout.points[point].area;
      for (const int place : places[body_.state.law_of_faces[pack]]) {
        if (place >= 0)
          for (int lane = 0; lane < kLanes; ++lane) sum.energy[place] += line->number[lane] * area[lane];
        ++line;
      }
    }
  });
  Dissipation all{
      body_.dissipations,
      {sums.energy.begin(), sums.energy.begin() + static_cast<std::ptrdiff_t>(body_.dissipations.size())}};
  if (body_.creeps()) all.energies[place_in(all.names, kCreep)] += body_.books.creep_work;
  if (body_.found) {
    const int of_area = place_in(all.names, kContactArea), of_damping = place_in(all.names, kContactDamping);
    struct Lost {
      int law;
      std::array<double, LawOfRows::kMost> of_law;
      double area, damping;
    };
    const auto give = [&](const FoundPair<Dim>& pair, auto add) {
      Lost lost{pair.law, {}, pair.lost_area, pair.lost_damping};
      std::ranges::copy(pair.lost, lost.of_law.begin());
      if (pair.slot >= 0) {
        const FoundRow<Dim>& row = body_.found->arrays.rows[pair.slot / kLanes];
        const int lane = pair.slot % kLanes;
        const Line* const of_law = body_.found->arrays.lost.data() + row.first_loss;
        for (std::size_t i = 0; i < pair.lost.size(); ++i) lost.of_law[i] = of_law[i].number[lane];
        lost.area = row.lost_area.number[lane];
        lost.damping = row.lost_damping.number[lane];
      }
      const auto is_lost = [](double energy) { return energy != 0.0; };
      if (is_lost(lost.area) || is_lost(lost.damping) || std::ranges::any_of(lost.of_law, is_lost)) add(lost);
    };
    for (const Lost& lost : of_all_pairs<Lost>(body_, give)) {
      for (std::size_t i = 0; i < places[lost.law].size(); ++i)
        if (const int place = places[lost.law][i]; place >= 0) all.energies[place] += lost.of_law[i];
      all.energies[of_area] += lost.area;
      if (lost.damping != 0.0) all.energies[of_damping] += lost.damping;
    }
  }
  return all;
}

double Dissipation::of(std::string_view name) const {
  const int place = place_in(names, name);
  return place < std::ssize(names) ? energies[place] : 0.0;
}

double Dissipation::total() const {
  return std::accumulate(energies.begin(), energies.end(), 0.0);
}

template <int Dim>
EnergyLedger Totals<Dim>::energy() const {
  return body_.model.ranks().together([&] { return energies(); });
}

template <int Dim>
EnergyLedger Totals<Dim>::energies() const {
  struct Sums {
    double zones = 0.0, kinetic = 0.0, local_damping = 0.0, viscous_damping = 0.0, loading = 0.0;
    void operator+=(const Sums& o) {
      zones += o.zones;
      kinetic += o.kinetic;
      local_damping += o.local_damping;
      viscous_damping += o.viscous_damping;
      loading += o.loading;
    }
  };
  const auto sums = chunked_sum<Sums>(body_.layout.chunks.bundles, [&](int b, Sums& sum) {
    const BundleSums& of_bundle = body_.state.bundle_sums[b];
    const int c = body_.made_constraints[b];
    sum += {of_bundle.stored, of_bundle.kinetic, of_bundle.damping_work - of_bundle.begun_damping,
            of_bundle.viscous_work - of_bundle.begun_viscous,
            c >= 0 ? body_.state.constraints[c].loading_work - of_bundle.begun_loading : 0.0};
  });
  EnergyLedger e;
  e.property_change = body_.books.property_change;
  e.mass_scaling = body_.books.mass_scaling;
  e.removed = body_.books.removed;
  e.has_pore_pressure = body_.has_pore_pressure();
  e.loses_blocks = body_.parameters.loses_blocks;
  e.zones = sums.zones;
  e.kinetic = sums.kinetic;
  e.local_damping = sums.local_damping;
  e.viscous_damping = sums.viscous_damping;
  e.loading = sums.loading + body_.books.start;
  e.contacts = chunked_sum(body_.layout.chunks.face_packs,
                           [&](int pack) { return body_.state.face_sums[pack].stored; });
  if (body_.found) e.contacts += sum_of_pairs(body_, &FoundPair<Dim>::stored, &FoundRow<Dim>::stored);
  e.dissipated = dissipated();
  // weights are constant, so their work follows from the displacements
  if (body_.state.weighs())
    e.gravity = body_.books.gravity + chunked_sum(body_.layout.chunks.gridpoints, [&](int g) {
                  return body_.gravity_mass[g] * dot(body_.state.gravity, read_.displacement_of_force(g));
                });
  e.pore_pressure = body_.books.pore_pressure + work_of_pore_pressure();
  return e;
}

template <int Dim>
double Totals<Dim>::work_of_pore_pressure() const {
  if (!body_.has_pore_pressure()) return 0.0;
  const auto& contacts = body_.layout.contacts_by_chunk;
  return chunked_sum(body_.layout.chunks.contacts, [&](int i) {
    const int c = contacts[i];
    return body_.properties.work_of_pore_pressure(c, read_.opening(c)) * body_.model.contacts[c].area;
  });
}

template <int Dim>
double Totals<Dim>::mean_unbalanced_force() const {
  return chunked_sum(body_.layout.chunks.bundles,
                     [&](int b) { return body_.state.bundle_sums[b].unbalanced; }) /
         body_.gridpoints_of_whole;
}

template <int Dim>
double Totals<Dim>::unbalanced_ratio() const {
  return body_.model.ranks().together([&] {
    const auto& chunks = body_.layout.chunks;
    const auto& state = body_.state;
    const double unbalanced =
        chunked_sum(chunks.bundles, [&](int b) { return state.bundle_sums[b].unbalanced; });
    double all = chunked_sum(chunks.bundles, [&](int b) { return state.bundle_sums[b].applied; }) +
                 chunked_sum(chunks.face_packs, [&](int pack) { return state.face_sums[pack].applied; });
    if (body_.found) all += sum_of_pairs(body_, &FoundPair<Dim>::applied, &FoundRow<Dim>::applied);
    return unbalanced / std::max(all, body_.least_force);
  });
}

template <int Dim>
double Totals<Dim>::largest_relative_jump() const {
  double largest = 0.0;
  for (const FaceSums& sums : body_.state.face_sums) largest = std::max(largest, sums.jump);
  return body_.model.ranks().largest(largest);
}

template class Totals<2>;
template class Totals<3>;

}  // namespace pyroclast
