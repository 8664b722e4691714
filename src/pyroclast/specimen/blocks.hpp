#pragma once

#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// The blocks of a specimen before superposition.
struct Blocks {
  Tessellation tessellation;
  std::vector<int> phase;  ///< of each, index into `BlockParameters::phases`; empty where these are not known
  int edges_removed, edges_left_short;
  int seeds_redrawn;
  int rounds;  ///< tessellations made
};

/// Draws seeds and tessellates the region, or takes `parameters.tessellation`, and regularises.
/// Seeds whose block cannot be made fit are drawn anew and the tessellation is made again, until all are.
/// The blocks are numbered by place (number_along_curve), not in the order of the seeds or of what it takes.
/// \param team  as for make_specimen
/// Throws Error when the blocks are not valid at the end; it names the side of the outline where they are
/// not.
Blocks make_blocks(const BlockParameters& parameters, const Region& region, Random& random,
                   Team* team = nullptr);

}  // namespace pyroclast::specimen
