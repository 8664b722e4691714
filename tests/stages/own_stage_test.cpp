#include <algorithm>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"
#include "stages/small_runs.hpp"

/// A stage that the library does not have, as a user would write it.
namespace pyroclast {
namespace {

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
    simulation.mechanics().advance(static_cast<int>(steps));
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

StageKind shake_kind() {
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

StageRegistry with_shake() {
  StageRegistry kinds;
  kinds.add(shake_kind());
  return kinds;
}

const std::string kShake =
    "[[stages]]\nkind = \"shake\"\nvelocity = \"1 mm/s\"\nhalf_period = 100\nturns = 4\n";

TEST(OwnStage, IsReadFromADeckAndRun) {
  Trial trial(deck(kUniform + kSettle + kShake + kCompress), with_shake());
  EXPECT_EQ(trial.run.run(), Outcome::completed);
  const History& history = trial.run.history();
  const StageCourse& record = trial.run.courses()[1];
  EXPECT_EQ(history.values("turn", record.rows), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_FALSE(history.last("turn"));  // the compression has none
  const auto strain = history.values("stage_strain", record.rows);
  EXPECT_GT(strain[0], strain[1]);
  EXPECT_LT(strain[1], strain[2]);
  const StageReport report = trial.run.stages()[1]->report(history, record.rows, record.outcome);
  EXPECT_GT(std::get<double>(report.results.at(0).value), 0.0);
}

TEST(OwnStage, ErrorsInItsTableAreToldLikeAnyOther) {
  const auto message = [](const std::string& text, const StageRegistry& kinds) -> std::string {
    try {
      read(text, kinds);
    } catch (const DeckError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message(deck(kUniform + with(kShake, "1 mm/s", "1 mm")), with_shake()).find("stages[0].velocity"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kShake + "colour = 1\n"), with_shake()).find("colour"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kShake), {}).find("shake"), std::string::npos);
}

TEST(OwnStage, ItsNameMustBeFree) {
  StageRegistry kinds = with_shake();
  EXPECT_THROW(kinds.add(shake_kind()), Error);
}

}  // namespace
}  // namespace pyroclast
