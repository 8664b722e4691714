#pragma once

#include "pyroclast/laws/kit.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"

namespace pyroclast {

/// Returns the step's own ways of taking a law through lanes, for the kit: by a pack of faces, in every
/// instruction set that this build holds and this processor has.
std::vector<KitLanes> lanes_of_step(const LawTable& law);

}  // namespace pyroclast
