#pragma once

#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// What a run will probably cost.
struct Rehearsal {
  Forecast forecast;
  double seconds = 0.0;  ///< of wall time, as the first steps take it on this machine
};

/// Tries what a run does, a moment of each. The simulation is then no longer that of the run's beginning.
Rehearsal rehearse(Setup setup, Simulation& simulation);

}  // namespace pyroclast
