#include "pyroclast/stages/conduct.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "heated_specimen.hpp"
#include "known.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "pyroclast/thermal/fire_curves.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Heat alone in a small specimen.
struct Conducted {
  Conducted(const HeatConditions& heat, const Conduct::Keys& keys, int blocks = 100)
      : simulation(small_specimen(blocks), kSpecimenThickness, alike_phases(), {}, heat, {}, {}, std::nullopt,
                   std::make_shared<Team>()),
        run(simulation, stages_of(keys)) {}

  /// To the end, or until a temperature has come so far, °C.
  void go_on(double enough = kInfinity) {
    run.stop_when([this, enough] { return simulation.field().maximum() >= enough; });
    while (run.next()) {
      looks.push_back(*run.history().last("heating_time_s"));
      if (run.frame_is_due()) frames.push_back(looks.back());
    }
  }

  static std::vector<std::unique_ptr<Stage>> stages_of(const Conduct::Keys& keys) {
    std::vector<std::unique_ptr<Stage>> stages;
    stages.push_back(std::make_unique<Conduct>(keys));
    return stages;
  }

  Simulation simulation;
  Run run;
  std::vector<double> looks, frames;
};

TEST(Conduct, LooksAtTheStartAtEvenTimesAndAtTheEnd) {
  Conducted c(fire_from_the_left(), {.duration = 250.0, .interval = 100.0});
  c.go_on();
  EXPECT_EQ(c.run.outcome(), Outcome::completed);
  EXPECT_EQ(c.looks, (std::vector<double>{0.0, 100.0, 200.0, 250.0}));
}

TEST(Conduct, KeepsFramesAtTheStartAtTheirOwnTimesAndAtTheEnd) {
  Conducted c(fire_from_the_left(), {.duration = 250.0, .interval = 100.0, .frame_interval = 90.0});
  c.go_on();
  EXPECT_EQ(c.frames, (std::vector<double>{0.0, 90.0, 180.0, 250.0}));
  EXPECT_EQ(c.looks, (std::vector<double>{0.0, 90.0, 100.0, 180.0, 200.0, 250.0}));  // one at each frame
}

// Promise: multiples of an interval that rounding moves by its last bits are neither missed nor looked at
// twice.
TEST(Conduct, LooksOnceAtEachWholeMultiple) {
  for (const double interval : {0.1, 0.2, 0.3, 0.7, 1.1}) {
    Conducted c(fire_from_the_left(),
                {.duration = 30.0 * interval, .interval = interval, .frame_interval = 3.0 * interval}, 30);
    c.go_on();
    EXPECT_EQ(c.looks.size(), 31U) << interval;
    EXPECT_EQ(c.frames.size(), 11U) << interval;
  }
}

// Promise: a body cools in air below 20 degC, where its enthalpy counts from; no temperature leaves those of
// the air and of the start.
TEST(Conduct, ABodyCoolsBelowTheReferenceTemperature) {
  for (const auto& [start, air] : {std::pair{20.0, 10.0}, {20.0, 5.0}, {0.0, -20.0}, {20.05, 20.0}}) {
    HeatConditions heat = heat_conditions({on("left", convection(25.0, Curve::constant(air)))});
    heat.initial = start;
    Conducted c(heat, {.duration = 600.0, .interval = 10.0}, 150);
    c.go_on();
    EXPECT_EQ(c.run.outcome(), Outcome::completed);
    EXPECT_GE(c.simulation.field().minimum(), air);
    EXPECT_LE(c.simulation.field().maximum(), start);
    EXPECT_LT(c.simulation.field().mean(), start);
  }
}

// Promise: a body without any flow is steady only for who asks for a steady state.
TEST(Conduct, WhoAsksForNoSteadyStateGetsNone) {
  HeatConditions heat = heat_conditions({on("left", convection(25.0, Curve::constant(20.0)))});
  heat.initial = 20.0;
  Conducted c(heat, {.duration = 100.0, .interval = 40.0}, 30);
  c.go_on();
  EXPECT_EQ(c.run.outcome(), Outcome::completed);
  EXPECT_EQ(c.looks, (std::vector<double>{0.0, 40.0, 80.0, 100.0}));
  Conducted steady(heat, {.duration = 100.0, .interval = 40.0, .steady_rate = 1e-9}, 30);
  steady.go_on();
  EXPECT_EQ(steady.run.outcome(), Outcome::steady);
}

TEST(Conduct, StopsAfterALookWhenAskedTo) {
  const HeatConditions heat = fire_from_the_left();
  Conducted c(heat, {.duration = 250.0, .change = 10.0});
  c.go_on(100.0);
  EXPECT_EQ(c.run.outcome(), Outcome::stopped);
  EXPECT_EQ(c.frames, (std::vector<double>{0.0}));
  EXPECT_EQ(c.looks.back(), c.simulation.field().time());
  EXPECT_GE(c.simulation.field().maximum(), 100.0);
  EXPECT_LT(c.simulation.field().maximum(), 100.0 + 10.0 + heat.largest_change);  // within one increment
}

TEST(ConductVerification, ReachesTheSteadyStateBetweenTwoFaces) {
  const Curve ramp = Curve::table({0.0, 600.0, 1e9}, {20.0, 120.0, 120.0}, time_axis());
  constexpr double tolerance = 1e-6;
  Conducted c(heat_conditions({on("left", PrescribedTemperature{ramp}),
                               on("right", PrescribedTemperature{Curve::constant(20.0)})}),
              {.duration = 1e6, .steady_rate = tolerance}, 300);
  c.go_on();
  EXPECT_EQ(c.run.outcome(), Outcome::steady);
  const TemperatureField& field = c.simulation.field();
  EXPECT_GT(field.time(), 600.0);  // the first, slow steps of the ramp are no steady state
  EXPECT_LT(field.time(), 1e5);
  double worst = 0.0;
  for (int g = 0; g < c.simulation.model().gridpoint_count(); ++g)
    worst = std::max(worst, std::abs(field.gridpoints()[g] -
                                     (120.0 - 100.0 * c.simulation.model().place(g)[0] / kSpecimenWidth)));
  // A mode that decays with the time l^2 / (pi^2 a) = 342 s is left by 342 s times the rate, and its peak is
  // sqrt(2) of its mean square.
  expect_known_field({"Steady heat between two faces of a specimen: temperatures", "linear field", "K"},
                     worst, 100.0, 2.0 * 342.0 * tolerance);
}

TEST(Conduct, SaysWhenTheSteadyStateWasNotReached) {
  Conducted c(fire_from_the_left(), {.duration = 60.0, .steady_rate = 1.0});
  c.go_on();
  EXPECT_EQ(c.run.outcome(), Outcome::completed);
  EXPECT_EQ(c.simulation.field().time(), 60.0);
  const StageCourse& record = c.run.courses()[0];
  const auto warnings = c.run.stages()[0]->report(c.run.history(), record.rows, record.outcome).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("no steady state"), std::string::npos);
}

TEST(Conduct, AloneNeedsNoMechanics) {
  Conducted c(fire_from_the_left(), {.duration = 60.0});
  c.go_on();
  EXPECT_FALSE(c.simulation.moves());
  EXPECT_FALSE(c.run.history().has("step"));
  EXPECT_TRUE(c.run.history().has("heat_stored_J"));
}

// Promise: among other stages it moves heat only, and the next exchange hands its temperatures over.
TEST(Conduct, AmongOtherStagesItLeavesTheBodyAtRest) {
  const std::string conduct = "[[stages]]\nkind = \"conduct\"\nduration = \"5 min\"\ninterval = \"1 min\"\n";
  const std::string expose = with(kExpose, "6 min", "1 min"),
                    face = with(with(kHeatedFace, "70 degC", "30 degC"), "field = \"conduction\"\n",
                                "field = \"conduction\"\nlargest_change = \"0.1 K\"\n");
  // so strong that nothing cracks: then a state does not depend on the way to it
  const auto patient = [](std::string text) {
    for (const auto& [from, to] : {std::pair{"f_t = \"2.5 MPa\"", "f_t = \"25 MPa\""},
                                   std::pair{"c_o = \"3.8 MPa\"", "c_o = \"38 MPa\""},
                                   std::pair{"least_cycles = 50", "least_cycles = 20000"},
                                   std::pair{"most_cycles = 5000", "most_cycles = 20000"}})
      text = with(text, from, to);
    return text;
  };
  const Finished r(patient(with(deck(kSettle + conduct + expose + face), "frame_strain = 1e-3",
                                "frame_strain = 1e-3\nframe_interval = \"2 min\"")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const History& history = r.run.history();
  const RowRange settled = r.run.courses()[0].rows, conducted = r.run.courses()[1].rows,
                 exposed = r.run.courses()[2].rows;
  EXPECT_EQ(history.values("heating_time_s", conducted), (std::vector<double>{60, 120, 180, 240, 300}));
  for (std::size_t row = conducted.first; row < conducted.last; ++row)
    EXPECT_FALSE(history.cell(row, "strain"));
  const double steps = history.values("step", settled).back();
  EXPECT_EQ(history.values("step", exposed).front() - steps, history.values("cycles", exposed).front());
  EXPECT_EQ(r.last("heating_time_s"), 360.0);
  EXPECT_NEAR(r.last("temperature_max_degC"), 30.0, 0.1);
  // the state of a body that was exposed all the time, but for what motion is left
  const Finished exposed_only(patient(deck(kSettle + kExpose + face)));
  EXPECT_NEAR(r.last("temperature_degC"), exposed_only.last("temperature_degC"), 0.01);
  EXPECT_NEAR(r.last("lateral_strain"), exposed_only.last("lateral_strain"), 1e-6);
  EXPECT_GT(exposed_only.last("lateral_strain"), 5e-5);
}

}  // namespace
}  // namespace pyroclast
