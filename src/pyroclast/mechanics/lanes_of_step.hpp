#pragma once

#include <vector>

#include "pyroclast/laws/kit.hpp"

namespace pyroclast {

/// Returns the step's own ways of taking a law through lanes, for the kit: in every instruction set that this
/// build holds and this processor has.
std::vector<KitLanes> lanes_of_step(const LawTable& law);

}  // namespace pyroclast
