#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/summary.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast {

/// Writes what a run gives into its folder as it comes: `history.csv`, `fields/`, `specimen/`, and at the end
/// `summary.json`:
///
///     recorder.begin(run);
///     while (run.next()) recorder.record(run);
///     recorder.finish(run);
class Recorder {
 public:
  /// Touches nothing yet.
  /// \param folder  exists, see RunFolder
  Recorder(std::filesystem::path folder, const Setup& setup);

  /// Writes the specimen, the mesh, and all rows that there are; of a run that goes on from a checkpoint,
  /// what was written after it goes. Throws Error when a file cannot be written.
  void begin(const Run& run);
  /// Of each file of an earlier frame that `begin` did not find whole, a line; also among the warnings of the
  /// summary.
  const std::vector<std::string>& lost_frames() const { return lost_frames_; }
  /// Writes the last row, and the fields where they are due.
  void record(const Run& run);
  /// Writes the summary of the rows so far.
  Summary finish(const Run& run);
  /// The same, not written.
  Summary summary(const Run& run) const;
  /// Adds a line to the warnings of the summary.
  void warn(std::string line) { warnings_.push_back(std::move(line)); }

  /// What `finish` will have as numbers, see summary_numbers.
  std::vector<std::string> numbers(const Run& run) const { return summary_numbers(run, references_); }

  /// Of the run, with those parts of it that other processes did, s.
  double wall_time() const;
  const FrameRows& frames() const { return frames_; }
  /// \param rows  of the history
  void visit_state(StateVisitor& visitor, std::size_t rows);

 private:
  std::filesystem::path folder_;
  std::string title_;
  std::string expansion_reading_;
  specimen::SpecimenParameters specimen_;
  std::vector<Reference> references_;
  std::vector<std::string> warnings_;  ///< of the deck, and of what was done to the run
  std::vector<std::string> lost_frames_;
  bool has_fields_;  ///< whether they are written
  std::optional<HistoryFile> history_;
  std::optional<FieldFiles> fields_;
  FrameRows frames_;
  double earlier_ = 0.0;  ///< wall time of earlier processes, s
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace pyroclast
