#include "pyroclast/material/curve_file.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

Curve curve_of_table(const MeasuredTable& table, const ColumnChoice& choice, const CurveAxis& axis,
                     const Unit& value) {
  const bool is_of_time = axis == time_axis();
  const Unit& abscissa = is_of_time ? unit::time : unit::temperature;
  std::array<AskedColumn, kCurveColumns> asked{{{abscissa.name, abscissa}, {value.name, value}}};
  asked[0].names = {{is_of_time ? &meaning::time : &meaning::temperature}};
  if (is_of_time && value == unit::temperature) asked[1].names = {{&meaning::temperature}};
  const auto columns = table.choose(choice, asked, {&meaning::time, &meaning::temperature_rise});
  auto x = table.values(columns[0], abscissa);
  auto y = table.values(columns[1], value);
  require_ascending(table, columns[0], x, abscissa.name, abscissa);
  const std::string start = is_of_time ? table.start_of(columns[0]) : "";
  try {
    return Curve::table(std::move(x), std::move(y), axis)
        .described_as(fmt::format("table file {}{}", table.path().filename().string(),
                                  start.empty() ? "" : fmt::format(", times since {}", start)));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", table.path().string(), error.what()));
  }
}

}  // namespace pyroclast
