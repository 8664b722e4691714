#pragma once

#include <filesystem>
#include <string>

namespace pyroclast {

/// Strength that another run measured.
struct StrengthOfRun {
  double value = 0.0;       ///< f_c of the stage that is the run's test, Pa
  std::string deck_sha256;  ///< hash of that run's deck
  std::string doubts;  ///< reasons why it should not be taken at face value, see RunVerdict; may be empty
  std::filesystem::path summary, manifest, facts;  ///< files of that run that were read
};

/// Reads f_c of a run from its summary, with its manifest and run.json beside it.
/// \param place  folder of a run, or its summary
/// \throws Error naming the file where there is none, it is no summary, or the run has no f_c, or none that
/// counts, with the reason
StrengthOfRun strength_of_run(const std::filesystem::path& place);

}  // namespace pyroclast
