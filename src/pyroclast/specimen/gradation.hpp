#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns the extent of a round stone, from its diameter: the area of a circle, m², or the volume of a ball,
/// m³.
template <int Dim>
double extent_of_round(double diameter) {
  if constexpr (Dim == 2)
    return 0.25 * std::numbers::pi * diameter * diameter;
  else
    return std::numbers::pi / 6.0 * diameter * diameter * diameter;
}

/// Returns the area of a circle, from its diameter.
inline double circle_area(double diameter) {
  return extent_of_round<2>(diameter);
}

/// Returns Fuller's curve rescaled to the coarse range: the share of the coarse aggregate that passes a sieve
/// of this size, 0 at d_min and 1 at d_max (paper, Eq. 16).
double fuller_passing(const AggregateParameters& parameters, double size);

/// Returns the share that passes by the grading curve asked for: the stated one, straight between its sieves,
/// or Fuller's.
double passing(const AggregateParameters& parameters, double size);

/// Draws diameters (m, largest first) with a total extent of `fraction` times that of the specimen (m², in
/// space m³). Each size interval takes the extent that the grading curve gives it, largest interval first;
/// within an interval sizes follow the curve too. Extent that an interval cannot use goes to the next
/// interval that has a share; the total is off by at most half that of the smallest aggregate.
template <int Dim>
std::vector<double> draw_diameters(const AggregateParameters& parameters, double specimen_extent,
                                   Random& random);

/// Point of the grading curves, both rescaled to the coarse range.
struct GradationPoint {
  double size;              ///< m
  double passing_asked;     ///< % of the aggregate, by the curve asked for
  double passing_realised;  ///< % of the aggregate, the stones as placed
};

/// Returns the realised grading curve beside the one asked for at the given sizes (m, within [d_min, d_max]),
/// for plots like the paper's Fig. 5. Throws Error when there are no aggregates.
template <int Dim>
std::vector<GradationPoint> gradation(const AggregateParameters& parameters,
                                      const std::vector<RoundStone<Dim>>& aggregates,
                                      std::span<const double> sizes);

}  // namespace pyroclast::specimen
