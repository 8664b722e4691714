#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns Fuller's curve rescaled to the coarse range: the share of the coarse aggregate that passes a sieve
/// of this size, 0 at d_min and 1 at d_max (paper, Eq. 16).
double fuller_passing(const AggregateParameters& parameters, double size);

/// Returns the share that passes by the grading curve asked for: the stated one, straight between its sieves,
/// or Fuller's.
double passing(const AggregateParameters& parameters, double size);

/// Draws stones (largest first, at the origin) with a total extent of `fraction` times that of the specimen
/// (m², in space m³). Each size interval takes the extent that the grading curve gives it, largest interval
/// first; within an interval sizes follow the curve too. Extent that an interval cannot use goes to the next
/// interval that has a share; the total is off by at most half that of the smallest aggregate.
template <int Dim>
std::vector<Stone<Dim>> draw_stones(const AggregateParameters& parameters, double specimen_extent,
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
                                      const std::vector<Stone<Dim>>& aggregates,
                                      std::span<const double> sizes);

}  // namespace pyroclast::specimen
