#pragma once

#include <optional>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/experiment/heat_run.hpp"
#include "pyroclast/experiment/stage.hpp"

namespace pyroclast {

/// What a deck's [[stages]] ask for: stages with mechanics, or heat conduction alone.
struct ReadStages {
  std::vector<Stage> stages;
  std::optional<HeatRun> conduct;  ///< then there are no stages
};

/// Reads [[stages]] and the [coupling] of those that change temperatures. What is wrong is recorded in the
/// deck.
ReadStages read_stages(const Section& root);

}  // namespace pyroclast
