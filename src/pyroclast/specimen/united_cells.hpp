#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Makes one cell of each group of cells. A vertex that only this cell and one other have afterwards goes, so
/// the edge between both is straight. A group whose cell would not be convex, has a hole or is in pieces, or
/// whose vertices hold another cell together stays as it is. \param groups  numbers of cells, ascending
/// \return for each cell left the number that it had, or that the first of its group had
std::vector<int> unite(Cells<2>& cells, const std::vector<std::vector<int>>& groups);

}  // namespace pyroclast::specimen
