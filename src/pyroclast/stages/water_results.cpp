#include "pyroclast/stages/water_results.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/stages/known_results.hpp"

namespace pyroclast {

void tell_water(const History& history, RowRange rows, StageReport& report) {
  if (rows.empty() || !history.has("pore_pressure_max_MPa")) return;
  const auto column = [&](const char* name) { return history.values(name, rows); };
  const auto pressure = column("pore_pressure_max_MPa"), time = column("heating_time_s");
  const auto largest = std::ranges::max_element(pressure);
  const double when = time[largest - pressure.begin()];
  const double ratio = std::ranges::max(column("pore_pressure_over_saturation_max"));
  const double left = column("water_left_kg").back(), held = column("water_kg").back();
  report.results.push_back({known::largest_pore_pressure, *largest});
  report.results.push_back({known::time_of_largest_pore_pressure, when});
  report.results.push_back({known::largest_pressure_ratio, ratio});
  report.results.push_back({known::water_left, left});
  report.lines.push_back(fmt::format(
      "pore pressure up to {:.3g} MPa, after {:.3g} min, {:.3g} of saturation at most; {:.3g} kg of "
      "water left, {:.3g} kg are there",
      *largest, when / 60.0, ratio, left, held));
}

}  // namespace pyroclast
