#include "pyroclast/setup/cells_in_metres.hpp"

#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/pieces.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {

double metres_of(std::string_view unit) {
  return quantity_reader(unit, unit::length)("1");
}

specimen::GivenCells<2> cells_in_metres(const std::filesystem::path& file, double join) {
  auto [cells, unit] = specimen::read_cells(file);
  try {
    if (const UnitFactors to_m = unit_factors(unit, unit::length); !to_m.is_none()) {
      for (Vec<2>& v : cells.cells.vertices) v = {{to_m(v[0]), to_m(v[1])}};
      for (double& size : cells.size) size = to_m(size);
    }
  } catch (const QuantityError& error) {
    throw Error(fmt::format("{}: \"vertices_{}\": {}", file.string(), unit, error.reason()));
  }
  cells.origin = file.string();
  try {
    cells = specimen::joined(std::move(cells), join);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.string(), error.what()));
  }
  specimen::lay_on_sides(cells.cells);
  return cells;
}

}  // namespace pyroclast
