#include "pyroclast/simulation/acting.hpp"

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

Acting<2> acting_on(const Simulation& simulation) {
  Acting<2> acting{simulation.supports(), {}};
  for (const auto& [set, load] : simulation.loads().all()) acting.loads[set] = {load, "an earlier drive"};
  return acting;
}

}  // namespace pyroclast
