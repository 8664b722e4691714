#include "pyroclast/material/jump_path.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/unit.hpp"

namespace pyroclast {
namespace {

/// Quantity that a column holds.
struct Quantity {
  std::string_view name;
  double JumpPathPoint::*member;
  const Unit& unit;
};
constexpr std::array<Quantity, 3> kQuantities{{{"u_n", &JumpPathPoint::opening, unit::length},
                                               {"u_s", &JumpPathPoint::slip, unit::length},
                                               {"T", &JumpPathPoint::temperature, unit::temperature}}};

}  // namespace

std::vector<JumpPathPoint> jump_path(const MeasuredTable& table, double temperature) {
  std::vector<JumpPathPoint> path(table.rows(), {.temperature = temperature});
  std::vector<std::string_view> taken;
  const auto fail = [&](std::size_t column, std::string_view what) {
    refuse(table.path(), table.header_line(), fmt::format("{} {}", table.column_name(column), what));
  };
  for (std::size_t i = 0; i < table.columns().size(); ++i) {
    const std::string& name = table.columns()[i].name;
    const auto quantity = std::ranges::find(kQuantities, name, &Quantity::name);
    if (quantity == kQuantities.end()) {
      const bool is_number = !meanings_of_name(name, {&meaning::index}).empty();
      if (table.columns().size() > 1 && (is_number || (i == 0 && table.is_index(i)))) continue;
      fail(i, "is unknown; allowed are u_n, u_s and T, each with its unit, such as \"u_n [um]\"");
    }
    if (std::ranges::find(taken, name) != taken.end()) fail(i, "stands twice");
    taken.push_back(name);
    const std::string unit = table.unit_of(i, quantity->unit);
    if (unit.empty())
      fail(i, fmt::format("has no unit; write for example \"{} [{}]\"", name,
                          quantity->unit == unit::length ? "um" : "degC"));
    const auto values = table.values({i, unit}, quantity->unit);
    for (std::size_t row = 0; row < values.size(); ++row) path[row].*quantity->member = values[row];
  }
  return path;
}

std::vector<JumpPathPoint> read_jump_path(const std::filesystem::path& file, double temperature) {
  return jump_path(MeasuredTable::parse(read_named_file(file), file, 1), temperature);
}

}  // namespace pyroclast
