#include "pyroclast/setup/read_reference.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

namespace {

const std::vector<Choice<int>>& built_in() {
  static const std::vector<Choice<int>> words{
      {"none", 0, "no reference"},
      {"compression", 1,
       "compression at 20 °C: Anderberg and Thelandersson's law, and the peaks and moduli of the paper's "
       "Table 3"},
      {"transient_strain", 2,
       "total strain while heated under load: the range of models that were calibrated on Anderberg and "
       "Thelandersson's tests, for the load levels 0, 0.225, 0.445 and 0.675"}};
  return words;
}

/// A column that figures draw, as it is named where a run keeps it.
struct DrawnColumn {
  std::string_view name;
  std::string_view meaning;
  const Unit& unit;
  double written = 1.0;  ///< by which values are divided there
  double most = 0.0;     ///< beyond it a value is most likely in another unit; 0: never
};

constexpr double kMegapascal = 1e6;
constexpr DrawnColumn kStrainColumn{"strain", "strain", unit::dimensionless, 1.0, 0.1};
constexpr DrawnColumn kTotalColumn{"total_strain", "total strain", unit::dimensionless, 1.0, 0.1};
constexpr DrawnColumn kLowColumn{"total_strain_low", "least total strain", unit::dimensionless, 1.0, 0.1};
constexpr DrawnColumn kHighColumn{"total_strain_high", "greatest total strain", unit::dimensionless, 1.0,
                                  0.1};
constexpr DrawnColumn kStressColumn{"stress_MPa", "stress", unit::stress, kMegapascal, 1e9};
constexpr DrawnColumn kTemperatureColumn{"temperature_degC", "temperature", unit::temperature};
constexpr DrawnColumn kTimeColumn{"heating_time_s", "time", unit::time};

/// The columns that a figure draws, and whether the run has that figure.
struct FigureTable {
  std::vector<DrawnColumn> columns;
  bool DrawnTables::*is_drawn;
};

const std::vector<FigureTable>& tables() {
  static const std::vector<FigureTable> all{
      {{kStrainColumn, kStressColumn}, &DrawnTables::strain_stress},
      {{kTemperatureColumn, kTotalColumn}, &DrawnTables::temperature_strain},
      {{kTemperatureColumn, kLowColumn, kHighColumn}, &DrawnTables::temperature_strain},
      {{kTemperatureColumn, kStressColumn}, &DrawnTables::temperature_stress},
      {{kTimeColumn, kTemperatureColumn}, &DrawnTables::time_temperature}};
  return all;
}

std::string names_of(const FigureTable& table) {
  std::vector<std::string_view> names;
  for (const DrawnColumn& column : table.columns) names.push_back(column.name);
  return fmt::format("{}", fmt::join(names, ","));
}

/// Throws Error where no figure of the run shows what a reference is of.
void require_drawn(bool DrawnTables::*of, const DrawnTables& drawn) {
  if (drawn.*of) return;
  std::vector<std::string> shown;
  for (const FigureTable& table : tables())
    if (drawn.*table.is_drawn) shown.push_back(names_of(table));
  throw Error(shown.empty() ? "has no effect: the figures of this run draw no reference"
                            : fmt::format("has no effect: no figure of this run draws it; they draw {}",
                                          quoted_list(shown)));
}

/// What figures draw of a column: its unit fits, and where none is said it is a strain by its name.
bool is_of(const MeasuredTable& table, std::size_t index, const DrawnColumn& drawn) {
  const ColumnHeader& header = table.columns()[index];
  const bool is_plain = header.unit.empty() && drawn.unit == unit::dimensionless;
  return table.fits(index, "", drawn.unit) && (!is_plain || header.name.find("strain") != header.name.npos);
}

/// Throws Error where figures draw no such columns.
const FigureTable& figure_table(const MeasuredTable& table, std::size_t first) {
  std::vector<std::string> allowed;
  for (const FigureTable& figure : tables()) {
    bool is_it = figure.columns.size() + first == table.columns().size();
    for (std::size_t i = 0; is_it && i < figure.columns.size(); ++i)
      is_it = is_of(table, first + i, figure.columns[i]);
    if (is_it) return figure;
    allowed.push_back(names_of(figure));
  }
  refuse(
      table.path(), table.header_line(),
      fmt::format("the columns {} are none that figures draw: {}, each with its unit, such as \"strain [1], "
                  "stress [MPa]\"",
                  table.list_of_columns(), quoted_list(allowed)));
}

void warn_of_magnitude(const Section& output, const MeasuredTable& table, const DrawnColumn& column,
                       const std::vector<double>& values) {
  const auto [least, greatest] = std::ranges::minmax(values);
  const auto say = [&](double value, std::string_view what) {
    output.warn("reference",
                fmt::format("{}: the {} reaches {:.6g}{}{}; {}", table.path().string(), column.meaning,
                            value / column.written, column.unit == unit::stress ? " MPa" : "",
                            column.unit == unit::dimensionless ? " (no unit)" : "", what));
  };
  const double most = std::max(std::abs(least), std::abs(greatest));
  if (column.unit == unit::stress && -least > greatest)
    say(least, "figures draw compression as positive, so that little or nothing of it shows");
  else if (column.most > 0.0 && most > column.most)
    say(most, "it is most likely in another unit, which its header must say");
}

/// The table in the names and units of figures.
std::string read_table(const Section& output, const std::filesystem::path& path, const DrawnTables& drawn) {
  constexpr std::size_t kLeastRows = 2;  // of which a line is made
  const MeasuredTable table = MeasuredTable::load(path, 2);
  const std::size_t first = table.columns().size() > 2 && table.is_index(0) ? 1 : 0;
  const FigureTable& figure = figure_table(table, first);
  require_drawn(figure.is_drawn, drawn);
  if (table.rows() < kLeastRows)
    throw Error(fmt::format("{}: has {} rows of numbers; {} or more are needed", path.string(), table.rows(),
                            kLeastRows));
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < figure.columns.size(); ++i) {
    const DrawnColumn& column = figure.columns[i];
    values.push_back(table.values({first + i, table.unit_of(first + i, column.unit)}, column.unit));
    warn_of_magnitude(output, table, column, values.back());
  }
  std::string text = names_of(figure) + "\n";
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (std::size_t i = 0; i < values.size(); ++i)
      text +=
          fmt::format("{}{}", values[i][row] / figure.columns[i].written, i + 1 < values.size() ? "," : "\n");
  return text;
}

}  // namespace

std::string read_reference(const Section& output, const std::filesystem::path& folder,
                           const DrawnTables& drawn) {
  const std::string name = output.word_or_text(
      "reference", built_in(),
      "file beside the deck with a [table](deck.md#reference-in-figures); its name ends in .csv",
      "what the figures draw beside the results");
  std::vector<std::string> words;
  for (const auto& word : built_in()) words.emplace_back(word.word);
  try {
    if (name == words[1]) require_drawn(&DrawnTables::strain_stress, drawn);
    if (name == words[2]) require_drawn(&DrawnTables::temperature_strain, drawn);
  } catch (const Error& e) {
    output.error("reference", e.what());
  }
  if (std::ranges::find(words, name) != words.end()) return {};
  if (!name.ends_with(".csv")) {
    output.error("reference", fmt::format("is none of {}, and no file whose name ends in .csv{}",
                                          quoted_list(words), did_you_mean(name, words, "; ")));
    return {};
  }
  try {
    std::string table = read_table(output, folder / name, drawn);
    output.names_file("reference", folder / name);
    return table;
  } catch (const Error& e) {
    output.error("reference", e.what());
    return {};
  }
}

}  // namespace pyroclast
