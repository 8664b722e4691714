#pragma once

#include <vector>

#include "pyroclast/solid/complex.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::solid {

using Ball = specimen::Grain<3>;

/// Returns the volume that a cell has in common with a ball, m³. Exact up to rounding.
double common_volume(const Complex& complex, std::size_t cell, const Vec<3>& centre, double radius);

/// Result of superposing balls on cells.
struct SuperposedBalls {
  std::vector<int> grain;  ///< ball to which each cell belongs, index into the balls; -1: to the matrix
  /// Covered fraction above which a cell is of its balls, as stated; by `fit` the least one of a cell that
  /// became aggregate because it is covered.
  double covered_fraction = 0.0;
};

/// Superposes balls on cells. By the rule `fit` each ball, the largest first, takes one cell, the one of
/// which it covers most and that no larger ball took; then the cells that are covered most become aggregate.
/// Both end when the volume of the cells comes as near as it can to that of the balls. The other rules are as
/// in the plane.
SuperposedBalls superpose(const Complex& complex, const Prism& body, const std::vector<Ball>& balls,
                          const specimen::SpecimenParameters& parameters);

}  // namespace pyroclast::solid
