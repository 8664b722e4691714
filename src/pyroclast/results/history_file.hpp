#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

/// `history.csv`: a row for each sample; the column names carry the units.
class HistoryFile {
 public:
  explicit HistoryFile(const std::filesystem::path& path);
  void write(const Sample& sample);

  /// Names of the columns, in order.
  static std::string header();

 private:
  LineFile file_;
};

}  // namespace pyroclast
