#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// The sides of the rectangle [0, width] x [0, height] on which a point lies exactly, one bit each.
std::uint8_t sides(const Vec<2>& point, double width, double height);

/// The corners of a cell in its order, m.
void corners(const Tessellation& tessellation, std::size_t cell, std::vector<Vec<2>>& result);

/// Cells, ascending, with fewer than three vertices or an edge that has neither a partner running the other
/// way nor lies on a side of the rectangle. When there are none and all areas are positive, the cells tile
/// the rectangle without gap or overlap.
std::vector<int> mismatched_cells(const Tessellation& tessellation, double width, double height);

/// Throws Error when the cells do not tile [0, width] x [0, height], or when a cell is not convex or has a
/// zone without area. `origin` names the tessellation in the message.
void require_valid(const Tessellation& tessellation, double width, double height, const std::string& origin);

}  // namespace pyroclast::specimen
