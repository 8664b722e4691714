#include <cmath>

#include "pyroclast/material/curve_file.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool table(std::string_view text) {
  return takes([&] {
    const auto table = MeasuredTable::parse(text, "table.csv", kCurveColumns);
    const Curve curve = curve_of_table(table, {"table.csv", {}, {}}, temperature_axis(), unit::conductivity);
    const auto [lower, upper] = curve.range();
    require(lower < upper && std::isfinite(curve(lower)) && std::isfinite(curve(upper)),
            "a table's values are finite");
  });
}

}  // namespace pyroclast::fuzz
