#include "pyroclast/stages/settle.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/known_results.hpp"

namespace pyroclast {

namespace {

/// Steps between two looks at settling, whose end needs no finer stone.
constexpr std::int64_t kSettleStepsPerLook = 200;
/// Steps in which the unbalanced ratio falls to a tenth: specimens of 100 to 3,000 blocks with a combined
/// damping of 0.8 come to 1e-4 in 3,400 to 5,400 steps, without a trend.
constexpr double kStepsPerDecade = 1100.0;

std::unique_ptr<Stage> read_settle(const Section& s, const StageTables&) {
  Settle::Keys keys;
  keys.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive().usually(1e-8, 0.01), kAtRest);
  keys.most_steps = s.integer("most_steps", Range::between(1, 1e12),
                              "after so many steps without rest the run ends, and says so");
  return std::make_unique<Settle>(keys);
}

}  // namespace

StageKind settle_kind() {
  return {
      "settle",
      "lets the body come to rest under its weight, with the upper platen on top; strains, displacements and "
      "openings count from there",
      {},
      read_settle};
}

void Settle::begin(Simulation& simulation) {
  if (simulation.has_press()) simulation.press().let_go();
}

bool Settle::advance(Simulation& simulation, int most_steps) {
  if (kept_.steps_to_look == 0)
    kept_.steps_to_look = std::clamp<std::int64_t>(keys_.most_steps - kept_.steps, 1, kSettleStepsPerLook);
  const auto steps = std::min<std::int64_t>(kept_.steps_to_look, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.steps += steps;
  kept_.steps_to_look -= steps;
  return kept_.steps_to_look == 0;
}

void Settle::look(const Simulation& simulation) {
  ratio_seen_ = simulation.motion().totals().unbalanced_ratio();
}

Verdict Settle::judge(Simulation& simulation) {
  if (ratio_seen_ < keys_.unbalanced_ratio) {
    simulation.set_zero();
    return {.over = true};
  }
  if (kept_.steps >= keys_.most_steps) return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

StageReport Settle::report(const History& history, RowRange rows, Outcome) const {
  StageReport report;
  report.results = {{known::steps, kept_.steps},
                    {known::unbalanced_ratio, last_value(history, "unbalanced_ratio", rows)}};
  return report;
}

Forecast Settle::forecast(const Simulation&, Foreseen&) const {
  const double steps = std::min(steps_to_rest(keys_.unbalanced_ratio), static_cast<double>(keys_.most_steps));
  return {.steps = steps, .looks = steps / kSettleStepsPerLook, .frames = 1.0};
}

void Settle::visit_state(StateVisitor& visitor) {
  auto& [steps, steps_to_look] = kept_;  // another member does not compile until it has a name here
  visitor.visit("steps", steps, state::count());
  visitor.visit("steps_to_look", steps_to_look, state::within(0, kSettleStepsPerLook));
}

double steps_to_rest(double unbalanced_ratio) {
  return kStepsPerDecade * std::max(1.0, -std::log10(unbalanced_ratio));
}

}  // namespace pyroclast
