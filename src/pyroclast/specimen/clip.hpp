#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/region.hpp"

namespace pyroclast::specimen {

/// Cuts off the part of a convex cell that lies beyond the outline.
/// \param polygon  counter-clockwise, in the lengths of the pieces
/// \param seed     point in the body
/// \param pieces   pieces of the outline, the body on their left
/// \return false where the cell reaches through a hole, a notch or around a corner into another part of the
///         body: then the polygon is of no use
bool clip(std::vector<Vec<2>>& polygon, const Vec<2>& seed, std::span<const Piece> pieces, double tolerance);

}  // namespace pyroclast::specimen
