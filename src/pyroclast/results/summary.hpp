#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pyroclast/results/reference_distances.hpp"
#include "pyroclast/simulation/watching/soundness.hpp"

namespace pyroclast {

/// Summary of a run: what a reader wants to know first.
struct Summary {
  std::string title;
  Outcome outcome = Outcome::completed;
  std::vector<ReportedStage> stages;
  std::vector<ReferenceDistances> references;
  std::string expansion_reading;
  double wall_time = 0.0;  ///< wall time, s
  Soundness soundness;
  /// Side of the specimen from which depths count in `temperature_profile.csv`; empty where none is written.
  std::string heated_face;
  /// Warnings of the run as a whole; warnings of stages stand in their reports.
  std::vector<std::string> warnings;

  bool is_sound() const { return std::ranges::all_of(stages, &ReportedStage::is_sound); }
};

/// Makes the summary of the rows so far, with a warning for each thing that keeps the results from being
/// taken at face value.
/// \param references  references with which the run is compared
Summary summarize(const Run& run, std::span<const Reference> references = {});

/// Returns the names of all values that may be numbers in the summary of a run when it is over: results of
/// stages by their names, "f_c_MPa", and others by their paths, "energy_J.kinetic".
std::vector<std::string> summary_numbers(const Run& run, std::span<const Reference> references = {});

/// Returns the names of those numbers that are results of the test: what a laboratory would report.
std::vector<std::string> test_results(const Run& run);

/// Returns `summary.json` as a text.
std::string summary_text(const Summary& summary, const Run& run);
/// Writes `summary.json`.
void write_summary(const std::filesystem::path& path, const Summary& summary, const Run& run);

}  // namespace pyroclast
