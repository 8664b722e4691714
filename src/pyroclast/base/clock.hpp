#pragma once

#include <chrono>

namespace pyroclast {

/// Clock of wall times, which never goes back.
using Clock = std::chrono::steady_clock;

/// Returns the wall time since then, s.
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace pyroclast
