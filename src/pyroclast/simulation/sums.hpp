#pragma once

#include <vector>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// One component of sums over sets of gridpoints, see GridpointSet.
namespace pyroclast {

/// Mean displacement, m.
template <int Dim>
double mean_displacement(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  return mechanics.mean_displacement(mechanics.set_of(set))[axis];
}

/// Mean position in the reference configuration, m.
template <int Dim>
double mean_position(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  const GridpointSet ordered = mechanics.set_of(set);
  const double sum = chunked_sum(
      ordered.chunks, [&](int i) { return mechanics.model().position[ordered.gridpoints[i]][axis]; });
  return sum / static_cast<double>(set.size());
}

/// Sum of all forces at the last step, N; on held gridpoints minus the reaction.
template <int Dim>
double total_force(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  return mechanics.total_force(mechanics.set_of(set))[axis];
}

/// Sum of the forces that were applied from outside, N.
template <int Dim>
double total_applied_force(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  return mechanics.total_applied_force(mechanics.set_of(set))[axis];
}

}  // namespace pyroclast
