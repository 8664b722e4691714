#pragma once

#include "pyroclast/laws/kit.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"

namespace pyroclast {

/// The step's own way of a law through lanes, for the kit: a pack of faces, in every instruction set that
/// this build holds and this processor has.
std::vector<KitLanes> lanes_of_step(const LawTable& law);

}  // namespace pyroclast
