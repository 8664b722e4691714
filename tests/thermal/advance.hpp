#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/conduction.hpp"

/// Where heat begins and how far it goes, for tests; a run advances it in batches.
namespace pyroclast {

/// Sets the temperatures of the nodes, °C, a function of their places.
template <int Dim, class Field>
void set_field(Conduction<Dim>& heat, const ModelOf<Dim>& model, Field temperature) {
  std::vector<double> of_nodes;
  for (const int g : heat.nodes().gridpoint) of_nodes.push_back(temperature(model.position[g]));
  heat.set_temperature(of_nodes);
}

/// Takes one step towards a time, s, however many stages that needs.
inline void step_towards(HeatSolver& heat, double end) {
  std::int64_t stages = std::numeric_limits<std::int64_t>::max();
  heat.advance_step(end, stages);
}

/// Conducts heat to a time, s; a step under way is done again.
inline void advance_to(HeatSolver& heat, double end) {
  heat.drop_trial();
  do step_towards(heat, end);
  while (heat.time() < end);
}

/// Conducts heat until its rate falls below a tolerance, K/s; returns false if it does not by the latest
/// time, s.
inline bool advance_to_steady(HeatSolver& heat, double tolerance, double latest) {
  heat.drop_trial();
  while (heat.time() < latest) {
    step_towards(heat, latest);
    if (heat.rate() < tolerance) return true;
  }
  return false;
}

}  // namespace pyroclast
