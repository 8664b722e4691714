#include "pyroclast/stages/load.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/known_results.hpp"
#include "pyroclast/stages/settle.hpp"
#include "pyroclast/stages/strength_of_run.hpp"

namespace pyroclast {

namespace {

constexpr std::int64_t kLoadStepsPerLook = 200;
/// Strain at which concrete has long passed its peak, at any temperature.
constexpr double kFailureStrain = 0.01;
/// Steps between two adjustments of the force of a ramp; a whole part of a look.
constexpr std::int64_t kStepsPerForce = 20;
/// Digits of a hash by which summaries name a deck.
constexpr std::size_t kShortHash = 8;

/// Takes the strength of a run. Returns whose it is, for the summary.
/// \param s  table that names the run
std::string read_run(const Section& s, const std::filesystem::path& run, Load::Keys& keys) {
  try {
    const StrengthOfRun found = strength_of_run(run);
    s.names_file("run", found.summary);
    s.needs_file(found.manifest);
    s.needs_file(found.facts);
    keys.strength = found.value;
    keys.run = run;
    if (!found.doubts.empty())
      s.warn("run", fmt::format("its f_c, {:.4g} MPa, is in doubt: {}", found.value * 1e-6, found.doubts));
    return fmt::format("of the run of deck {}", found.deck_sha256.substr(0, kShortHash));
  } catch (const Error& error) {
    s.error("run", error.what());
    return {};
  }
}

/// Reads the strength that level is a share of: a stress, or that of another run.
void read_strength(const Section& s, const std::filesystem::path& folder, Load::Keys& keys) {
  const Range range = Range::positive().usually(1e6, 300e6);
  s.describe("f_c",
             {.value = "stress, or { run = folder }",
              .form = ValueForm::quantity,
              .unit = unit::stress,
              .range = range,
              .name = "strength of a run"},
             "strength of which level is a share");
  std::string of = "as the deck states it";
  if (s.is_table("f_c")) {
    const Section own = s.section("f_c", "the strength of another run");
    const std::string run = own.text(
        "run", "Folder of the run, beside the deck, which gives f_c: best a run of the same specimen.");
    if (own.ok()) of = read_run(own, folder / run, keys);
  } else {
    keys.strength = s.quantity("f_c", unit::stress, range, "");
  }
  keys.strength_of = s.text(
      "f_c_of", of, "whose strength this is, for the summary: best a run of the same specimen at 20 °C");
}

/// Reads the load: a stress, or a level, which is a fraction of a strength that is given with it.
std::unique_ptr<Stage> read_load(const Section& s, const StageTables& tables) {
  Load::Keys keys;
  if (s.has("level")) {
    keys.level = s.number("level", Range::non_negative(), "stress over f_c");
    read_strength(s, tables.folder, keys);
    keys.stress = *keys.level * keys.strength;
    if (*keys.level >= 1.0)
      s.warn("level", "is the strength or more, so the specimen will probably be crushed");
    if (s.has("stress")) s.error("stress", "either stress, or level and f_c; not both");
  } else {
    keys.stress = s.quantity("stress", unit::stress, Range::non_negative().usually(0.0, 200e6),
                             "force on the upper platen over the area of the specimen");
  }
  keys.ramp_time =
      s.quantity("ramp_time", unit::time, Range::non_negative(), "in which the force rises evenly");
  keys.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive().usually(1e-8, 0.01), kAtRest);
  keys.most_steps = s.integer("most_steps", Range::between(1, 1e12),
                              "after so many steps behind the ramp without rest the run ends, and says so");
  keys.failure_strain = s.number("failure_strain", Range::inside(0.0, 1.0).usually(1e-3, 0.1), kFailureStrain,
                                 "the specimen is crushed when its ends have come nearer by this since the "
                                 "stage began");
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
  simulation.press().control_by_force();
  kept_.first_stress = simulation.press().stress_held();
  kept_.first_strain = simulation.press().specimen_strain();
}

/// Holds the force that the ramp has in the middle of the steps to come.
void Load::adjust_force(Simulation& simulation) const {
  const double share = share_held_from(kept_.steps, simulation.motion().time_step());
  simulation.press().hold(kept_.first_stress + share * (keys_.stress - kept_.first_stress));
}

double Load::share_held_from(std::int64_t steps, double time_step) const {
  const double ahead = keys_.ramp_time > 0.0 ? 0.5 * kStepsPerForce * time_step / keys_.ramp_time : 0.0;
  return std::min(1.0, ramp_share(steps, time_step, keys_.ramp_time) + ahead);
}

bool Load::advance(Simulation& simulation, int most_steps) {
  if (kept_.steps % kStepsPerForce == 0) adjust_force(simulation);
  const auto steps = std::min<std::int64_t>(kStepsPerForce - kept_.steps % kStepsPerForce, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.steps += steps;
  return kept_.steps % kLoadStepsPerLook == 0;
}

void Load::look(const Simulation& simulation) {
  strain_seen_ = simulation.press().specimen_strain();
  ratio_seen_ = simulation.motion().totals().unbalanced_ratio();
}

Verdict Load::judge(Simulation& simulation) {
  if (strain_seen_ - kept_.first_strain > keys_.failure_strain)
    return {.over = true, .last = true, .outcome = Outcome::crushed};
  const Motion& motion = simulation.motion();
  // The ramp may end before the force is adjusted to all of it.
  if (share_held_from(kept_.steps - kStepsPerForce, motion.time_step()) < 1.0) return {};
  if (ratio_seen_ < keys_.unbalanced_ratio) return {.over = true};
  const double after_ramp = static_cast<double>(kept_.steps) - keys_.ramp_time / motion.time_step();
  if (after_ramp >= static_cast<double>(keys_.most_steps))
    return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

double Load::progress(const Simulation& simulation) const {
  return ramp_share(kept_.steps, simulation.motion().time_step(), keys_.ramp_time);
}

StageReport Load::report(const History& history, RowRange rows, Outcome outcome) const {
  StageReport report;
  report.results = {
      {known::load_stress, keys_.stress * 1e-6},
      {known::load_level, keys_.level ? Result::Value(*keys_.level) : Result::Value()},
      {known::strength_of_level, keys_.level ? Result::Value(keys_.strength * 1e-6) : Result::Value()},
      {known::strength_of_level_is, keys_.level ? Result::Value(keys_.strength_of) : Result::Value()}};
  if (keys_.level)
    report.lines.push_back(fmt::format("load {:.2f} MPa: {:g} of f_c {:.2f} MPa, {}", keys_.stress * 1e-6,
                                       *keys_.level, keys_.strength * 1e-6, keys_.strength_of));
  const auto stress = history.values("stress_MPa", rows);
  const double borne = stress.empty() ? 0.0 : *std::ranges::max_element(stress);
  report.results.push_back({known::largest_stress, value_if(!rows.empty(), borne)});
  report.results.push_back({known::steps, kept_.steps});
  report.results.push_back({known::strain, last_value(history, "strain", rows)});
  if (outcome == Outcome::crushed) {
    report.lines.push_back(
        fmt::format("crushed: the specimen bore {:.2f} MPa at most of the {:.2f} MPa of the load", borne,
                    keys_.stress * 1e-6));
    report.warnings.push_back(report.lines.back());
  }
  return report;
}

Forecast Load::forecast(const Simulation& simulation, Foreseen&) const {
  const double ramp = keys_.ramp_time / simulation.motion().time_step();
  // along a slow ramp the body is near its rest already
  const double rest =
      std::min(std::max(steps_to_rest(keys_.unbalanced_ratio) - ramp, 1.0 * kLoadStepsPerLook),
               static_cast<double>(keys_.most_steps));
  return {.steps = ramp + rest, .looks = (ramp + rest) / kLoadStepsPerLook, .frames = 1.0};
}

void Load::visit_state(StateVisitor& visitor) {
  auto& [steps, first_stress, first_strain] =
      kept_;  // another member does not compile until it has a name here
  visitor.visit("steps", steps, state::count());
  visitor.visit("first_stress", first_stress);
  visitor.visit("first_strain", first_strain);
}

}  // namespace pyroclast
