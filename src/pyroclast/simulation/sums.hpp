#pragma once

#include <vector>

#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// Mean of one component of the displacements of a set of gridpoints, m.
template <int Dim>
double mean_displacement(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  double sum = 0.0;
  for (int g : set) sum += mechanics.displacement(g)[axis];
  return sum / static_cast<double>(set.size());
}

/// Mean of one component of the positions of a set of gridpoints in the reference configuration, m.
template <int Dim>
double mean_position(const Model<Dim>& model, const std::vector<int>& set, int axis) {
  double sum = 0.0;
  for (int g : set) sum += model.position[g][axis];
  return sum / static_cast<double>(set.size());
}

/// One component of the sum of all forces on a set of gridpoints at the last step, N; on held gridpoints
/// minus the reaction.
template <int Dim>
double total_force(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  double sum = 0.0;
  for (int g : set) sum += mechanics.force(g)[axis];
  return sum;
}

/// The same of the forces that were applied from outside, N.
template <int Dim>
double total_applied_force(const Mechanics<Dim>& mechanics, const std::vector<int>& set, int axis) {
  double sum = 0.0;
  for (int g : set) sum += mechanics.applied_force(g)[axis];
  return sum;
}

}  // namespace pyroclast
