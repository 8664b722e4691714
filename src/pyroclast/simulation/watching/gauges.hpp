#pragma once

#include <functional>
#include <vector>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/column.hpp"

namespace pyroclast {

/// Gauge: reads some columns of the history at each look.
struct Gauge {
  std::vector<Column> columns;
  /// Function that returns the values in the order of the columns.
  std::function<std::vector<double>(const Simulation&)> read;
  bool of_motion = false;  ///< true where there is nothing to read in a stage that does not move the body
  bool of_places = false;  ///< true where NaN stands for blocks that have left the body
};

/// Returns gauges of the steps and the time of the mechanics.
std::vector<Gauge> clock_gauges(const Simulation& simulation);
/// Returns gauges of heating time and temperatures.
std::vector<Gauge> temperature_gauges();
/// Returns gauges of stresses and strains of the press, measures of equilibrium, cracks and energies.
std::vector<Gauge> motion_gauges(const Simulation& simulation);
/// Returns gauges of the deck's records: one of temperatures, which also a stage of heat alone has, and one
/// of motion.
std::vector<Gauge> record_gauges(const Simulation& simulation);
/// Returns gauges of rate and heat of a computed field, and of water in the pores.
std::vector<Gauge> transport_gauges(const Simulation& simulation);
/// Returns gauges of the temperatures, and of pore pressures, at the probes.
std::vector<Gauge> probe_gauges(const Simulation& simulation);
/// Returns all columns that these gauges may have.
std::vector<Column> possible_gauge_columns();

}  // namespace pyroclast
