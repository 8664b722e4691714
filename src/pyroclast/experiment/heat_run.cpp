#include "pyroclast/experiment/heat_run.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

void require_positive(double value, const char* what, const char* unit) {
  if (!(value > 0.0))
    throw Error(fmt::format("{} is {} {}, but it must be greater than 0", what, value, unit));
}

/// The first multiple of the interval after a time.
double next_multiple(double interval, double time) {
  if (interval == kNever) return kNever;
  const double next = interval * (std::floor(time / interval) + 1.0);
  return next > time ? next : next + interval;  // rounding
}

}  // namespace

HeatOutcome run_heat(TemperatureField& field, const HeatCase& heat, const HeatRun& run,
                     const HeatLook& look) {
  require_positive(run.interval, "the time between two looks at the temperatures", "s");
  if (run.steady_rate) require_positive(*run.steady_rate, "the tolerance of the steady state", "K/s");
  const double steady_from = run.steady_rate ? constant_from(heat, run.duration) : kNever;
  if (!look(field)) return HeatOutcome::interrupted;
  while (field.time() < run.duration) {
    const bool may_be_steady = field.time() >= steady_from;
    const double steady_rate = may_be_steady ? *run.steady_rate : 0.0;
    double until = std::min(run.duration, next_multiple(run.interval, field.time()));
    if (!may_be_steady) until = std::min(until, steady_from);
    field.advance(run.change, until, steady_rate);
    if (!look(field)) return HeatOutcome::interrupted;
    if (field.conduction()->rate() < steady_rate) return HeatOutcome::steady;
  }
  return HeatOutcome::completed;
}

}  // namespace pyroclast
