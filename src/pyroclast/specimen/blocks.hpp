#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Blocks of a specimen before superposition.
template <int Dim>
struct Blocks {
  Cells<Dim> cells;
  /// Phase of each block, index into `BlockParameters::phases`; empty where not known.
  std::vector<int> phase;
  /// Stone of which each block is, index into the stones, -1: of none; empty where blocks do not follow
  /// stones.
  std::vector<int> stone;
  /// Size that each block was to have, m; empty where blocks are alike.
  std::vector<double> size;
  Metrics<Dim> done;  ///< counts of what has been done to the blocks
  int rounds = 0;     ///< number of tessellations made
};

/// Returns the sizes of blocks that are asked for.
template <int Dim>
BlockSizes sizes_of(const BlockParameters& parameters, const OutlineOf<Dim>& outline) {
  return {side_of<Dim>(outline.extent() / parameters.count), parameters.largest_size, parameters.finer};
}

/// Draws seeds and tessellates the region, or takes `parameters.cells`, and regularises. Seeds whose
/// block cannot be made fit are drawn anew and the tessellation is made again, until all blocks are fit. The
/// blocks are numbered by place (number_along_curve), not in the order of the seeds or of
/// `parameters.cells`. Throws Error when the blocks are not valid at the end; it names the side of the
/// outline with invalid blocks.
/// \param team  as for make_specimen
/// \param stones  stones whose surfaces blocks follow
Blocks<2> make_blocks(const BlockParameters& parameters, const Region& region, Random& random,
                      Team* team = nullptr, std::span<const Stone<2>> stones = {});
/// Draws seeds that keep their distance, tessellates the body and regularises. Seeds whose cells fail are
/// drawn anew. Where blocks follow stones, these are followed larger or smaller until the volumes of their
/// blocks are right.
Blocks<3> make_blocks(const BlockParameters& parameters, const Prism& body, Random& random,
                      Team* team = nullptr, std::span<const Stone<3>> stones = {});

}  // namespace pyroclast::specimen
