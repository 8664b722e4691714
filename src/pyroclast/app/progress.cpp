#include "pyroclast/app/progress.hpp"

#include <algorithm>

#include "pyroclast/app/open.hpp"

namespace pyroclast::app {

namespace {

constexpr double kSecondsBetweenLines = 5.0;
constexpr double kSecondsOfSilence = 15.0;
constexpr double kLeastProgressToForesee = 1e-3;

}  // namespace

bool Progress::line_is_due() {
  if (seconds_since(last_line_) < kSecondsBetweenLines) return false;
  last_line_ = Clock::now();
  return true;
}

bool Progress::is_long_silent() {
  if (seconds_since(std::max(last_line_, stage_start_)) < kSecondsOfSilence) return false;
  last_line_ = Clock::now();
  return true;
}

std::string Progress::left(double done) const {
  if (!(done > kLeastProgressToForesee)) return "";
  return duration(seconds_since(stage_start_) / done * (1.0 - done)) + " left";
}

}  // namespace pyroclast::app
