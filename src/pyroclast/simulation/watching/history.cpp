#include "pyroclast/simulation/watching/history.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

void History::add_column(const Column& column) {
  const auto found = find(column.name);
  if (!found) {
    columns_.push_back(column);
    return;
  }
  if (columns_[*found].unit == column.unit) return;
  throw Error(fmt::format("column \"{}\" of the history is in \"{}\", but in \"{}\" elsewhere", column.name,
                          columns_[*found].unit, column.unit));
}

void History::add_row() {
  cells_.emplace_back(columns_.size());
}

void History::add_row(std::vector<std::optional<double>> cells) {
  cells.resize(columns_.size());
  cells_.push_back(std::move(cells));
}

void History::take_rows(const History& other) {
  std::vector<std::optional<std::size_t>> to;
  for (const Column& column : other.columns_) to.push_back(find(column.name));
  for (const auto& row : other.cells_) {
    add_row();
    for (std::size_t i = 0; i < row.size(); ++i)
      if (to[i]) cells_.back()[*to[i]] = row[i];
  }
}

void History::set(std::string_view column, double value) {
  cells_.back()[index(column)] = value;
}

bool History::has(std::string_view column) const {
  return find(column).has_value();
}

std::optional<double> History::cell(std::size_t row, std::string_view column) const {
  const auto found = find(column);
  return found ? cells_.at(row)[*found] : std::nullopt;
}

std::optional<double> History::last(std::string_view column) const {
  return cells_.empty() ? std::nullopt : cell(cells_.size() - 1, column);
}

std::vector<double> History::values(std::string_view column, RowRange rows) const {
  const std::size_t c = index(column);
  std::vector<double> values;
  for (std::size_t row = rows.first; row < rows.last; ++row) {
    if (!cells_.at(row)[c])
      throw Error(fmt::format("row {} of the history has no value in column \"{}\"", row, column));
    values.push_back(*cells_[row][c]);
  }
  return values;
}

void History::visit_state(StateVisitor& visitor) {
  std::vector<std::string> of_values;
  for (const Column& column : columns_) of_values.push_back(column.name);
  std::vector<double> values;
  std::vector<std::uint8_t> is_there;
  for (const auto& row : cells_)
    for (const auto& cell : row) {
      values.push_back(cell.value_or(0.0));
      is_there.push_back(cell ? 1 : 0);
    }
  visitor.visit("columns", of_values);
  visitor.visit("values", values);
  visitor.visit("is_there", is_there, state::within(0, 1).of(values.size()));
  visitor.require(of_values.empty() ? values.empty() : values.size() % of_values.size() == 0, "values",
                  "are not as many in each row as there are columns");
  if (!visitor.replaces()) return;

  cells_.clear();
  for (std::size_t first = 0; first < values.size(); first += of_values.size()) {
    add_row();
    for (std::size_t i = 0; i < of_values.size(); ++i)
      if (is_there.at(first + i) != 0) set(of_values[i], values[first + i]);
  }
}

std::optional<std::size_t> History::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == column) return i;
  return std::nullopt;
}

std::size_t History::index(std::string_view column) const {
  if (const auto found = find(column)) return *found;
  std::vector<std::string> names;
  for (const auto& c : columns_) names.push_back(c.name);
  throw Error(fmt::format("the history has no column \"{}\"; it has {}", column, fmt::join(names, ", ")));
}

}  // namespace pyroclast
