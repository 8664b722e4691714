#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Distance below which vertices coincide in messages, as a share of the body's size.
inline constexpr double kCoincide = 1e-6;

/// Returns for each vertex the first one that lies nearer than a distance, or the vertex itself.
template <int Dim>
std::vector<int> first_near(std::span<const Vec<Dim>> vertices, double distance);

/// Returns a number for each cell; neighbours, and those that neighbours join, have the same.
/// \param neighbours  pairs of cells that share an edge, in space a face; a pair with -1 joins nothing
std::vector<int> pieces_of(std::size_t cells, std::span<const std::pair<int, int>> neighbours);

/// Describes pieces of cells: their number, one cell of the smallest and its place. Empty where the cells are
/// one piece.
/// \param piece   number of the piece of each cell
/// \param shared  word for the parts that neighbours share, "edge" or "face"
/// \param cell    function that names a cell and its place
std::string describe_pieces(const std::vector<int>& piece, const char* shared,
                            const std::function<std::string(int)>& cell);

/// Describes cells of the plane that are not joined by edges.
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
