#include "pyroclast/tables/read_choice.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/tables/header.hpp"

namespace pyroclast {
namespace {

struct Counts {
  std::size_t least, most;

  bool hold(std::size_t count) const { return count >= least && count <= most; }
  std::string words() const {
    return least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
  }
};

/// Reads the chosen columns; empty after an error.
std::vector<ColumnChoice::TableColumn> read_columns(const Section& section, const Counts& counts) {
  const auto list = nlohmann::json::parse(section.json("columns", "list of names or numbers", "[]",
                                                       "columns by their names, or by their numbers from 1"));
  if (list.is_array() && list.empty()) return {};
  std::vector<ColumnChoice::TableColumn> columns;
  bool is_good = true;
  for (const auto& item : list.is_array() ? list : nlohmann::json::array()) {
    if (item.is_string())
      columns.push_back({item.get<std::string>(), 0});
    else if (item.is_number_integer() && item.get<long long>() > 0)
      columns.push_back({"", item.get<std::size_t>()});
    else
      is_good = false;
  }
  if (is_good && counts.hold(columns.size())) return columns;
  section.error("columns", fmt::format("must be a list of {} columns, each its name or its number from 1",
                                       counts.words()));
  return {};
}

}  // namespace

ColumnChoice read_column_choice(const Section& section, const std::string& file, std::size_t least,
                                std::size_t most) {
  const Counts counts{least, most};
  ColumnChoice choice{file, read_columns(section, counts), {}};
  choice.units = section.optional_texts(
      "units", "units of the columns, where the file does not say them; `\"\"` where it does");
  if (choice.units.empty()) return choice;
  for (std::string& unit : choice.units)
    if (!unit.empty()) unit = unit_cell(unit).value_or(unit);  // "[-]" is "1" here too
  const bool fits = choice.columns.empty() ? counts.hold(choice.units.size())
                                           : choice.units.size() == choice.columns.size();
  if (!fits) {
    const std::string wanted =
        choice.columns.empty() ? counts.words() : fmt::format("{}", choice.columns.size());
    section.error("units", fmt::format("must be a list of {} units, \"\" where the file says it", wanted));
    choice.units.clear();
  }
  return choice;
}

std::string read_start(const Section& section) {
  return section.text(
      "start", "",
      "time of the file that counts as 0, written as there (`\"10:14:05\"`, "
      "`\"2026-03-02T10:14:05\"`) or a quantity (`\"300 s\"`), or `\"first row\"`; without it "
      "dates and times of the day count from the first row, other times from 0");
}

}  // namespace pyroclast
