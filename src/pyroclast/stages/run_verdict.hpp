#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace pyroclast {

/// Judgement of a run on its own numbers, as its summary has it.
struct RunVerdict {
  /// Reason why the run's numbers do not count, see docs/do/studies.md; empty where they count.
  std::string does_not_count;
  std::vector<std::string> doubts;  ///< reasons why they should not be taken at face value

  /// Returns all reasons in one text; empty where there is none.
  std::string text() const;
};

RunVerdict verdict_of(const nlohmann::json& summary);

/// Returns the text of the verdict on the run that wrote a file, such as a frame of its fields or its
/// history; empty where that run finds no fault with itself, or the file holds no computed numbers of a run.
/// The folder of a run keeps the verdicts on the files of its `inputs/`.
std::string verdict_on_run_of(const std::filesystem::path& file);

}  // namespace pyroclast
