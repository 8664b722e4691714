#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "pyroclast/base/clock.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/profile_files.hpp"
#include "pyroclast/results/spall_files.hpp"
#include "pyroclast/results/summary.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Writer of a run's results into its folder as they come: `run.json`, `history.csv`, `fields/`, `specimen/`,
/// `properties.csv`, where heat is conducted `temperature_profile.csv` and `isotherm.csv`, where pieces may
/// leave `spalls.csv` and `spalled_blocks.csv`, and at the end `summary.json`:
///
///     writer.begin(run);
///     while (run.next()) writer.write(run);
///     writer.finish(run);
class ResultsWriter {
 public:
  /// Touches no file yet.
  /// \param folder  folder that exists, see RunFolder; empty where another rank writes: then the functions
  ///                below do their part of the collectives alone
  ResultsWriter(std::filesystem::path folder, const Setup& setup);

  /// Writes the specimen, the mesh, the properties where the temperature changes, and all present rows. Where
  /// a run goes on from a checkpoint, anything written after the checkpoint is removed. Throws Error when a
  /// file cannot be written.
  void begin(const Run& run);
  /// Returns a line for each file of an earlier frame that `begin` did not find whole; the lines are also
  /// among the warnings of the summary.
  const std::vector<std::string>& lost_frames() const { return lost_frames_; }
  /// Writes the last row, and the fields where they are due.
  void write(const Run& run);
  /// Writes the summary of the rows so far.
  Summary finish(const Run& run);
  /// Returns the summary of the rows so far without writing it.
  Summary summary(const Run& run) const;
  /// Adds a line to the warnings of the summary.
  void warn(std::string line) { warnings_.push_back(std::move(line)); }

  /// Returns the names of the numbers that `finish` will have, see summary_numbers.
  std::vector<std::string> numbers(const Run& run) const { return summary_numbers(run, references_); }

  /// Returns the wall time of the run, with the parts that other processes did, s.
  double wall_time() const;
  const FrameRows& frames() const { return frames_; }
  /// \param rows  number of rows of the history
  void visit_state(StateVisitor& visitor, std::size_t rows);

 private:
  std::filesystem::path folder_;
  std::string title_;
  std::string expansion_reading_;
  specimen::SpecimenParameters specimen_;
  std::vector<Reference> references_;
  std::vector<std::string> warnings_;  ///< warnings of the deck, and of changes to the run
  std::vector<std::string> lost_frames_;
  Interval temperatures_;  ///< temperatures to which the run may come, °C
  double exposure_;        ///< time for which boundaries act, s
  bool has_fields_;        ///< true where fields are written
  std::optional<HistoryFile> history_;
  std::optional<ProfileFiles> profile_;
  std::optional<FieldFiles> fields_;
  std::optional<SpallFiles> spalls_;
  ProfileRows profile_rows_;
  FrameRows frames_;
  double earlier_ = 0.0;  ///< wall time of earlier processes, s
  Clock::time_point start_ = Clock::now();
};

}  // namespace pyroclast
