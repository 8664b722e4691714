#pragma once

#include <span>
#include <vector>

#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Largest interior angle of a block that regularisation leaves alone, degrees. A flatter corner is hardly a
/// corner, and half a degree is far above rounding.
inline constexpr double largest_block_angle = 179.5;

/// Share of the shortest edge allowed below which the smallest altitude of a zone makes it a sliver. The
/// altitude sets the zone's stable time step as the edge does, so a bound on edges alone would not bound it.
inline constexpr double sliver_share = 0.5;

/// Asked of the regularisation of cells.
struct RegularCells {
  double shortest_edge = 0.0;  ///< fraction of the mean edge there below which edges are removed
  double largest_bend = 0.0;   ///< in space: largest bend of a face, see bend(); rad
};

/// Result of a regularisation.
struct RegularisedCells {
  int vertices_merged = 0;  ///< vertices that became one with another; in the plane as many edges are gone
  /// Edges shorter than asked for that cannot be removed without making a block around them unfit.
  int edges_left_short = 0;
  /// In the plane: cells with a sliver, beside a flat corner, or at an edge left short, ascending.
  std::vector<int> unfit = {};
};

/// Removes edges shorter than `asked.shortest_edge` times the mean edge (mean of the edges left) by merging
/// their two ends, shortest first. A merge is made only when every block that it touches keeps at least three
/// corners and gets neither a corner above `largest_block_angle` nor a sliver zone that it did not have
/// before. Vertices on the outline or a slit stay on it; its corners and tips stay. The tessellation must be
/// valid and remains so.
/// \param sizes  sizes of the blocks: where blocks are finer, an edge may be shorter in proportion
RegularisedCells regularise(Cells<2>& cells, const Region& region, const RegularCells& asked,
                            const BlockSizes& sizes = BlockSizes(1.0));

/// Removes such edges in space, and faces whose corners are as near to each other by merging all of them;
/// then moves vertices, and turns the fans of faces. Each change makes zones rounder, see flatness(); keeps
/// each cell a ball that is cut into zones of positive volume; and bends no face by more than
/// `asked.largest_bend`. Vertices on planes of the body stay on these, so that the body keeps its volume and
/// its sides; those between cells of different stones move along the surface there, and not at all where its
/// faces meet at an edge. Only vertices that nearly touch merge where they lie on surfaces of different
/// stones. The order of all changes is fixed: shortest edges first, then face by face and vertex by vertex.
///
/// \param plane  plane of the body on which each face lies; -1 within it
/// \param sizes  sizes of blocks: edges and ways are measured by the size of the blocks there
/// \param stone  stone of each cell whose surface blocks follow, -1: of none; empty: they follow none
RegularisedCells regularise(Cells<3>& cells, const Prism& body, const std::vector<int>& plane,
                            const RegularCells& asked, const BlockSizes& sizes = BlockSizes(1.0),
                            std::span<const int> stone = {});

}  // namespace pyroclast::specimen
