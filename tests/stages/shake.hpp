#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "stages/small_runs.hpp"

/// A stage that the library does not have, as a user would write it.
namespace pyroclast {

/// Moves the upper platen up and down about its place.
class Shake : public Stage {
 public:
  Shake(double velocity, std::int64_t half_period, std::int64_t turns)
      : velocity_(velocity), half_period_(half_period), turns_(turns) {}

  const char* kind() const override { return "shake"; }
  StageNeeds needs() const override { return {}; }
  void begin(Simulation& simulation) override { simulation.press().control_by_motion(0.0); }
  bool advance(Simulation& simulation, int most_steps) override {
    if (steps_ % half_period_ == 0) simulation.press().move_platen(turn() % 2 == 0 ? velocity_ : -velocity_);
    const auto steps = std::min<std::int64_t>(half_period_ - steps_ % half_period_, most_steps);
    simulation.motion().advance(static_cast<int>(steps));
    steps_ += steps;
    return steps_ % half_period_ == 0;
  }
  Verdict judge(Simulation&) override { return {.over = turn() == turns_}; }
  double progress(const Simulation&) const override { return static_cast<double>(turn()) / turns_; }
  std::vector<Column> columns() const override { return {{"turn", "1"}}; }
  std::vector<double> values() const override { return {static_cast<double>(turn())}; }
  StageReport report(const History& history, RowRange rows, Outcome) const override {
    const auto stress = history.values("stress_MPa", rows);
    return {
        .results = {{"largest_stress_MPa", *std::ranges::max_element(stress)}}, .lines = {}, .warnings = {}};
  }
  Forecast forecast(const Simulation&, Foreseen&) const override {
    return {.steps = static_cast<double>(half_period_ * turns_), .looks = static_cast<double>(turns_)};
  }
  void visit_state(StateVisitor& visitor) override { visitor.visit("steps", steps_, state::count()); }

 private:
  std::int64_t turn() const { return steps_ / half_period_; }

  double velocity_;  // m/s
  std::int64_t half_period_, turns_;
  std::int64_t steps_ = 0;
};

inline StageKind shake_kind() {
  return {"shake",
          "drives the platen up and down",
          {},
          [](const Section& s, const StageTables&) -> std::unique_ptr<Stage> {
            const double velocity =
                s.quantity("velocity", unit::velocity, Range::positive(), "of the platen");
            const auto half_period = s.integer("half_period", Range::at_least(1), "steps between two turns");
            const auto turns = s.integer("turns", Range::at_least(1), "before the stage ends");
            return std::make_unique<Shake>(velocity, half_period, turns);
          }};
}

inline StageRegistry with_shake() {
  StageRegistry kinds;
  kinds.add(shake_kind());
  return kinds;
}

inline const std::string kShake =
    "[[stages]]\nkind = \"shake\"\nvelocity = \"1 mm/s\"\nhalf_period = 100\nturns = 4\n";

}  // namespace pyroclast
