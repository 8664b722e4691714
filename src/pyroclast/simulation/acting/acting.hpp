#pragma once

#include <map>
#include <string>

#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/simulation/acting/supports.hpp"

namespace pyroclast {

/// Load that lasts, as far as it can be foreseen, and the place in the deck that stated it last.
struct LastingLoad {
  SetLoad load;
  std::string place;
};

/// Supports and loads of the body before a stage, as far as they can be foreseen, so that decks are checked
/// before they run.
struct Acting {
  Supports supports;
  std::map<std::string, LastingLoad> loads;  ///< loads by set
};

/// Returns the supports and loads that act now.
Acting acting_on(const Simulation& simulation);

}  // namespace pyroclast
