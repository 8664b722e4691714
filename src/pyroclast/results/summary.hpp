#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pyroclast/results/reference_distances.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast {

/// What a reader of a run wants to know first.
struct Summary {
  struct OfStage {
    std::string kind;
    Outcome outcome = Outcome::not_begun;
    StageReport report;
  };

  std::string title;
  Outcome outcome = Outcome::completed;
  std::vector<OfStage> stages;
  std::vector<ReferenceDistances> references;
  std::string expansion_reading;
  double wall_time = 0.0;  ///< s
  /// Error of the energy ledger over the energy turned over; empty where nothing moves.
  std::optional<double> energy_error;
  /// The same over what contacts dissipated; empty where they dissipated nothing.
  std::optional<double> error_over_dissipated;
  /// Largest stress that an exchange of computed temperatures brings at once, over the tensile strength.
  std::optional<double> exchange_stress;
  /// Error of the heat ledger over the largest of its terms; empty where no heat is conducted.
  std::optional<double> heat_error;
  bool is_sound = true;               ///< false where a stage has no results, for its ledger does not close
  std::vector<std::string> warnings;  ///< of the run as a whole; those of stages stand in their reports
};

/// Warns of a strength above one at which the specimen failed in an earlier stage: what failed hardens.
void warn_of_hardening(Summary& summary);

/// Gathers it from the rows so far, with a warning for each thing that keeps the result from being taken at
/// face value.
/// \param references  that the run is held against
Summary summarize(const Run& run, std::span<const Reference> references = {});

/// What may be a number in the summary of a run when it is over: results of stages by their names, "f_c_MPa",
/// and others by their paths, "energy_J.kinetic".
std::vector<std::string> summary_numbers(const Run& run, std::span<const Reference> references = {});

/// `summary.json`, as a text.
std::string summary_text(const Summary& summary, const Run& run);
/// The file.
void write_summary(const std::filesystem::path& path, const Summary& summary, const Run& run);

}  // namespace pyroclast
