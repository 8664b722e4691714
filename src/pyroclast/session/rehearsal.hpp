#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Probable cost of a run.
struct Rehearsal {
  Forecast forecast;
  double seconds = 0.0;           ///< wall time on free cores, s, from the speed of the first steps
  double heat_evaluations = 0.0;  ///< evaluations of the heat solver: stages of its steps
  double history_bytes = 0.0;     ///< size of history.csv and temperature_profile.csv, bytes
  double field_bytes = 0.0;       ///< size of all frames of the fields, bytes; 0 where the deck wants none
};

/// Forecasts stages, each from the temperatures that the one before it leaves.
/// \param simulation  body as it is when the first of them begins
/// \param hottest  highest temperature to which the run may come, °C
std::vector<Forecast> forecast(std::span<const std::unique_ptr<Stage>> stages, const Simulation& simulation,
                               double hottest);

/// Tries each action of a run for a moment. The simulation then no longer stands at the run's beginning.
Rehearsal rehearse(Setup setup, Simulation& simulation);

}  // namespace pyroclast
