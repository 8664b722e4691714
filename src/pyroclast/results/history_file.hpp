#pragma once

#include <filesystem>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/history.hpp"

namespace pyroclast {

/// `history.csv`: a row for each look; the column names carry the units, and a cell is empty where the stage
/// of its row does not have the quantity.
class HistoryFile {
 public:
  /// Writes the names of the columns.
  HistoryFile(const std::filesystem::path& path, const History& history);
  /// Writes the last row.
  void write(const History& history);

 private:
  LineFile file_;
};

/// A value as the result files have it; nothing where there is none.
std::string printed(const std::optional<double>& value);

}  // namespace pyroclast
