#pragma once

#include <cstddef>
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

/// Describes pieces of cells that are not joined by facets: their number, one cell of the smallest and its
/// place. Empty where the cells are one piece.
/// \param facets  facets of the cells
template <int Dim>
std::string describe_pieces(const Cells<Dim>& cells, std::span<const Facet<Dim>> facets,
                            const Numbering& numbering = {});

/// Says how many vertices coincide and how many lie in edges of cells that do not have them as corners, and
/// by which distance `joined` joins them. The text goes behind another sentence.
std::string describe_joinable(const Cells<2>& cells);

/// Joins cells that lie beside each other and do not share vertices.
///
/// Vertices nearer to each other than `distance` (m) become the first of them. A vertex that then lies nearer
/// than `distance` to an edge of a cell, and not at its ends, is moved onto the edge and becomes a corner of
/// the cell. Vertices that no cell has any more are dropped. Throws Error, naming the cell, where two corners
/// of a cell are as near to each other.
GivenCells<2> joined(GivenCells<2> cells, double distance);

/// Joins cells: vertices nearer to each other than `distance` (m) become the first of them, and faces that
/// then have the same corners in turn, in either sense, the first of them. Vertices and faces that no cell
/// has any more are dropped. Throws Error, naming the face, where two corners of a face are as near to each
/// other. Returns the number that each face had.
///
/// \param cells  cells whose faces have corners, and no neighbours yet
std::vector<int> join(Cells<3>& cells, double distance);

/// Says how many vertices coincide, how many faces then have the corners of another, and by which distance
/// `join` joins them. The text goes behind another sentence.
std::string describe_joinable(const Cells<3>& cells);

}  // namespace pyroclast::specimen
