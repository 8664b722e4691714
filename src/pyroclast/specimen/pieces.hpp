#pragma once

#include <span>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Describes cells that are not joined by edges: the number of their pieces, one cell of the smallest and its
/// place. Empty where the cells are one piece.
/// \param edges  edges of the tessellation
std::string describe_pieces(const Tessellation& tessellation, std::span<const Edge> edges,
                            const Numbering& numbering);

/// Says how many vertices coincide and how many lie in edges of cells that do not have them as corners, and
/// by which distance `joined` joins them. The text goes behind another sentence.
std::string describe_joinable(const Tessellation& tessellation);

/// Joins cells that lie beside each other and do not share vertices.
///
/// Vertices nearer to each other than `distance` (m) become the first of them. A vertex that then lies nearer
/// than `distance` to an edge of a cell, and not at its ends, is moved onto the edge and becomes a corner of
/// the cell. Vertices that no cell has any more are dropped. Throws Error, naming the cell, where two corners
/// of a cell are as near to each other.
Cells joined(Cells cells, double distance);

}  // namespace pyroclast::specimen
