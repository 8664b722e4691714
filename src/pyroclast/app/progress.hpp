#pragma once

#include <string>

#include "pyroclast/base/clock.hpp"

namespace pyroclast::app {

/// Clock that decides when to report the progress of a run, and the time left.
class Progress {
 public:
  /// Tells whether the last line was long enough ago; the next one then counts from now.
  bool line_is_due();
  /// Tells whether nothing was reported for some time, as where no look is taken; this time then counts from
  /// now.
  bool is_long_silent();
  /// Foresees the time left from now on.
  void begin_stage() { stage_start_ = Clock::now(); }
  /// Returns the time left of the stage, for the screen; empty where it is too early to say.
  /// \param done  share of the stage, 0 to 1
  std::string left(double done) const;

 private:
  Clock::time_point last_line_{}, stage_start_ = Clock::now();
};

}  // namespace pyroclast::app
