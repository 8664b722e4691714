#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pyroclast/simulation/stress_free.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

struct ReadStages {
  std::vector<std::unique_ptr<Stage>> stages;
  std::vector<std::string> names;         ///< of the stages
  std::optional<StressFree> stress_free;  ///< as [coupling] says
  bool any_moves = false;                 ///< the body
};

/// Reads [[stages]], and [output] and [coupling] as far as their kinds need them. What is wrong is recorded
/// in the deck.
/// \param records  that stages may name
/// \param folder   of the deck
ReadStages read_stages(const Section& root, const StageRegistry& kinds,
                       const std::vector<RecordParameters>& records, const std::filesystem::path& folder);

}  // namespace pyroclast
