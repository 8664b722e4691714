#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <pyroclast/simulation/simulation.hpp>
#include <pyroclast/stages/registry.hpp>

/// A stage that the library does not have: the upper platen goes up and down about its place. Stages know no
/// dimension, so it serves bodies in the plane and in space.
namespace mine {

using namespace pyroclast;

inline constexpr ResultInfo kLargestStress{"largest_stress_MPa", "MPa", "largest stress",
                                           "largest stress between the platens at a turn"};

class Shake : public Stage {
 public:
  Shake(double velocity, std::int64_t half_period, std::int64_t turns)
      : velocity_(velocity), half_period_(half_period), turns_(turns) {}

  const char* kind() const override { return "shake"; }
  StageNeeds needs() const override { return {.press = true}; }
  void begin(Simulation& simulation) override { simulation.press().control_by_motion(0.0); }
  /// Takes at most so many steps, and returns true where a row of the history is due: at each turn.
  bool advance(Simulation& simulation, int most_steps) override {
    if (steps_ % half_period_ == 0) simulation.press().move_platen(turn() % 2 == 0 ? velocity_ : -velocity_);
    const auto steps = std::min<std::int64_t>(half_period_ - steps_ % half_period_, most_steps);
    simulation.motion().advance(static_cast<int>(steps));
    steps_ += steps;
    return steps_ % half_period_ == 0;
  }
  Verdict judge(Simulation&) override { return {.over = turn() == turns_}; }
  double progress(const Simulation&) const override { return static_cast<double>(turn()) / turns_; }
  /// Columns of history.csv beside those that every stage has.
  std::vector<Column> columns() const override { return {{"turn", "1", "turns of the platen so far"}}; }
  std::vector<double> values() const override { return {static_cast<double>(turn())}; }
  /// Results of summary.json, and lines for the screen.
  StageReport report(const History& history, RowRange rows, Outcome) const override {
    StageReport report{.results = {{kLargestStress, std::monostate()}}, .lines = {}, .warnings = {}};
    if (rows.empty()) return report;
    const auto stress = history.values("stress_MPa", rows);
    report.results[0].value = *std::ranges::max_element(stress);
    return report;
  }
  /// What `check` foretells of its cost.
  Forecast forecast(const Simulation&, Foreseen&) const override {
    return {.steps = static_cast<double>(half_period_ * turns_), .looks = static_cast<double>(turns_)};
  }
  /// Shows every number that the stage keeps from one batch to the next, for checkpoints.
  void visit_state(StateVisitor& visitor) override { visitor.visit("steps", steps_, state::count()); }

 private:
  std::int64_t turn() const { return steps_ / half_period_; }

  double velocity_;  // m/s
  std::int64_t half_period_, turns_;
  std::int64_t steps_ = 0;
};

/// Returns the name, the meaning, the needs and the reader of the stage's keys.
inline StageKind shake_kind() {
  return {"shake",
          "drives the platen up and down",
          {.press = true},
          [](const Section& s, const StageTables&) -> std::unique_ptr<Stage> {
            const double velocity =
                s.quantity("velocity", unit::velocity, Range::positive(), "of the platen");
            const auto half_period = s.integer("half_period", Range::at_least(1), "steps between two turns");
            const auto turns = s.integer("turns", Range::at_least(1), "before the stage ends");
            return std::make_unique<Shake>(velocity, half_period, turns);
          }};
}

/// Returns the library's kinds of stages, and this one.
inline StageRegistry with_shake() {
  StageRegistry kinds;
  kinds.add(shake_kind());
  return kinds;
}

}  // namespace mine
