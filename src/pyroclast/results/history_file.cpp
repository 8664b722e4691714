#include "pyroclast/results/history_file.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pyroclast {

HistoryFile::HistoryFile(const std::filesystem::path& path, const History& history) : file_(path) {
  std::vector<std::string> names;
  for (const Column& column : history.columns()) names.push_back(column.name);
  file_.line(fmt::format("{}", fmt::join(names, ",")));
}

void HistoryFile::write(const History& history) {
  std::vector<std::string> cells;
  for (const auto& value : history.row(history.row_count() - 1)) cells.push_back(printed(value));
  file_.line(fmt::format("{}", fmt::join(cells, ",")));
}

std::string printed(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

}  // namespace pyroclast
