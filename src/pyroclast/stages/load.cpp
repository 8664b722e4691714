#include "pyroclast/stages/load.hpp"

#include <algorithm>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/settle.hpp"

namespace pyroclast {

namespace {

constexpr std::int64_t kStepsPerLook = 200;
/// The force of a ramp is adjusted this often; a whole part of a look.
constexpr std::int64_t kStepsPerForce = 20;

/// The load is a stress, or a level: a fraction of a strength that is given with it.
std::unique_ptr<Stage> read_load(const Section& s, const StageTables&) {
  Load::Keys keys;
  if (s.has("level")) {
    keys.level = s.number("level", Range::non_negative(), "stress over f_c");
    keys.stress =
        *keys.level * s.quantity("f_c", unit::stress, Range::positive(), "strength that level is a share of");
    if (s.has("stress")) s.error("stress", "either stress, or level and f_c; not both");
  } else {
    keys.stress = s.quantity("stress", unit::stress, Range::non_negative(),
                             "force on the upper platen over the area of the specimen");
  }
  keys.ramp_time =
      s.quantity("ramp_time", unit::time, Range::non_negative(), "in which the force rises evenly");
  keys.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive(), kAtRest);
  keys.most_steps = s.integer("most_steps", Range::between(1, 1e12),
                              "after so many steps behind the ramp without rest the run ends, and says so");
  return std::make_unique<Load>(keys);
}

}  // namespace

StageKind load_kind() {
  return {"load",
          "brings the force on the upper platen to a value, and the body to rest; the platen does not tilt",
          {},
          read_load};
}

double ramp_share(std::int64_t steps, double time_step, double ramp_time) {
  const double elapsed = static_cast<double>(steps) * time_step;
  return ramp_time > 0.0 ? std::min(1.0, elapsed / ramp_time) : 1.0;
}

void Load::begin(Simulation& simulation) {
  first_stress_ = simulation.press().stress_held();
  simulation.press().control_by_force();
}

/// To what the ramp has in the middle of the steps to come.
void Load::adjust_force(Simulation& simulation) const {
  const double time_step = simulation.mechanics().time_step();
  const double ahead = keys_.ramp_time > 0.0 ? 0.5 * kStepsPerForce * time_step / keys_.ramp_time : 0.0;
  const double share = std::min(1.0, ramp_share(steps_, time_step, keys_.ramp_time) + ahead);
  simulation.press().hold(first_stress_ + share * (keys_.stress - first_stress_));
}

bool Load::advance(Simulation& simulation, int most_steps) {
  if (steps_ % kStepsPerForce == 0) adjust_force(simulation);
  const auto steps = std::min<std::int64_t>(kStepsPerForce - steps_ % kStepsPerForce, most_steps);
  simulation.mechanics().advance(static_cast<int>(steps));
  steps_ += steps;
  return steps_ % kStepsPerLook == 0;
}

Verdict Load::judge(Simulation& simulation) {
  if (progress(simulation) < 1.0) return {};
  const Mechanics<2>& mechanics = simulation.mechanics();
  if (mechanics.unbalanced_ratio() < keys_.unbalanced_ratio) return {.over = true};
  const double after_ramp = static_cast<double>(steps_) - keys_.ramp_time / mechanics.time_step();
  if (after_ramp >= static_cast<double>(keys_.most_steps))
    return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

double Load::progress(const Simulation& simulation) const {
  return ramp_share(steps_, simulation.mechanics().time_step(), keys_.ramp_time);
}

StageReport Load::report(const History& history, RowRange rows, Outcome) const {
  StageReport report;
  report.results = {{"load_stress_MPa", keys_.stress * 1e-6},
                    {"load_level", keys_.level ? Result::Value(*keys_.level) : Result::Value()}};
  if (rows.empty()) return report;
  report.results.push_back({"steps", steps_});
  report.results.push_back({"strain", history.values("strain", rows).back()});
  return report;
}

Forecast Load::forecast(const Simulation& simulation, Foreseen&) const {
  const double ramp = keys_.ramp_time / simulation.mechanics().time_step();
  // along a slow ramp the body is near its rest already
  const double rest = std::min(std::max(steps_to_rest(keys_.unbalanced_ratio) - ramp, 1.0 * kStepsPerLook),
                               static_cast<double>(keys_.most_steps));
  return {.steps = ramp + rest, .looks = (ramp + rest) / kStepsPerLook, .frames = 1.0};
}

void Load::visit_state(StateVisitor& visitor) {
  visitor.visit("steps", steps_);
  visitor.visit("first_stress", first_stress_);
}

}  // namespace pyroclast
