#pragma once

#include <utility>

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
void lay_on_sides(Cells<2>& cells);

/// Returns the outline of cells: its outer loop and its holes, with straight sides joined from corner to
/// corner: vertices no farther than `kOffSide` from the line between two others are no corners. Sides of the
/// outer loop are called `side_1`, `side_2`, ... from its lowest corner on (of several the leftmost), those
/// of each hole `hole_1`, ...; those of a rectangle along the axes `bottom`, `right`, `top`, `left`. Throws
/// Error when the cells are not one piece (`describe_pieces`), or meet in a point alone; the message says
/// whether vertices could be joined (`describe_joinable`).
Region outline_of(const Cells<2>& cells, const Numbering& numbering = {});

/// Turns cells counter-clockwise. Throws Error, naming the cell, counted from 0, when there are no cells,
/// when a list has another length, when a cell names a vertex that does not exist, or one twice, and when it
/// is of a phase that does not exist, has a size that is not above 0, or a stone below -1.
GivenCells<2> checked(GivenCells<2> cells);

/// Completes cells that come from elsewhere, whose vertices, cells and lists alone are known, in space also
/// the corners of faces, in either sense, and the outline: joins them (`joined`, `join`), finds neighbours,
/// turns cells and faces, and lays vertices that a file rounds onto the sides, see kOffSide; in the plane
/// finds the outline. Throws Error as `checked`, when the cells are in several pieces, and in space when a
/// face on the surface lies on none of the sides; the message then says whether vertices could be joined.
/// \param join  distance below which vertices are joined, m; 0: none
GivenCells<2> completed(GivenCells<2> cells, double join = 0.0);
GivenCells<3> completed(GivenCells<3> cells, double join = 0.0);

/// Makes a specimen of cells that are complete. Throws Error when a cell is not convex, or does not fit
/// together with its neighbours, or when the cells do not fill their outline.
template <int Dim>
Specimen<Dim> specimen_from(GivenCells<Dim> cells);

}  // namespace pyroclast::specimen
