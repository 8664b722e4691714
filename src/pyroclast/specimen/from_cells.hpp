#pragma once

#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns the outline of cells: its outer loop and its holes, with straight sides joined from corner to
/// corner. Sides of the outer loop are called `side_1`, `side_2`, ... from its lowest corner on (of several
/// the leftmost), those of each hole `hole_1`, ...; those of a rectangle along the axes `bottom`, `right`,
/// `top`, `left`. Throws Error when the cells are not one piece (`describe_pieces`), or meet in a point
/// alone; the message says whether vertices could be joined (`describe_joinable`).
Region outline_of(const Tessellation& tessellation, const Numbering& numbering = {});

/// Turns cells counter-clockwise. Throws Error, naming the cell, counted from 0, when a cell names a vertex
/// or a phase that does not exist.
Cells checked(Cells cells);

/// Makes a specimen of cells that come from elsewhere, in either sense. Throws Error as `checked`, and when a
/// cell is not convex, or does not fit together with its neighbours.
Specimen specimen_from(Cells cells);
/// \param region  outline of the cells, perhaps with patches
Specimen specimen_from(Cells cells, Region region);

}  // namespace pyroclast::specimen
