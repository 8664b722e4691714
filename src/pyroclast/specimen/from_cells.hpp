#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Largest distance of a vertex that a file rounds from the straight side on which it lies, and of a corner
/// that bends inwards from the line between its neighbours, over the size of a block. Coordinates in single
/// precision are off a line by up to 1.1e-7 of the body, as measured: in the plane 1e-4 of one of 800,000
/// blocks. Nine digits are a hundred times finer.
inline constexpr double kOffSide = 1e-4;

/// Distance that twelve decimals, or computing alone, leave between a vertex and its side, as a share of the
/// body's size: vertices stay where they are no farther from it.
inline constexpr double kExact = 1e-12;

/// Lays vertices that lie off a straight side of the outline by no more than `kOffSide` onto it: the line
/// between its corners. Sides of a rectangle become level and upright, and begin at 0 where they nearly do.
/// Vertices that are off by no more than twelve decimals leave stay; so do all where the cells have no
/// outline, as `outline_of` tells.
void lay_on_sides(Cells<2>& tessellation);

/// Returns the outline of cells: its outer loop and its holes, with straight sides joined from corner to
/// corner: vertices no farther than `kOffSide` from the line between two others are no corners. Sides of the
/// outer loop are called `side_1`, `side_2`, ... from its lowest corner on (of several the leftmost), those
/// of each hole `hole_1`, ...; those of a rectangle along the axes `bottom`, `right`, `top`, `left`. Throws
/// Error when the cells are not one piece (`describe_pieces`), or meet in a point alone; the message says
/// whether vertices could be joined (`describe_joinable`).
Region outline_of(const Cells<2>& tessellation, const Numbering& numbering = {});

/// Tests the lists that cells bring along, in the plane or in space. Throws Error, naming the cell, counted
/// from 0, when there are no cells, when a list has another length, and when a cell is of a phase that does
/// not exist, has a size that is not above 0, or a stone below -1.
/// \param cells  number of cells
/// \param size   size that each was to have, or empty
/// \param grain  stone of each, or empty
void require_lists(std::size_t cells, const std::vector<std::string>& phases, const std::vector<int>& phase,
                   const std::vector<double>& size, const std::vector<int>& grain);

/// Turns cells counter-clockwise. Throws Error, naming the cell, counted from 0, when a cell names a vertex
/// that does not exist, and as `require_lists`.
GivenCells<2> checked(GivenCells<2> cells);

/// Makes a specimen of cells that come from elsewhere, in either sense. Throws Error as `checked`, and when a
/// cell is not convex, or does not fit together with its neighbours.
Specimen<2> specimen_from(GivenCells<2> cells);
/// Makes a specimen of cells in the plane or in space whose outline, perhaps with patches, is known. Throws
/// Error as above, in space when the cells do not fill the body.
template <int Dim>
Specimen<Dim> specimen_from(GivenCells<Dim> cells, const OutlineOf<Dim>& outline);

}  // namespace pyroclast::specimen
