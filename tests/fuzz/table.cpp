#include <cmath>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "pyroclast/material/curve_file.hpp"
#include "pyroclast/units/units.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool table(std::string_view text) {
  return takes([&] {
    std::istringstream stream{std::string(text)};
    const auto in = [](const Unit& unit) {
      return [&unit](double value, const std::string& given) {
        return parse_quantity(fmt::format("{} {}", value, given), unit);
      };
    };
    const Curve curve = read_curve_csv(stream, "table.csv", temperature_axis(), in(unit::temperature),
                                       in(unit::conductivity));
    const auto [lower, upper] = curve.range();
    require(lower < upper && std::isfinite(curve(lower)) && std::isfinite(curve(upper)),
            "a table's values are finite");
  });
}

}  // namespace pyroclast::fuzz
