#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/experiment/stage.hpp"

namespace pyroclast {

/// Reads [[stages]] and the [coupling] of those that change temperatures. What is wrong is recorded in the
/// deck.
std::vector<Stage> read_stages(const Section& root);

}  // namespace pyroclast
