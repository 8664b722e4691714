#include "pyroclast/thermal/time_stages.hpp"

#include <algorithm>
#include <cmath>

namespace pyroclast {

namespace {

/// Returns b_j of Meyer et al., Eq. (15).
double legendre_weight(double j) {
  return j < 2 ? 1.0 / 3.0 : (j * j + j - 2.0) / (2.0 * j * (j + 1.0));
}

/// Sets the weights: follows the increment of the whole step back to the rates that it is made of.
void set_weights(std::vector<TimeStage>& stages) {
  double share = 1.0, next = 0.0;  // shares of D_j and D_(j+1) in the last increment
  for (std::size_t j = stages.size(); j-- > 0;) {
    stages[j].weight += share * stages[j].rate;
    stages.front().weight += share * stages[j].first_rate;
    const double before =
        share * stages[j].previous + (j + 1 < stages.size() ? next * stages[j + 1].before : 0.0);
    next = share;
    share = before;
  }
}

/// Returns the stages of Meyer et al., Eqs. (16) and (17), written for increments.
std::vector<TimeStage> legendre_stages(std::int64_t count) {
  const auto last = static_cast<double>(count);
  const double w = 4.0 / (last * (last + 1.0) - 2.0);
  std::vector<TimeStage> stages{{0.0, 0.0, w / 3.0, 0.0, 0.0, w / 3.0, 0.0}};
  for (std::int64_t number = 2; number <= count; ++number) {
    const auto j = static_cast<double>(number);
    TimeStage stage{};
    stage.previous = (2.0 * j - 1.0) / j * legendre_weight(j) / legendre_weight(j - 1);
    stage.before = -(j - 1.0) / j * legendre_weight(j) / legendre_weight(j - 2);
    stage.rate = w * stage.previous;
    stage.first_rate = -(1.0 - legendre_weight(j - 1)) * stage.rate;
    stage.begin = stages.back().end;
    const double before = stages.back().begin;
    stage.end = stage.previous * stage.begin + stage.before * before + stage.rate + stage.first_rate;
    stages.push_back(stage);
  }
  set_weights(stages);
  return stages;
}

}  // namespace

std::int64_t fewest_stages(HeatScheme scheme, double ratio) {
  if (scheme == HeatScheme::euler)
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(ratio)));
  // n stages are stable for (n² + n - 2)/4 steps. Odd numbers damp the shortest waves, even ones do not.
  const auto count = static_cast<std::int64_t>(std::ceil(0.5 * (std::sqrt(9.0 + 16.0 * ratio) - 1.0)));
  return std::max<std::int64_t>(3, count + 1 - count % 2);
}

TimeStages::TimeStages(HeatScheme scheme, std::int64_t count) : count_(count) {
  if (scheme == HeatScheme::super_time_stepping) legendre_ = legendre_stages(count);
}

TimeStage TimeStages::operator[](std::int64_t j) const {
  if (!legendre_.empty()) return legendre_[static_cast<std::size_t>(j)];
  const double part = 1.0 / static_cast<double>(count_);
  const auto before = static_cast<double>(j);
  return {1.0, 0.0, part, 0.0, before * part, (before + 1.0) * part, part};
}

}  // namespace pyroclast
