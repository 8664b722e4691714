#pragma once

#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns the corners of a cell in its order, m.
void corners(const Cells<2>& cells, std::size_t cell, std::vector<Vec<2>>& result);

/// Drops vertices that no cell has, and in space faces. Returns the number that each face had.
void drop_unused(Cells<2>& cells);
std::vector<int> drop_unused(Cells<3>& cells);

/// Returns the edges that one cell alone has, each as the cell runs along it.
std::vector<Facet<2>> free_edges(const Cells<2>& cells);

/// Returns the cells, ascending, with fewer than three vertices or an edge that has neither a partner running
/// the other way nor lies on the outline. When there are none and all areas are positive, the cells tile the
/// region without gap or overlap.
std::vector<int> mismatched_cells(const Cells<2>& cells, const Region& region);

/// Throws Error when the cells do not tile the region, or when a cell is not convex or has a zone without
/// area. `origin` names the tessellation in the message.
void require_valid(const Cells<2>& cells, const Region& region, const std::string& origin,
                   const Numbering& numbering = {});

}  // namespace pyroclast::specimen
