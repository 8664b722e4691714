#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Blocks of a specimen before superposition.
struct Blocks {
  Tessellation tessellation;
  /// Phase of each block, index into `BlockParameters::phases`; empty where not known.
  std::vector<int> phase;
  /// Grain of which each block is, index into the grains, -1: of none; empty where blocks do not follow
  /// grains.
  std::vector<int> grain;
  /// Size that each block was to have, m; empty where blocks are alike.
  std::vector<double> size;
  int edges_removed, edges_left_short;
  int seeds_redrawn;
  int rounds;  ///< number of tessellations made
};

/// Draws seeds and tessellates the region, or takes `parameters.tessellation`, and regularises. Seeds whose
/// block cannot be made fit are drawn anew and the tessellation is made again, until all blocks are fit. The
/// blocks are numbered by place (number_along_curve), not in the order of the seeds or of
/// `parameters.tessellation`. Throws Error when the blocks are not valid at the end; it names the side of the
/// outline with invalid blocks.
/// \param team  as for make_specimen
/// \param grains  grains whose surfaces blocks follow
Blocks make_blocks(const BlockParameters& parameters, const Region& region, Random& random,
                   Team* team = nullptr, std::span<const Aggregate> grains = {});

}  // namespace pyroclast::specimen
