#include "pyroclast/simulation/acting/acting.hpp"

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

Acting acting_on(const Simulation& simulation) {
  Acting acting{simulation.supports(), {}};
  for (const auto& [set, load] : simulation.loads().all()) acting.loads[set] = {load, "an earlier drive"};
  return acting;
}

}  // namespace pyroclast
