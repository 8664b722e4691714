#include "pyroclast/mechanics/lanes_of_step.hpp"

#include <fmt/format.h>

#include "pyroclast/mechanics/compiled_for_sets.hpp"

namespace pyroclast {

std::vector<KitLanes> lanes_of_step(const LawTable& law) {
  std::vector<KitLanes> all;
  for (const InstructionSet set : usable_instruction_sets()) {
    if (!is_compiled(law, set)) continue;
    KitLanes& lanes = all.emplace_back(KitLanes{fmt::format("the step in {}", name(set)), {}});
    if (law.update(2)) lanes.update_of[0] = functions_of<2>(law, set).update_lanes;
    if (law.update(3)) lanes.update_of[1] = functions_of<3>(law, set).update_lanes;
  }
  return all;
}

}  // namespace pyroclast
