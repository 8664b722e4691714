#pragma once

#include <vector>

namespace pyroclast::specimen {

/// Share of all stones that passes a sieve, over the sieve's size; straight between sizes.
struct GradingCurve {
  std::vector<double> sizes;   ///< sizes, strictly ascending, m
  std::vector<double> shares;  ///< shares from 0 up to 1, none falls
};

/// Returns the share that passes a size, m: beyond the sieves that of the nearest.
double share_at(const GradingCurve& curve, double size);

/// Returns the curve of the stones larger than a size (m): 0 there and 1 at its end. Ends without stones are
/// left out. Throws Error where no stone is larger, or the size lies below the curve.
GradingCurve above(const GradingCurve& curve, double d_min);

/// Returns the grading by area of the circles that a plane cuts from spheres of a grading by volume, at more
/// sizes than the curve has. A plane cuts a sphere of diameter D at any distance from its middle alike. So
/// the share 1 - 3/2 u + 1/2 u^3 with u = sqrt(1 - (s / D)^2) of the area of its circles is of circles
/// smaller than s. In all, circles have the share of the area that spheres have of the volume (Delesse 1847).
GradingCurve of_section(const GradingCurve& curve);

}  // namespace pyroclast::specimen
