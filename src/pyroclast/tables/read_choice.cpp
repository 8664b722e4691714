#include "pyroclast/tables/read_choice.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pyroclast {
namespace {

/// Empty after an error.
std::vector<ColumnChoice::Column> read_columns(const Section& section, std::size_t count) {
  const auto list = nlohmann::json::parse(section.json("columns", "list of names or numbers", "[]",
                                                       "columns by their names, or by their numbers from 1"));
  if (list.is_array() && list.empty()) return {};
  std::vector<ColumnChoice::Column> columns;
  bool is_good = true;
  for (const auto& item : list.is_array() ? list : nlohmann::json::array()) {
    if (item.is_string())
      columns.push_back({item.get<std::string>(), 0});
    else if (item.is_number_integer() && item.get<long long>() > 0)
      columns.push_back({"", item.get<std::size_t>()});
    else
      is_good = false;
  }
  if (is_good && columns.size() == count) return columns;
  section.error("columns",
                fmt::format("must be a list of {} columns, each its name or its number from 1", count));
  return {};
}

}  // namespace

ColumnChoice read_column_choice(const Section& section, const std::string& file, std::size_t count) {
  ColumnChoice choice{file, read_columns(section, count), {}};
  choice.units = section.optional_texts(
      "units", "units of the columns, where the file does not say them; `\"\"` where it does");
  if (!choice.units.empty() && choice.units.size() != count) {
    section.error("units", fmt::format("must be a list of {} units, \"\" where the file says it", count));
    choice.units.clear();
  }
  return choice;
}

}  // namespace pyroclast
