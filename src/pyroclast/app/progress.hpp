#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pyroclast/base/clock.hpp"

namespace pyroclast::app {

/// Clock that decides when to report the progress of a run, and the time left.
class Progress {
 public:
  /// \param steps  steps of the mechanics that the run has behind it
  explicit Progress(std::int64_t steps) : first_step_(steps) {}
  /// Tells whether the last line was long enough ago; the next one then counts from now.
  bool line_is_due();
  /// Tells whether nothing was reported for some time, as where no look is taken; this time then counts from
  /// now.
  bool is_long_silent();
  /// Foresees the time left from now on.
  /// \param steps_after  steps of the stages after this one; empty where these cannot be foreseen by steps
  void begin_stage(std::optional<double> steps_after);
  /// Returns the time left of the run, for the screen, else that of its stage; empty where it is too early to
  /// say.
  /// \param done  share of the stage, 0 to 1
  /// \param steps  steps that the run has behind it
  std::string left(double done, std::int64_t steps) const;

 private:
  std::int64_t first_step_;
  std::optional<double> steps_after_;
  Clock::time_point last_line_{}, start_ = Clock::now(), stage_start_ = start_;
};

}  // namespace pyroclast::app
