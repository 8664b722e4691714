#include "pyroclast/tables/measured_table.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

/// Returns the units of a row; empty where one of its cells is none.
std::optional<std::vector<std::string>> row_of_units(const TableRow& row) {
  std::vector<std::string> units;
  bool has_unit = false;
  for (const std::string& cell : row.cells) {
    const auto unit = cell.empty() ? std::optional<std::string>("") : unit_cell(cell);
    if (!unit) return std::nullopt;
    has_unit = has_unit || !unit->empty();
    units.push_back(*unit);
  }
  return has_unit ? std::optional(units) : std::nullopt;
}

std::string in_quotes(std::string_view text) {
  return fmt::format("\"{}\"", text);
}

/// Tells whether a cell is the number of its row, as in an index.
bool counts(const TableRow& row, std::size_t column, std::size_t from, std::size_t index) {
  return row.cells[column] == fmt::format("{}", from + index);
}

}  // namespace

MeasuredTable MeasuredTable::open(const std::filesystem::path& path, std::size_t least) {
  if (std::filesystem::is_directory(path)) throw Error(fmt::format("{}: is a folder", path.string()));
  return parse(read_file(path), path, least);
}

MeasuredTable MeasuredTable::parse(std::string_view bytes, const std::filesystem::path& path,
                                   std::size_t least) {
  return {table_grid(table_lines(bytes, path), least, path), path};
}

MeasuredTable::MeasuredTable(TableGrid grid, std::filesystem::path path)
    : path_(std::move(path)), grid_(std::move(grid)) {
  read_header();
}

void MeasuredTable::read_header() {
  const auto& header = grid_.header;
  columns_.resize(grid_.rows[0].cells.size());
  header_line_ = header.empty() ? grid_.rows[0].line : header[0].line;
  if (header.empty()) return;
  std::size_t names = 0;
  std::optional<std::vector<std::string>> units;
  if (header.size() > 1) {
    units = row_of_units(header[1]);
    if (!units && (units = row_of_units(header[0]))) names = 1;
    if (!units)
      refuse(
          path_, header[1].line,
          fmt::format("lines {} and {} hold no numbers, and neither is a row of units; delete one or write # "
                      "before it",
                      header[0].line, header[1].line));
  }
  header_line_ = header[names].line;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    ColumnHeader& column = columns_[i] = column_header(header[names].cells[i]);
    if (!units || (*units)[i].empty()) continue;
    if (!column.unit.empty() && column.unit != (*units)[i])
      refuse(path_, header[1].line,
             fmt::format("{} has the unit \"{}\" behind its name and \"{}\" in the row of units; write one",
                         column_name(i), column.unit, (*units)[i]));
    column.unit = (*units)[i];
  }
}

std::string MeasuredTable::column_name(std::size_t column) const {
  const std::string& name = columns_[column].name;
  return name.empty() ? fmt::format("column {}", column + 1) : fmt::format("column \"{}\"", name);
}

std::string MeasuredTable::cell_place(std::size_t row, std::size_t column) const {
  return fmt::format("{} in {}", as_written(grid_.rows[row].cells[column]), column_name(column));
}

bool MeasuredTable::holds_clock(std::size_t column) const {
  return std::ranges::any_of(
      grid_.rows, [&](const TableRow& row) { return kind_of_cell(row.cells[column]) == CellKind::clock; });
}

/// Finds the form of the times in a column: where one of them has three parts, times of two parts are minutes
/// and seconds.
ClockForm MeasuredTable::clock_form_of(const ChosenColumn& column) const {
  constexpr int kHoursMinutesSeconds = 3;
  const ClockForm form = clock_form(column.unit).value_or(ClockForm::unknown);
  if (form != ClockForm::unknown) return form;
  std::size_t short_row = rows();
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string& cell = grid_.rows[row].cells[column.index];
    if (kind_of_cell(cell) != CellKind::clock) continue;
    if (clock_parts(cell) == kHoursMinutesSeconds) return ClockForm::minutes_seconds;
    short_row = std::min(short_row, row);
  }
  if (short_row < rows())
    refuse(path_, line(short_row),
           fmt::format("{} may be minutes and seconds or hours and minutes; write \"time [mm:ss]\" or \"time "
                       "[hh:mm]\" above the column, or 00:{} or {}:00",
                       cell_place(short_row, column.index), grid_.rows[short_row].cells[column.index],
                       grid_.rows[short_row].cells[column.index]));
  return form;
}

std::string MeasuredTable::unit_of(std::size_t column, const Unit& unit) const {
  const ColumnHeader& header = columns_[column];
  if (!header.unit.empty()) return header.unit;
  if (unit == unit::time && holds_clock(column)) return "hh:mm:ss";
  if (!header.likely_unit.empty() && fits(column, header.likely_unit, unit)) return header.likely_unit;
  return unit == unit::dimensionless ? "1" : "";
}

bool MeasuredTable::fits(std::size_t column, const std::string& stated, const Unit& unit) const {
  const std::string given = stated.empty() ? unit_of(column, unit) : stated;
  if (clock_form(given)) return unit == unit::time;
  try {
    unit_factors(meant_unit(given, unit), unit);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

bool MeasuredTable::is_index(std::size_t column) const {
  if (!columns_[column].unit.empty()) return false;
  const std::size_t from = grid_.rows[0].cells[column] == "0" ? 0 : 1;
  for (std::size_t row = 0; row < rows(); ++row)
    if (!counts(grid_.rows[row], column, from, row)) return false;
  return true;
}

std::size_t MeasuredTable::find(const ColumnChoice::TableColumn& wanted) const {
  if (wanted.number > 0) {
    if (wanted.number > columns_.size())
      refuse(path_, header_line_,
             fmt::format("has no column {}; it has {}", wanted.number, list_of_columns()));
    return wanted.number - 1;
  }
  std::vector<std::string> names;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].name == wanted.name) found.push_back(i);
    if (!columns_[i].name.empty()) names.push_back(columns_[i].name);
  }
  if (found.empty())
    refuse(path_, header_line_,
           fmt::format("has no column \"{}\"{}; it has {}", wanted.name,
                       did_you_mean(wanted.name, names, "; "), list_of_columns()));
  if (found.size() > 1)
    refuse(path_, header_line_,
           fmt::format("has more than one column \"{}\"; write one of their numbers, {} or {}", wanted.name,
                       found[0] + 1, found[1] + 1));
  return found[0];
}

std::vector<std::size_t> MeasuredTable::chosen(const ColumnChoice& choice,
                                               std::span<const AskedColumn> asked) const {
  std::vector<std::size_t> result;
  if (!choice.columns.empty()) {
    for (const auto& column : choice.columns) {
      const std::size_t index = find(column);
      if (std::ranges::find(result, index) != result.end())
        refuse(path_, header_line_, fmt::format("{} is chosen twice", column_name(index)));
      result.push_back(index);
    }
    return result;
  }
  result.resize(asked.size());
  std::iota(result.begin(), result.end(), std::size_t{0});
  if (columns_.size() == asked.size()) return result;
  if (columns_.size() == asked.size() + 1 && is_index(0)) {
    for (std::size_t& index : result) ++index;
    bool all_fit = true;
    for (std::size_t i = 0; i < asked.size(); ++i)
      all_fit = all_fit && fits(result[i], choice.units.empty() ? "" : choice.units[i], asked[i].unit);
    if (all_fit) return result;
  }
  std::vector<std::string> needed;
  for (const AskedColumn& column : asked) needed.emplace_back(column.name);
  if (columns_.size() < asked.size())
    refuse(
        path_, header_line_,
        fmt::format("has {} column{} (delimiter: {}), but {} are needed: {}", columns_.size(),
                    columns_.size() == 1 ? "" : "s", grid_.delimiter, asked.size(), fmt::join(needed, ", ")));
  refuse(path_, header_line_,
         fmt::format("has {} columns, of which {} are needed ({}): {}; write {}", columns_.size(),
                     asked.size(), fmt::join(needed, ", "), list_of_columns(),
                     line_to_write(choice, likely_columns(asked), asked)));
}

std::string MeasuredTable::chosen_unit(std::size_t column, const std::string& stated,
                                       const AskedColumn& asked) const {
  const std::string said = unit_of(column, asked.unit);
  if (stated.empty() || !columns_[column].unit.empty()) {
    if (!stated.empty() && stated != said)
      refuse(path_, header_line_,
             fmt::format("{} is in \"{}\" by the file and in \"{}\" by the deck; write \"\" in its place in "
                         "`units`, or change the file",
                         column_name(column), said, stated));
    return said;
  }
  return stated;
}

std::vector<ChosenColumn> MeasuredTable::choose(const ColumnChoice& choice,
                                                std::span<const AskedColumn> asked) const {
  const std::vector<std::size_t> indices = chosen(choice, asked);
  std::vector<ChosenColumn> result;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string stated = choice.units.empty() ? "" : choice.units[i];
    result.push_back({indices[i], chosen_unit(indices[i], stated, asked[i])});
    if (result.back().unit.empty())
      refuse(path_, header_line_,
             fmt::format("{} has no unit; write \"{} [{}]\" above it, or {}", column_name(indices[i]),
                         columns_[indices[i]].name.empty() ? asked[i].name : columns_[indices[i]].name,
                         asked[i].unit.si, line_to_write(choice, indices, asked)));
  }
  return result;
}

std::function<double(std::string_view)> MeasuredTable::reader(const ChosenColumn& column,
                                                              std::string_view given,
                                                              const Unit& unit) const {
  try {
    return quantity_reader(given, unit);
  } catch (const QuantityError& error) {
    refuse(path_, header_line_, fmt::format("{}: {}", column_name(column.index), error.reason()));
  }
}

std::vector<double> MeasuredTable::values(const ChosenColumn& column, const Unit& unit) const {
  const std::size_t index = column.index;
  const bool is_clock = unit == unit::time && clock_form(column.unit);
  const ClockForm form = is_clock ? clock_form_of(column) : ClockForm::unknown;
  const auto read = reader(column, is_clock ? "s" : meant_unit(column.unit, unit), unit);
  std::vector<double> result;
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string& cell = grid_.rows[row].cells[index];
    const CellKind kind = kind_of_cell(cell);
    if (kind == CellKind::empty)
      refuse(path_, line(row),
             fmt::format("{} is empty; delete the line or write a number", column_name(index)));
    if (kind == CellKind::date)
      refuse(path_, line(row),
             fmt::format(
                 "{} is a date, of which the order of day and month is not certain; write times since the "
                 "start, in s, min or h or as hh:mm:ss",
                 cell_place(row, index)));
    if (kind == CellKind::clock && !is_clock)
      refuse(path_, line(row),
             fmt::format(
                 "{} is a time, but the column is in \"{}\"; write its unit as \"hh:mm:ss\", \"mm:ss\" or "
                 "\"hh:mm\"",
                 cell_place(row, index), column.unit));
    if (kind != (is_clock ? CellKind::clock : CellKind::number))
      refuse(path_, line(row),
             fmt::format("{} is no {}", cell_place(row, index), is_clock ? "time" : "number"));
    try {
      result.push_back(read(is_clock ? clock_seconds(cell, form) : *plain_number(cell, grid_.decimal_sign)));
    } catch (const QuantityError& error) {
      refuse(path_, line(row), fmt::format("{}: {}", column_name(index), error.what()));
    }
  }
  return result;
}

std::string MeasuredTable::list_of_columns() const {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const ColumnHeader& column = columns_[i];
    list.push_back(fmt::format("{}{}{}", i + 1,
                               column.name.empty() ? "" : fmt::format(" \"{}\"", column.name),
                               column.unit.empty() ? "" : fmt::format(" [{}]", column.unit)));
  }
  return fmt::format("{}", fmt::join(list, ", "));
}

std::vector<std::size_t> MeasuredTable::likely_columns(std::span<const AskedColumn> asked) const {
  std::vector<std::size_t> result;
  const auto is_free = [&](std::size_t i) { return std::ranges::find(result, i) == result.end(); };
  for (const AskedColumn& column : asked) {
    std::size_t best = columns_.size();
    for (std::size_t i = 0; i < columns_.size() && best == columns_.size(); ++i)
      if (is_free(i) && fits(i, "", column.unit)) best = i;
    for (std::size_t i = 0; i < columns_.size() && best == columns_.size(); ++i)
      if (is_free(i)) best = i;
    result.push_back(best);
  }
  return result;
}

std::string MeasuredTable::line_to_write(const ColumnChoice& choice, const std::vector<std::size_t>& columns,
                                         std::span<const AskedColumn> asked) const {
  std::vector<std::string> names, units;
  bool all_say_units = true;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string& name = columns_[columns[i]].name;
    const auto same = std::ranges::count(columns_, name, &ColumnHeader::name);
    names.push_back(name.empty() || same > 1 ? fmt::format("{}", columns[i] + 1) : in_quotes(name));
    const std::string unit = unit_of(columns[i], asked[i].unit);
    all_say_units = all_say_units && !unit.empty();
    units.push_back(in_quotes(unit.empty() ? asked[i].unit.si : unit));
  }
  std::string line =
      fmt::format("{{ {} = \"{}\", columns = [{}]", choice.key, choice.file, fmt::join(names, ", "));
  if (!all_say_units) line += fmt::format(", units = [{}]", fmt::join(units, ", "));
  return line + " }";
}

void require_ascending(const MeasuredTable& table, const ChosenColumn& column, std::span<const double> values,
                       std::string_view name) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] < values[i]) continue;
    const bool is_same = values[i - 1] == values[i];
    refuse(
        table.path(), table.line(i),
        fmt::format("the {} ({}) {} from line {} to line {}; it must ascend: {}", name,
                    table.column_name(column.index), is_same ? "stays the same" : "falls", table.line(i - 1),
                    table.line(i), is_same ? "delete one of the lines" : "sort the lines"));
  }
}

}  // namespace pyroclast
