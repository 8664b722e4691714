#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/stress_free.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

struct ReadStages {
  std::vector<std::unique_ptr<Stage>> stages;
  std::vector<std::string> names;         ///< names of the stages
  std::optional<StressFree> stress_free;  ///< temperature without stress of [coupling]
  bool any_moves = false;                 ///< true where any stage moves the body
};

/// Reads [[stages]], and [output] and [coupling] as far as the kinds of stages need them. Errors are recorded
/// in the deck.
/// \param records  records that stages may name
/// \param folder   folder of the deck
ReadStages read_stages(const Section& root, const StageRegistry& kinds,
                       const std::vector<RecordParameters>& records, const DeckSpace& space,
                       const std::filesystem::path& folder);

}  // namespace pyroclast
