#include "pyroclast/results/history_file.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pyroclast {

namespace {

std::string text_of(const History& history) {
  std::vector<std::string> names;
  for (const Column& column : history.columns()) names.push_back(column.name);
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (std::size_t row = 0; row < history.row_count(); ++row) text += printed_row(history.row(row)) + "\n";
  return text;
}

}  // namespace

HistoryFile::HistoryFile(const std::filesystem::path& path, const History& history)
    : file_(path, text_of(history)) {}

void HistoryFile::write(const History& history) {
  file_.line(printed_row(history.row(history.row_count() - 1)));
}

std::string printed_row(const std::vector<std::optional<double>>& row) {
  std::vector<std::string> cells;
  for (const auto& value : row) cells.push_back(printed(value));
  return fmt::format("{}", fmt::join(cells, ","));
}

std::string printed(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

}  // namespace pyroclast
