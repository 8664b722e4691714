#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

/// File `history.csv`: a row for each look. The column names carry the units, and a cell is empty where the
/// stage of its row does not have the quantity.
class HistoryFile {
 public:
  /// Writes the names of the columns, and the present rows.
  HistoryFile(const std::filesystem::path& path, const History& history);
  /// Writes the last row.
  void write(const History& history);

 private:
  LineFile file_;
};

/// Returns some cells of a row as a line of a CSV file.
std::string printed_row(const std::vector<std::optional<double>>& cells);

/// Returns a value as the result files have it; empty where there is none.
std::string printed(const std::optional<double>& value);

}  // namespace pyroclast
