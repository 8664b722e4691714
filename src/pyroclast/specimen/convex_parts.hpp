#pragma once

#include <vector>

#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {

/// Largest angle of a corner that counts as straight, radians beyond pi: coordinates of a file have twelve
/// decimals, so a corner on a straight line may bend inwards by this much.
inline constexpr double kInwards = 1e-6;

/// Cuts a simple polygon, counter-clockwise, from corner to corner into convex parts. Returns the numbers of
/// the corners of each part, counter-clockwise; one part where the polygon is convex. Among the cuts at a
/// corner that bends inwards it takes the one that leaves the widest angles. A polygon that cannot be cut,
/// since its sides cross, stays as it is.
std::vector<std::vector<int>> convex_parts(Corners polygon);

}  // namespace pyroclast::specimen
