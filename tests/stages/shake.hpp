#pragma once

#include <string>

#include "own_stage/shake.hpp"

/// A stage that the library does not have, as a user would write it, and its table of a deck.
namespace pyroclast {

using mine::shake_kind, mine::with_shake;

inline const std::string kShake =
    "[[stages]]\nkind = \"shake\"\nvelocity = \"1 mm/s\"\nhalf_period = 100\nturns = 4\n";

}  // namespace pyroclast
