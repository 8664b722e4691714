#include "pyroclast/app/progress.hpp"

#include <algorithm>

#include "pyroclast/app/deck_option.hpp"

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

void Progress::begin_stage(std::optional<double> steps_after) {
  stage_start_ = Clock::now();
  steps_after_ = steps_after;
}

std::string Progress::left(double done, std::int64_t steps) const {
  if (!(done > kLeastProgressToForesee)) return "";
  const double of_stage = seconds_since(stage_start_) / done * (1.0 - done);
  const auto made = static_cast<double>(steps - first_step_);
  if (!steps_after_ || (*steps_after_ > 0.0 && made <= 0.0)) return duration(of_stage) + " left of the stage";
  const double after = *steps_after_ > 0.0 ? *steps_after_ / made * seconds_since(start_) : 0.0;
  return duration(of_stage + after) + " left";
}

}  // namespace pyroclast::app
