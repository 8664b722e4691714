#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Stage of a run with its report.
struct ReportedStage {
  std::string kind;
  Outcome outcome = Outcome::not_begun;
  StageReport report;
  bool is_sound = true;  ///< false where the stage has no results because its ledger does not close
};

/// Soundness of a run: how far its results may be taken at face value.
struct Soundness {
  /// Error of the energy ledger over the energy turned over; empty where nothing moves.
  std::optional<double> energy_error;
  /// Error of the energy ledger over the energy that contacts dissipated; empty where they dissipated
  /// nothing.
  std::optional<double> error_over_dissipated;
  /// Stress that an exchange of computed temperatures brings at once, in the mean over the temperatures of
  /// the stage where it is largest, over the tensile strength.
  std::optional<double> exchange_stress;
  /// Error of the heat ledger over the largest of its terms; empty where no heat is conducted.
  std::optional<double> heat_error;
  /// Warnings of the run as a whole; warnings of stages stand in their reports.
  std::vector<std::string> warnings;
};

/// Reports on the stages of a run so far. A stage whose ledger does not close has no results.
std::vector<ReportedStage> report_stages(const Run& run);

/// Judges the rows so far, with a warning for each thing that keeps the results from being taken at face
/// value.
Soundness judge_soundness(const Run& run, const std::vector<ReportedStage>& stages);

/// Warns of a strength above an earlier stage's at which the specimen had failed: a failed specimen hardens.
void warn_of_hardening(std::vector<ReportedStage>& stages);

/// Returns the last value of a column in the first rows. Where a stage lacks the column the value stands in
/// an earlier row.
std::optional<double> last_of(const History& history, std::string_view column, std::size_t rows);
std::optional<double> last_of(const History& history, std::string_view column);

}  // namespace pyroclast
