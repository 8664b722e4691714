#pragma once

#include <functional>
#include <vector>

#include "pyroclast/simulation/history.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Reads some columns of the history at each look.
struct Gauge {
  std::vector<Column> columns;
  /// Values in the order of the columns.
  std::function<std::vector<double>(const Simulation&)> read;
  bool of_motion = false;  ///< there is nothing to read in a stage that does not move the body
};

/// Steps and time of the mechanics.
std::vector<Gauge> clock_gauges(const Simulation& simulation);
/// Heating time and temperatures.
std::vector<Gauge> temperature_gauges();
/// Stresses and strains of the press, measures of equilibrium, cracks and energies.
std::vector<Gauge> motion_gauges(const Simulation& simulation);
/// What the deck's records are, by those of temperature, which heat alone has too, and those of motion.
std::vector<Gauge> record_gauges(const Simulation& simulation);
/// Rate and heat of a computed field.
std::vector<Gauge> transport_gauges(const Simulation& simulation);
/// Temperatures at the probes.
std::vector<Gauge> probe_gauges(const Simulation& simulation);

}  // namespace pyroclast
