#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/summary.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast {

/// Writes what a run gives into its folder as it comes: `history.csv`, `fields/`, `specimen/`, and at the end
/// `summary.json`:
///
///     while (run.next()) recorder.record(run);
///     recorder.finish(run);
class Recorder {
 public:
  /// Writes the specimen and the mesh. Throws Error when a file cannot be written.
  /// \param folder  exists, see RunFolder
  Recorder(std::filesystem::path folder, const Setup& setup, const Run& run);

  /// Writes the last row, and the fields where they are due.
  void record(const Run& run);
  /// Writes the summary of the rows so far.
  Summary finish(const Run& run);

 private:
  std::filesystem::path folder_;
  std::string title_;
  std::string expansion_reading_;
  HistoryFile history_;
  FieldFiles fields_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace pyroclast
