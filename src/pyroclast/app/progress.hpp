#pragma once

#include <chrono>
#include <string>

namespace pyroclast::app {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start);

/// When to tell how far a run is, and how long it will still take.
class Progress {
 public:
  /// Whether the last line was long enough ago; then the next one is counted from now.
  bool line_is_due();
  /// Whether nothing was told for some time, as where no look is taken; then that is counted from now.
  bool is_long_silent();
  /// What follows is foreseen from here on.
  void begin_stage() { stage_start_ = Clock::now(); }
  /// Time left of the stage, for the screen; empty where that is too early to say.
  /// \param done  share of the stage, 0 to 1
  std::string left(double done) const;

 private:
  Clock::time_point last_line_{}, stage_start_ = Clock::now();
};

}  // namespace pyroclast::app
