#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/heat_run.hpp"

namespace pyroclast {

/// What a reader of a run of heat conduction alone wants to know first.
struct HeatSummary {
  std::string title;
  HeatOutcome outcome = HeatOutcome::completed;
  double time = 0.0;                                ///< reached, s
  double mean = 0.0, minimum = 0.0, maximum = 0.0;  ///< temperatures then, °C
  double rate = 0.0;                                ///< of the last step, see Conduction::rate, K/s
  HeatLedger heat;
  double overshoot = 0.0;    ///< see Conduction::largest_overshoot, K
  std::int64_t steps = 0;    ///< of the solver
  std::int64_t retries = 0;  ///< steps taken back because a temperature changed too much
  std::int64_t stages = 0;   ///< evaluations of the conduction equation
  double wall_time = 0.0;    ///< s
  std::vector<std::string> warnings;

  /// Error of the ledger over the largest of its terms.
  double ledger_error() const;
};

/// Gathers it after a run, with a warning for each thing that keeps the result from being taken at face
/// value. The field must be one that conduction computes.
HeatSummary summarize(const Case& c, const TemperatureField& field, HeatOutcome outcome);

/// `summary.json`.
void write_summary(const std::filesystem::path& path, const HeatSummary& summary);

}  // namespace pyroclast
