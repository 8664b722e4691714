#include "pyroclast/simulation/watching/column.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pyroclast {

const char* name_of(ColumnRole role) {
  switch (role) {
    case ColumnRole::clock:
      return "clock";
    case ColumnRole::temperature:
      return "temperature";
    case ColumnRole::press:
      return "press";
    case ColumnRole::rest:
      return "rest";
    case ColumnRole::exchange:
      return "exchange";
    case ColumnRole::control:
      return "control";
    case ColumnRole::energy_put_in:
      return "energy.put_in";
    case ColumnRole::energy_held:
      return "energy.held";
    case ColumnRole::energy_lost:
      return "energy.lost";
    case ColumnRole::energy_error:
      return "energy.error";
    case ColumnRole::crack_damaged:
      return "crack.damaged";
    case ColumnRole::crack_broken:
      return "crack.broken";
    case ColumnRole::crack_damaged_extent:
      return "crack.damaged_extent";
    case ColumnRole::crack_broken_extent:
      return "crack.broken_extent";
    case ColumnRole::crack_opening:
      return "crack.opening";
    case ColumnRole::heat_put_in:
      return "heat.put_in";
    case ColumnRole::heat_held:
      return "heat.held";
    case ColumnRole::heat_lost:
      return "heat.lost";
    case ColumnRole::heat_error:
      return "heat.error";
    case ColumnRole::heat_flow:
      return "heat.flow";
    case ColumnRole::spalling:
      return "spalling";
    case ColumnRole::bar:
      return "bar";
    case ColumnRole::bar_unspalled:
      return "bar_unspalled";
    case ColumnRole::water:
      return "water";
    case ColumnRole::probe:
      return "probe";
    case ColumnRole::probe_pressure:
      return "probe.pressure";
    case ColumnRole::record:
      return "record";
    case ColumnRole::own:
      return "own";
  }
  return "";
}

Column column_with_unit(const std::string& name, const Unit& unit) {
  if (unit == unit::dimensionless) return {name, unit.si};
  std::string spelt = unit.si;
  std::ranges::replace(spelt, '/', '_');
  return {fmt::format("{}_{}", name, spelt), unit.si};
}

}  // namespace pyroclast
