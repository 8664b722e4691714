#pragma once

#include <span>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Says of cells that do not hang together by edges how many pieces they are, one cell of the smallest and
/// where it lies. Empty where the cells are one piece.
/// \param edges  of the tessellation
std::string describe_pieces(const Tessellation& tessellation, std::span<const Edge> edges,
                            const Numbering& numbering);

/// Says how many vertices coincide and how many lie in edges of cells that do not have them as corners, and
/// by which distance `joined` joins them; to be put behind another sentence.
std::string describe_joinable(const Tessellation& tessellation);

/// Joins cells that lie beside each other and do not share vertices.
///
/// Vertices nearer to each other than `distance` (m) become the first of them; a vertex that then lies nearer
/// than that to an edge of a cell, and not at its ends, is moved onto the edge and becomes a corner of the
/// cell. Vertices that no cell has any more are dropped. Throws Error, naming the cell, where two corners of
/// a cell are as near to each other.
Cells joined(Cells cells, double distance);

}  // namespace pyroclast::specimen
