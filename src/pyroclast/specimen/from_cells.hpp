#pragma once

#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// The outline of cells: its outer loop and its holes, with straight sides joined from corner to corner.
/// Sides of the outer loop are called `side_1`, `side_2`, ... from its lowest corner on (of several the
/// leftmost), those of each hole `hole_1`, ... Throws Error when the cells are not one piece, or meet in a
/// point alone.
Region outline_of(const Tessellation& tessellation);

/// A specimen of cells that are made elsewhere.
/// \param tessellation  convex cells in either sense, m; neighbours share vertices
/// \param phases        what cells can be made of
/// \param phase         of each cell, index into `phases`
/// Throws Error, naming the cell, counted from 0, when it is not convex, names a vertex or a phase that there
/// is not, or does not fit together with its neighbours.
Specimen specimen_from(Tessellation tessellation, std::vector<std::string> phases, std::vector<int> phase);

}  // namespace pyroclast::specimen
