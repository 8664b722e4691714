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

const char* describe(HeatOutcome outcome) {
  switch (outcome) {
    case HeatOutcome::completed:
      return "the stated duration was completed";
    case HeatOutcome::steady:
      return "the temperatures became steady";
    case HeatOutcome::interrupted:
      return "interrupted";
  }
  return "";
}

HeatOutcome run_heat(TemperatureField& field, const HeatCase& heat, const HeatRun& run,
                     HeatObserver& observer) {
  require_positive(run.interval, "the time between two looks at the temperatures", "s");
  require_positive(run.frame_interval, "the time between two frames", "s");
  if (run.steady_rate) require_positive(*run.steady_rate, "the tolerance of the steady state", "K/s");
  field.begin_exposure(temperature_range(heat, run.duration));
  const double steady_from = run.steady_rate ? constant_from(heat, run.duration) : kNever;
  observer.look(field);
  observer.frame(field);
  double next_frame = next_multiple(run.frame_interval, field.time());
  std::optional<HeatOutcome> end;
  while (!end) {
    const bool may_be_steady = field.time() >= steady_from;
    const double steady_rate = may_be_steady ? *run.steady_rate : 0.0;
    double until = std::min({run.duration, next_frame, next_multiple(run.interval, field.time())});
    if (!may_be_steady) until = std::min(until, steady_from);
    field.begin_advance(run.change, until, steady_rate);
    while (!field.advance(field.conduction()->stages_per_batch()))
      if (observer.stop_requested()) {
        field.end_advance();
        return HeatOutcome::interrupted;
      }
    observer.look(field);
    if (field.conduction()->rate() < steady_rate)
      end = HeatOutcome::steady;
    else if (field.time() >= run.duration)
      end = HeatOutcome::completed;
    else if (observer.stop_requested())
      end = HeatOutcome::interrupted;
    if (end || field.time() >= next_frame) {
      observer.frame(field);
      next_frame = next_multiple(run.frame_interval, field.time());
    }
  }
  return *end;
}

}  // namespace pyroclast
