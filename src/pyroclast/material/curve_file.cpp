#include "pyroclast/material/curve_file.hpp"

#include <array>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

Curve curve_of_table(const MeasuredTable& table, const ColumnChoice& choice, const CurveAxis& axis,
                     const Unit& value) {
  const Unit& abscissa = axis == time_axis() ? unit::time : unit::temperature;
  const std::array<AskedColumn, kCurveColumns> asked{{{abscissa.name, abscissa}, {value.name, value}}};
  const auto columns = table.choose(choice, asked);
  auto x = table.values(columns[0], abscissa);
  auto y = table.values(columns[1], value);
  require_ascending(table, columns[0], x, abscissa.name);
  try {
    return Curve::table(std::move(x), std::move(y), axis)
        .described_as(fmt::format("table file {}", table.path().filename().string()));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", table.path().string(), error.what()));
  }
}

}  // namespace pyroclast
