#include "pyroclast/tables/measured_table.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
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

std::string MeasuredTable::unit_of(std::size_t column, const Unit& unit) const {
  const ColumnHeader& header = columns_[column];
  if (unit == unit::time && tells_time(column) && !time_form(header.unit) && !is_unit(header.unit))
    return "hh:mm:ss";  // behind a name may stand "local time" or "UTC"
  if (!header.unit.empty()) return header.unit;
  if (!header.likely_unit.empty() && fits(column, header.likely_unit, unit)) return header.likely_unit;
  if (!header.unknown_unit.empty()) return header.unknown_unit;
  return unit == unit::dimensionless ? "1" : "";
}

bool MeasuredTable::fits(std::size_t column, const std::string& stated, const Unit& unit) const {
  const std::string given = stated.empty() ? unit_of(column, unit) : stated;
  if (time_form(given)) return unit == unit::time;
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

std::function<double(std::string_view)> MeasuredTable::reader(const ChosenColumn& column,
                                                              std::string_view given,
                                                              const Unit& unit) const {
  try {
    return quantity_reader(given, unit);
  } catch (const QuantityError& error) {
    const std::string& text = columns_[column.index].unknown_unit;
    refuse(path_, header_line_,
           fmt::format("{}: {}{}", column_name(column.index), error.reason(),
                       given == text && !text.empty()
                           ? fmt::format("; if ({}) is a remark, write it without brackets", text)
                           : ""));
  }
}

/// Returns the time that counts as 0 in a column of numbers.
double MeasuredTable::number_of_start(const ChosenColumn& column, double first, const Unit& unit) const {
  if (column.start == kFirstRow) return first;
  try {
    return parse_quantity(column.start, unit);
  } catch (const QuantityError& error) {
    refuse(path_, header_line_,
           fmt::format("start = {}; {} holds numbers in {}: write \"{}\", or a time such as \"{} {}\"",
                       error.what(), column_name(column.index), column.unit, kFirstRow,
                       grid_.rows[0].cells[column.index], column.unit));
  }
}

std::vector<double> MeasuredTable::values(const ChosenColumn& column, const Unit& unit) const {
  const std::size_t index = column.index;
  // A date with a time has one reading, whatever unit stands above it.
  if (unit == unit::time && (time_form(column.unit) || tells_date(index))) return times(column).values;
  const auto read = reader(column, meant_unit(column.unit, unit), unit);
  std::vector<double> result;
  for (std::size_t row = 0; row < std::min(rows(), column.rows); ++row) {
    const std::string& cell = grid_.rows[row].cells[index];
    const CellKind kind = kind_of_cell(cell);
    if (kind == CellKind::empty)
      refuse(path_, line(row),
             fmt::format("{} is empty; delete the line or write a number", column_name(index)));
    if (kind == CellKind::date)
      refuse(
          path_, line(row),
          fmt::format("{} is a date without a time of the day; write times since the start, in s, min or h "
                      "or as hh:mm:ss, or dates with times such as 2026-03-02T10:14:05",
                      cell_place(row, index)));
    if (kind == CellKind::clock || kind == CellKind::stamp)
      refuse(path_, line(row),
             fmt::format(
                 "{} is a time, but the column is in \"{}\"; write its unit as \"hh:mm:ss\", \"mm:ss\" or "
                 "\"hh:mm\"",
                 cell_place(row, index), column.unit));
    if (kind != CellKind::number)
      refuse(path_, line(row), fmt::format("{} is no number", cell_place(row, index)));
    try {
      result.push_back(column.factor * read(*plain_number(cell, grid_.decimal_sign)));
    } catch (const QuantityError& error) {
      refuse(path_, line(row), fmt::format("{}: {}", column_name(index), error.what()));
    }
  }
  if (!column.start.empty()) {
    const double start = number_of_start(column, result[0], unit);
    for (double& value : result) value -= start;
  }
  return result;
}

namespace {

constexpr double kDay = 86400.0;  // s
constexpr double kHour = 3600.0;  // s
constexpr double kEpoch = 1e8;    // s; no record begins three years after its start

bool ascends(std::span<const double> values) {
  return std::ranges::adjacent_find(values, std::ranges::greater_equal()) == values.end();
}

/// Tells whether the values ascend without the one at a place.
bool ascends_without(std::span<const double> values, std::size_t place) {
  std::vector<double> others(values.begin(), values.end());
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
  return ascends(others);
}

/// Tells whether times, s, fall because their clock begins anew after a period: with the period added they go
/// on within two of their longest steps.
bool passes_end(std::span<const double> times, std::size_t at, double period) {
  constexpr double kShareOfStep = 1.0 / 48.0;  // half an hour of a day
  double longest = period * kShareOfStep;
  for (std::size_t i = 1; i < at; ++i) longest = std::max(longest, times[i] - times[i - 1]);
  const double step = times[at] + period - times[at - 1];
  return times[0] >= 0.0 && times[at - 1] < period + kHour && step >= 0.0 && step <= 2.0 * longest;
}

/// Says that a clock begins anew where times fall; empty where it does not look so.
std::string told_of_clock(std::span<const double> times, std::size_t at, int line, bool is_clock) {
  for (const double period : {kDay, kDay / 2.0, kHour}) {
    if ((period < kDay && !is_clock) || !passes_end(times, at, period)) continue;
    const std::string what =
        period == kDay ? "passes midnight" : fmt::format("begins anew after {:g} h", period / kHour);
    return fmt::format(
        "the clock {} there; write times since the start of heating: add {:g} h from line {} on, and "
        "subtract the time of the start from all",
        what, period / kHour, line);
  }
  return "";
}

/// Says what to do where values fall at a place. A remedy never mixes lines of two records.
std::string way_to_ascend(const MeasuredTable& table, std::span<const double> values, std::size_t at,
                          const Unit& unit, bool is_clock) {
  std::size_t falls = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] < values[i - 1]) ++falls;
  const int line = table.line(at);
  if (unit == unit::time)
    if (std::string told = told_of_clock(values, at, line, is_clock); !told.empty()) return told;
  if (falls + 1 == values.size() && falls > 1)
    return "it descends throughout: write the lines in the reverse order";
  if (ascends_without(values, at) || ascends_without(values, at - 1))
    return fmt::format("line {} or line {} stands in a wrong place or has a wrong number: move or correct it",
                       table.line(at - 1), line);
  if (falls == 1 && values.back() < values.front())
    return fmt::format(
        "the lines from {} on are less than all before: keep one of the two parts, or put them "
        "first where both are of one record",
        line);
  if (falls == 1)
    return fmt::format(
        "the record begins again there: keep one of its parts, the lines up to {} or those from {} on",
        table.line(at - 1), line);
  return fmt::format(
      "it falls {} times, as where several records stand in turn: keep the lines of one that ascends", falls);
}

}  // namespace

void require_ascending(const MeasuredTable& table, const ChosenColumn& column, std::span<const double> values,
                       std::string_view name, const Unit& unit, bool may_stay) {
  if (unit == unit::time && values[0] > kEpoch)
    refuse(table.path(), table.line(0),
           fmt::format(
               "the {} ({}) begins at {:.10g} s, {:.3g} years: it counts from a date, such as the year 1970 "
               "or 1900; times count from the start of heating: write start = \"{}\" beside the file's name, "
               "or the time of the start",
               name, table.column_name(column.index), values[0], values[0] / (365.25 * kDay), kFirstRow));
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] < values[i]) continue;
    const bool is_same = values[i - 1] == values[i];
    if (is_same && may_stay) continue;
    refuse(table.path(), table.line(i),
           fmt::format("the {} ({}) {} from line {} to line {}; it must ascend: {}", name,
                       table.column_name(column.index), is_same ? "stays the same" : "falls",
                       table.line(i - 1), table.line(i),
                       is_same ? "keep one of the lines, or write the numbers with more digits"
                               : way_to_ascend(table, values, i, unit, time_form(column.unit).has_value())));
  }
}

}  // namespace pyroclast
