#pragma once

#include <cstddef>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Numbers cells along a Hilbert curve over a box, and vertices in the order in which the cells meet them.
/// Geometry and each cell's own order stay. Blocks that lie together then stand together in memory; the time
/// of a step depends on this once a specimen has outgrown the caches. Returns the former number of each cell,
/// in the new order.
std::vector<std::size_t> number_along_curve(Cells<2>& cells, const Box& box);

}  // namespace pyroclast::specimen
