#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/acting/spalling.hpp"
#include "pyroclast/simulation/loop/stage.hpp"

namespace pyroclast {

/// Reads the table [spalling]; empty where the deck has none. Records an error where no stage of the deck can
/// let pieces go.
std::optional<SpallingRule> read_spalling(const Section& root,
                                          const std::vector<std::unique_ptr<Stage>>& stages);

}  // namespace pyroclast
