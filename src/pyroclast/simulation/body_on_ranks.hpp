#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/part.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"
#include "pyroclast/simulation/moving_body.hpp"

namespace pyroclast {

class Simulation;

/// Returns the blocks of other ranks that a part of a body needs.
/// \param moving  empty where nothing moves
ForeignBlocks foreign_blocks(const std::optional<MovingBody>& moving);

/// Returns the part of a body that this rank holds; the whole body where there is one rank.
/// \param whole  whole body, or the chunks that this rank needs of it, see part_of
std::unique_ptr<Model> part_of_rank(std::unique_ptr<Model> whole, const std::shared_ptr<Ranks>& ranks,
                                    const HeatConditions& heat,
                                    const std::vector<BlockMaterial>& block_materials, ForeignBlocks foreign);

/// What a rank holds of a body, and what it sends to others.
struct HeldByRank {
  int chunks = 0, blocks = 0, zones = 0;      ///< own ones
  int foreign_blocks = 0, foreign_zones = 0;  ///< those of other ranks, which it holds beside its own
  int cut_points = 0;  ///< contacts with blocks of other ranks, which both ranks update
  // by the rank that receives
  std::map<int, int> gridpoints_sent;  ///< gridpoints whose displacements travel after each step
  /// Thermal nodes whose temperatures travel after each stage of the heat solver, and twice as many numbers
  /// where flows are limited. A node that gaps part counts as one.
  std::map<int, int> nodes_sent;

  /// Returns the number of ranks to which a message goes.
  int neighbours() const;
  double step_bytes(int dimension) const;  ///< Returns the bytes that it sends after each step.
  double stage_bytes() const;              ///< Returns the bytes that it sends after each stage.
};

/// Counts what each of several ranks would hold of a body that one process holds now. Throws Error where
/// there are more ranks than chunks.
std::vector<HeldByRank> held_by_ranks(const Simulation& whole, int ranks);

}  // namespace pyroclast
