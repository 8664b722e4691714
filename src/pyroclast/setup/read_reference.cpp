#include "pyroclast/setup/read_reference.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/read_file.hpp"

namespace pyroclast {

namespace {

using Cells = std::vector<std::string>;

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

/// The columns that a figure draws, and whether the run has that figure.
struct FigureTable {
  Cells columns;
  bool DrawnTables::*is_drawn;
};

const std::vector<FigureTable>& tables() {
  static const std::vector<FigureTable> all{
      {{"strain", "stress_MPa"}, &DrawnTables::strain_stress},
      {{"temperature_degC", "total_strain"}, &DrawnTables::temperature_strain},
      {{"temperature_degC", "total_strain_low", "total_strain_high"}, &DrawnTables::temperature_strain},
      {{"temperature_degC", "stress_MPa"}, &DrawnTables::temperature_stress},
      {{"heating_time_s", "temperature_degC"}, &DrawnTables::time_temperature}};
  return all;
}

/// Throws Error where no figure of the run shows what a reference is of.
void require_drawn(bool DrawnTables::*of, const DrawnTables& drawn) {
  if (drawn.*of) return;
  Cells shown;
  for (const FigureTable& table : tables())
    if (drawn.*table.is_drawn) shown.push_back(fmt::format("{}", fmt::join(table.columns, ",")));
  throw Error(shown.empty() ? "has no effect: the figures of this run draw no reference"
                            : fmt::format("has no effect: no figure of this run draws it; they draw {}",
                                          quoted_list(shown)));
}

Cells cells_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  Cells cells;
  while (true) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    const auto first = cell.find_first_not_of(kBlanks);
    cell = first == cell.npos ? "" : cell.substr(first, cell.find_last_not_of(kBlanks) - first + 1);
    cells.emplace_back(cell);
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool is_finite_number(const std::string& cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
}

void check_header(const Cells& header, const DrawnTables& drawn) {
  const auto found = std::ranges::find(tables(), header, &FigureTable::columns);
  if (found != tables().end()) return require_drawn(found->is_drawn, drawn);
  Cells allowed;
  for (const FigureTable& table : tables())
    allowed.push_back(fmt::format("{}", fmt::join(table.columns, ",")));
  throw Error(fmt::format("the header \"{}\" is none of {}", fmt::join(header, ","), quoted_list(allowed)));
}

void check_row(const Cells& row, std::size_t columns) {
  if (row.size() != columns)
    throw Error(fmt::format("{} values for the header's {} columns", row.size(), columns));
  for (const std::string& cell : row)
    if (!is_finite_number(cell)) throw Error(fmt::format("\"{}\" is not a finite number", cell));
}

/// Throws Error naming file and line.
void check_csv(const std::filesystem::path& path, const DrawnTables& drawn) {
  require_regular_file(path);
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error(fmt::format("cannot open the file {}", path.string()));
  Cells header;
  int rows = 0, number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == line.npos || line.front() == '#') continue;
    try {
      if (header.empty())
        check_header(header = cells_of(line), drawn);
      else
        check_row(cells_of(line), header.size()), ++rows;
    } catch (const Error& e) {
      throw Error(fmt::format("{}:{}: {}", path.string(), number, e.what()));
    }
  }
  constexpr int kLeastRows = 2;  // of which a line is made
  if (rows < kLeastRows)
    throw Error(fmt::format("{}: has {} rows of numbers under a header; {} or more are needed", path.string(),
                            rows, kLeastRows));
}

}  // namespace

void read_reference(const Section& output, const std::filesystem::path& folder, const DrawnTables& drawn) {
  const std::string name = output.word_or_text(
      "reference", built_in(), "CSV file beside the deck, see [deck.md](deck.md#reference-in-figures)",
      "what the figures draw beside the results");
  Cells words;
  for (const auto& word : built_in()) words.emplace_back(word.word);
  try {
    if (name == words[1]) require_drawn(&DrawnTables::strain_stress, drawn);
    if (name == words[2]) require_drawn(&DrawnTables::temperature_strain, drawn);
  } catch (const Error& e) {
    output.error("reference", e.what());
  }
  if (std::ranges::find(words, name) != words.end()) return;
  if (!name.ends_with(".csv")) {
    output.error("reference", fmt::format("is none of {}, and no file whose name ends in .csv{}",
                                          quoted_list(words), did_you_mean(name, words, "; ")));
    return;
  }
  try {
    check_csv(folder / name, drawn);
    output.names_file("reference", folder / name);
  } catch (const Error& e) {
    output.error("reference", e.what());
  }
}

}  // namespace pyroclast
