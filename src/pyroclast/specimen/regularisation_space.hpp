#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/polyhedron.hpp"

namespace pyroclast::specimen {

/// Asked of the regularisation of cells.
struct RegularCells {
  double shortest_edge = 0.0;  ///< fraction of the mean edge there below which edges are removed
  double largest_bend = 0.0;   ///< largest bend of a face, see bend(); rad
};

/// What a regularisation has done.
struct RegularisedCells {
  int vertices_merged = 0;   ///< vertices that became one with another
  int edges_left_short = 0;  ///< edges that are still shorter than asked for
};

/// Removes edges shorter than `asked.shortest_edge` times the mean edge by merging their ends, and faces
/// whose corners are as near to each other by merging all of them; then moves vertices, and turns the fans of
/// faces. Each change makes zones rounder, see flatness(); keeps each cell a ball that is cut into zones
/// of positive volume; and bends no face by more than `asked.largest_bend`. Vertices on planes of the body
/// stay on these, so that the body keeps its volume and its sides; those between cells of different stones
/// move along the surface there, and not at all where its faces meet at an edge. The order of all changes is
/// fixed: shortest edges first, then face by face and vertex by vertex. \param plane  plane of the body on
/// which each face lies; -1 within it \param sizes  sizes of blocks: edges and ways are measured by the size
/// of the blocks there \param stone  stone of each cell whose surface blocks follow, -1: of none; empty: they
/// follow none
RegularisedCells regularise(Cells<3>& cells, const Prism& body, const std::vector<int>& plane,
                            const RegularCells& asked, const BlockSizes& sizes = BlockSizes(1.0),
                            std::span<const int> stone = {});

}  // namespace pyroclast::specimen
