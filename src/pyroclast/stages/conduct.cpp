#include "pyroclast/stages/conduct.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/known_results.hpp"
#include "pyroclast/stages/water_results.hpp"

namespace pyroclast {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

constexpr StageNeeds kConductNeeds{
    .mechanics = false, .field = FieldChoice::computed, .frames_in_time = FramesInTime::needed};

std::unique_ptr<Stage> read_conduct(const Section& s, const StageTables& tables) {
  Conduct::Keys keys;
  keys.duration = s.quantity("duration", unit::time, Range::positive(), "time for which the boundaries act");
  keys.interval = s.quantity("interval", unit::time, Range::positive(),
                             "rows of history.csv at its multiples, of the heating time");
  keys.change = s.quantity("change", unit::temperature_difference, Range::positive(), keys.change,
                           "another row when a temperature has changed by so much since the last one");
  if (s.has("steady_rate"))
    keys.steady_rate = s.quantity(
        "steady_rate", unit::heating_rate, Range::positive(),
        "the stage ends earlier when temperatures are [steady](../understand/heat.md#steady-state)");
  keys.frame_interval = tables.output.frame_interval;
  return std::make_unique<Conduct>(keys);
}

}  // namespace

StageKind conduct_kind() {
  return {"conduct", "lets heat flow by the boundaries of [heat], and moves nothing; needs conduction",
          kConductNeeds, read_conduct};
}

StageNeeds Conduct::needs() const {
  return kConductNeeds;
}

void Conduct::begin(Simulation& simulation) {
  kept_.began = simulation.field().time();
  simulation.show_cracks();
  simulation.begin_exposure(end());
  kept_.steady_from = keys_.steady_rate ? constant_from(simulation.heat(), end()) : kNever;
  kept_.next_frame = next_multiple(keys_.frame_interval, kept_.began);
}

double Conduct::steady_rate(const Simulation& simulation) const {
  return simulation.field().time() >= kept_.steady_from ? *keys_.steady_rate : 0.0;
}

void Conduct::begin_flow(const Simulation& simulation) {
  const double time = simulation.field().time();
  kept_.flow_steady = steady_rate(simulation);
  double until = earliest({end(), kept_.next_frame, next_multiple(keys_.interval, time)});
  if (kept_.flow_steady == 0.0) until = earliest({until, kept_.steady_from});
  flow_.begin(keys_.change, until, kept_.flow_steady);
}

bool Conduct::advance(Simulation& simulation, int) {
  if (!flow_.flows()) begin_flow(simulation);
  if (!flow_.advance(simulation.field())) return false;
  simulation.follow_heat();
  simulation.see_temperatures();
  return true;
}

Verdict Conduct::judge(Simulation& simulation) {
  const double time = simulation.field().time();
  if (simulation.field().conduction()->rate() < kept_.flow_steady)
    return {.over = true, .outcome = Outcome::steady};
  if (time >= end()) return {.over = true};
  if (time < kept_.next_frame) return {};
  kept_.next_frame = next_multiple(keys_.frame_interval, time);
  return {.frame = true};
}

double Conduct::progress(const Simulation& simulation) const {
  return std::clamp((simulation.field().time() - kept_.began) / keys_.duration, 0.0, 1.0);
}

StageReport Conduct::report(const History& history, RowRange rows, Outcome outcome) const {
  StageReport report;
  const auto last_or_none = [&](const char* name) { return last_value(history, name, rows); };
  report.results = {
      {known::steady, outcome == Outcome::steady},
      {known::heating_time, last_or_none("heating_time_s")},
      {known::temperature_mean, last_or_none("temperature_degC")},
      {known::temperature_min, last_or_none("temperature_min_degC")},
      {known::temperature_max, last_or_none("temperature_max_degC")},
      {known::rate, last_or_none("rate_K_s")},
  };
  if (rows.empty()) return report;
  const auto last = [&](const char* name) { return history.values(name, rows).back(); };
  const double rate = last("rate_K_s");
  report.lines.push_back(fmt::format("mean {:.1f} degC, {:.1f} to {:.1f}, changing by {:.2g} K/s",
                                     last("temperature_degC"), last("temperature_min_degC"),
                                     last("temperature_max_degC"), rate));
  tell_water(history, rows, report);
  if (outcome == Outcome::completed && keys_.steady_rate)
    report.warnings.push_back(
        fmt::format("no steady state: the temperatures still change by {:.2g} K/s, more than {:.2g} K/s",
                    rate, *keys_.steady_rate));
  return report;
}

Forecast Conduct::forecast(const Simulation& simulation, Foreseen& foreseen) const {
  foreseen.temperature = foreseen.hottest;
  // the temperature that changes most crosses the range of all temperatures once
  const Interval range = temperature_range(simulation.heat(), keys_.duration);
  return {.looks = keys_.duration / keys_.interval + (range.upper - range.lower) / keys_.change,
          .frames = keys_.duration / keys_.frame_interval + 1.0,
          .heating_duration = keys_.duration};
}

void Conduct::visit_state(StateVisitor& visitor) {
  auto& [began, steady_from, flow_steady, next_frame] =
      kept_;  // another member does not compile until it has a name here
  visitor.visit("began", began);
  visitor.visit("steady_from", steady_from, state::number());
  visitor.visit("flow_steady", flow_steady);
  visitor.visit("next_frame", next_frame, state::number());
  flow_.visit_state(visitor);
}

}  // namespace pyroclast
