#include "pyroclast/setup/cells_in_metres.hpp"

#include "pyroclast/base/error.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {

double metres_of(std::string_view unit) {
  return quantity_reader(unit, unit::length)("1");
}

specimen::FileOfCells cells_in_metres(const std::filesystem::path& file, double join) {
  const auto to_metres = [](const std::string& unit) -> std::function<double(double)> {
    try {
      const UnitFactors to_m = unit_factors(unit, unit::length);
      if (to_m.is_none()) return {};
      return [to_m](double x) { return to_m(x); };
    } catch (const QuantityError& error) {
      throw Error(error.reason());
    }
  };
  return specimen::read_cells(file, to_metres, join);
}

}  // namespace pyroclast
