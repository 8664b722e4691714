#pragma once

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

/// Result of regularisation.
struct Regularisation {
  int edges_removed;
  /// Edges shorter than asked for that cannot be removed without making a block around them unfit.
  int edges_left_short;
  std::vector<int> unfit;  ///< cells with a sliver, beside a flat corner, or at an edge left short, ascending
};

/// Removes edges shorter than `shortest_edge` times the mean edge (mean of the edges left) by merging their
/// two ends, shortest first. A merge is made only when every block that it touches keeps at least three
/// corners and gets neither a corner above `largest_block_angle` nor a sliver zone that it did not have
/// before. Vertices on the outline or a slit stay on it; its corners and tips stay. The tessellation must be
/// valid and remains so.
/// \param sizes  sizes of the blocks: where blocks are finer, an edge may be shorter in proportion
Regularisation regularise(Cells<2>& tessellation, const Region& region, double shortest_edge,
                          const BlockSizes& sizes = BlockSizes(1.0));

}  // namespace pyroclast::specimen
