#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "messages.hpp"
#include "stages/drives.hpp"

/// What a drive asks for at any moment: loads over loads along their ramps, conditions at their bounds,
/// looks, work and states.
namespace pyroclast::drive_loads_test {
namespace {

const std::string kCorner =
    "[[sets]]\nname = \"corner\"\nwithin = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n";
const std::string kRecords =
    record("stress", "stress", "set = \"specimen\"\ndirection = \"x\"") +
    record("grip", "force", "set = \"left\"\ndirection = \"x\"") +
    record("end", "displacement", "set = \"right\"\ndirection = \"x\"") +
    record("stretch", "opening", "set = \"left\"\nother = \"right\"\ndirection = \"x\"");
const std::string kBoth = does("left", "hold = [\"x\", \"y\"]");
const std::string kHeld = does("left", "hold = [\"x\"]") + does("corner", "hold = [\"y\"]");

std::string body(const std::string& stages) {
  return free_deck(kUniform + kCorner + kRecords + stages);
}

struct Look {
  double time;  ///< of the stage, s
  SetLoad top, right;
};

/// Loads of two sets at the looks of a stage: they are those of the middle of the 20 steps before, and at the
/// end of the stage those of its end.
std::vector<Look> loads_of(Trial& trial, int stage) {
  const double step = trial.simulation->motion().time_step();
  std::vector<Look> looks;
  double begin = 0.0;
  while (trial.run.next()) {
    const double now = trial.run.history().last("step").value();
    if (trial.run.stage_number() < stage) begin = now;
    if (trial.run.stage_number() != stage || now == begin) continue;
    const double behind = trial.run.stage_is_under_way() ? 10.0 : 0.0;
    looks.push_back({(now - begin - behind) * step, trial.simulation->loads().on("top"),
                     trial.simulation->loads().on("right")});
  }
  return looks;
}

void expect_force(const SetLoad& load, double x, double y) {
  EXPECT_NEAR(load.force[0], x, 1e-4);
  EXPECT_NEAR(load.force[1], y, 1e-4);
}

// Promise: what is stated comes along its ramp, what was there goes along the longest of them, along the
// directions that are stated; what is across them stays.
TEST(DriveLoads, GoOverIntoEachOther) {
  const std::string before = drive(
      "duration = \"2 ms\"\nlook_interval = \"2 ms\"",
      kBoth + does("right", "force = \"10 kN\"\ndirection = [3, 4]") + does("top", "pressure = \"2 MPa\""));
  const auto ramped = [](const std::string& set, const std::string& what, int ramp) {
    return does(set, what + fmt::format("\nramp_time = \"{} ms\"", ramp));
  };
  const std::string down = "force = \"5 kN\"\ndirection = [0, -2]", push = "pressure = \"-1 MPa\"",
                    less = "pressure = \"0.5 MPa\"";
  for (const bool long_first : {false, true}) {
    const std::string pushes = long_first ? ramped("top", less, 16) + ramped("top", push, 8)
                                          : ramped("top", push, 8) + ramped("top", less, 16);
    Trial trial(body(before + drive("duration = \"24 ms\"\nlook_interval = \"1 ms\"",
                                    ramped("right", down, 12) + pushes)));
    const auto looks = loads_of(trial, 1);
    ASSERT_EQ(looks.size(), 24u);
    for (const Look& look : looks) {
      const auto share = [&](double ramp) { return std::min(1.0, look.time / ramp); };
      expect_force(look.right, 6e3, 8e3 * (1.0 - share(12e-3)) - 5e3 * share(12e-3));
      EXPECT_EQ(look.right.pressure, 0.0);
      EXPECT_NEAR(look.top.pressure, 2e6 * (1.0 - share(16e-3)) - 1e6 * share(8e-3) + 0.5e6 * share(16e-3),
                  1e-3)
          << long_first << " " << look.time;
      expect_force(look.top, 0.0, 0.0);
    }
  }
}

// Promise: two directions that are not parallel take the place of all that was there, whatever their angle.
TEST(DriveLoads, TwoDirectionsTakeThePlaceOfAll) {
  const auto left = [](const std::string& one, const std::string& other) {
    Trial trial(
        body(drive("duration = \"1 ms\"", kBoth + does("right", "force = \"10 kN\"\ndirection = [3, 4]")) +
             drive("duration = \"2 ms\"\nlook_interval = \"1 ms\"",
                   does("right", "force = \"2 kN\"\ndirection = " + one) +
                       does("right", "force = \"3 kN\"\ndirection = " + other))));
    return loads_of(trial, 1).back().right;
  };
  const double aslant = 3e3 / std::sqrt(2.0);
  expect_force(left("[0, -1]", "[1, -1]"), aslant, -2e3 - aslant);
  expect_force(left("[0, -1]", "[0, 1]"), 6e3, 1e3);
  // parallel to within a thousand millionth
  expect_force(left("[0, 1]", "[0.97e-9, 1]"), 6e3, 5e3);
  expect_force(left("[0, 1]", "[1.03e-9, 1]"), 0.0, 5e3);
}

// Promise: a factor over time counts from the beginning of the stage, and ends at its end.
TEST(DriveLoads, AFactorFollowsItsTable) {
  Trial trial(
      body(drive("duration = \"10 ms\"\nlook_interval = \"1 ms\"",
                 kBoth + does("right",
                              "force = \"8 kN\"\ndirection = [1, 0]\nfactor = { table = [[\"0 s\", 1], "
                              "[\"5 ms\", -1], [\"10 ms\", 0.5]] }"))));
  for (const Look& look : loads_of(trial, 0)) {
    const double ms = 1e3 * look.time, factor = ms < 5.0 ? 1.0 - 0.4 * ms : -1.0 + 0.3 * (ms - 5.0);
    expect_force(look.right, 8e3 * factor, 0.0);
  }
}

// Promise: what was there before a stage, a pressure that follows the body too, is part of its state.
TEST(DriveLoads, WhatWasThereBeforeIsKeptInAState) {
  const std::string text =
      body(drive("duration = \"1 ms\"", kHeld + does("top", "pressure = \"2 MPa\"\nfollower = true") +
                                            does("right", "force = \"10 kN\"\ndirection = [3, 4]")) +
           drive("duration = \"10 ms\"\nlook_interval = \"1 ms\"",
                 does("top", "force = \"4 kN\"\ndirection = [0, -1]\nramp_time = \"8 ms\"") +
                     does("right", "pressure = \"1 MPa\"\nramp_time = \"8 ms\"")));
  Trial whole(text), first(text), second(text);
  const auto expected = loads_of(whole, 1);
  while (first.run.stage_number() < 1 || first.run.progress() < 0.3) first.run.next();
  copy_state(first.run, second.run);
  const auto told = loads_of(second, 1);
  ASSERT_GE(told.size(), 5u);
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Look& other = expected[expected.size() - told.size() + i];
    EXPECT_EQ(told[i].top.pressure, 2e6);
    EXPECT_TRUE(told[i].top.is_follower);
    EXPECT_FALSE(told[i].right.is_follower);
    expect_force(told[i].top, other.top.force[0], other.top.force[1]);
    expect_force(told[i].right, 6e3, 8e3);
    EXPECT_EQ(told[i].right.pressure, other.right.pressure);
  }
}

// ---- When a stage ends -----------------------------------------------------------------------------------

// Promise: rest counts once all of a ramp acts, and no sooner: what acts is that of the middle of 20 steps.
TEST(DriveEnds, RestCountsOnceAllOfARampActs) {
  const double step = Trial(body(drive("duration = \"1 ms\"", kBoth))).simulation->motion().time_step();
  for (const auto& [ramp, steps] : {std::pair{109.9, 120.0}, {110.1, 140.0}, {89.9, 100.0}, {0.0, 20.0}}) {
    const Finished r(body(drive(
        "duration = \"0.1 s\"\nlook_interval = \"1 us\"\nunbalanced_ratio = 1e9",
        kBoth + does("right", fmt::format("pressure = \"1 Pa\"\nramp_time = \"{:.9g} s\"", ramp * step)))));
    EXPECT_EQ(r.run.outcome(), Outcome::completed);
    EXPECT_EQ(r.result(0, "steps"), steps) << ramp;
  }
}

// Promise: above is more, and below is less: a record that stands at just the bound meets neither.
TEST(DriveEnds, AConditionIsMetBeyondItsBound) {
  const auto outcome = [](const std::string& until) {
    return Finished(body(drive("duration = \"1 ms\"\nlook_interval = \"0.2 ms\"",
                               kBoth + does("right", "hold = [\"x\"]") +
                                   "[[stages.until]]\nrecord = \"end\"\n" + until + "\n")))
        .run.outcome();
  };
  EXPECT_EQ(outcome("above = \"0 mm\""), Outcome::not_reached);
  EXPECT_EQ(outcome("below = \"0 mm\""), Outcome::not_reached);
  EXPECT_EQ(outcome("above = \"-1e-12 mm\""), Outcome::completed);
  EXPECT_EQ(outcome("below = \"1e-12 mm\""), Outcome::completed);
}

// Promise: a body that is driven to the left fails as one that is driven to the right does.
TEST(DriveEnds, APeakIsFoundInEitherDirection) {
  const auto pulled = [](const std::string& held, const std::string& moved, const char* velocity) {
    return Finished(body(drive(
        "duration = \"40 ms\"\nlook_interval = \"0.2 ms\"",
        does(held, "hold = [\"x\", \"y\"]") +
            does(moved, fmt::format("velocity = \"{}\"\ndirection = \"x\"\nramp_time = \"1 ms\"", velocity)) +
            "[[stages.until]]\nrecord = \"stress\"\nshare_of_peak = 0.9\n")));
  };
  const Finished right = pulled("left", "right", "2 mm/s"), left = pulled("right", "left", "-2 mm/s");
  EXPECT_EQ(left.run.outcome(), Outcome::completed);
  const double peak = right.result(0, "peak_stress_MPa").value();
  EXPECT_GT(peak, 2.0);
  EXPECT_NEAR(left.result(0, "peak_stress_MPa").value(), peak, 0.1 * peak);
  EXPECT_NEAR(left.result(0, "peak_stress_time_s").value(), right.result(0, "peak_stress_time_s").value(),
              2e-3);
  EXPECT_NEAR(left.end_of(0, "stretch_m"), right.end_of(0, "stretch_m"), 5e-6);
}

// ---- Looks, work and figures -----------------------------------------------------------------------------

// Promise: rows come every 20 steps at the most, a stage is no more than over, and without a force there is
// no frame for its peak.
TEST(DriveLooks, ComeEveryTwentySteps) {
  Trial trial(
      body(drive("duration = \"1.11 ms\"\nlook_interval = \"1 us\"\nframe_interval = \"0.5 ms\"", kBoth)));
  double last = -1.0;
  while (trial.run.next()) {
    const double now = trial.run.history().last("step").value();
    if (last >= 0.0 && !trial.run.stage_is_over()) {
      EXPECT_EQ(now - last, 20.0);
    }
    last = now;
    EXPECT_LE(trial.run.progress(), 1.0);
  }
  EXPECT_EQ(trial.run.progress(), 1.0);
}

// Promise: each stage tells the work of its own loads; together they are the ledger's.
TEST(DriveLooks, EachStageTellsItsOwnWork) {
  const auto pulls = [](const char* size) {
    return does("right", fmt::format("force = \"{}\"\ndirection = [1, 0]\nramp_time = \"5 ms\"", size));
  };
  const std::string timed = "duration = \"40 ms\"";
  const Finished r(body(drive(timed, kHeld + pulls("60 kN")) + drive(timed, pulls("90 kN"))));
  const double first = r.result(0, "loading_work_J").value(), second = r.result(1, "loading_work_J").value();
  EXPECT_NEAR(first, r.end_of(0, "energy_loading_J"), 1e-12);
  EXPECT_NEAR(first + second, r.last("energy_loading_J"), 1e-12);
  // of a spring: from 0 to 2, and from 2 to 3
  EXPECT_NEAR(second / first, 5.0 / 4.0, 0.1);
}

// Promise: formulas know the thickness and the weight of the body.
TEST(DriveLooks, FormulasKnowTheBody) {
  const auto result = [](const char* name) {
    return fmt::format("[[stages.results]]\nname = \"{0}_then\"\nkind = \"formula\"\nformula = \"{0}\"\n",
                       name);
  };
  const std::string text =
      with(body(drive("duration = \"0.2 ms\"", kBoth + result("thickness") + result("weight"))), "\"0 m/s2\"",
           "\"10 m/s2\"");
  const Finished r(text);
  EXPECT_EQ(r.result(0, "thickness_then"), 1.0);
  EXPECT_NEAR(r.result(0, "weight_then").value(), 10.0 * 2200.0 * kWidth * kHeight, 1e-6);
}

// ---- An opening that is controlled -----------------------------------------------------------------------

const std::string kMiddle =
    "[[sets]]\nname = \"one\"\nbox = [[\"10 mm\", \"0 mm\"], [\"20 mm\", \"120 mm\"]]\n"
    "[[sets]]\nname = \"other\"\nbox = [[\"40 mm\", \"0 mm\"], [\"50 mm\", \"120 mm\"]]\n" +
    record("middle", "opening", "set = \"one\"\nother = \"other\"\ndirection = \"x\"");

std::string controlled(const std::string& rate, const std::string& drives,
                       const std::string& duration = "30 ms") {
  return drive("duration = \"" + duration +
                   "\"\nlook_interval = \"1 ms\"\n[stages.control]\nrecord = \"middle\"\n" + "rate = \"" +
                   rate + "\"\nstiffness = \"2 GN/m\"\nresponse_time = \"2 ms\"",
               drives);
}

double number(const Finished& r, int stage, const char* name) {
  return r.result(stage, name).value();
}

// Promise: control goes on from the opening and the loads that are there; when it ends no pair is left.
TEST(DriveControl, GoesOnFromWhatIsThere) {
  const std::string pull = "force = \"60 kN\"\ndirection = [1, 0]";
  const Finished r(
      body(kMiddle + drive("duration = \"60 ms\"", kHeld + does("right", pull + "\nramp_time = \"20 ms\"")) +
           controlled("0 mm/s", does("right", pull))));
  const double before = r.end_of(0, "middle_m");
  ASSERT_GT(before, 3e-7);
  for (const double opening : r.run.history().values("middle_m", r.run.courses()[1].rows))
    EXPECT_NEAR(opening, before, 0.02 * before);
  EXPECT_NEAR(r.end_of(1, "grip_N"), -60e3, 2e3);
  EXPECT_LT(std::abs(r.end_of(1, "load_factor")), 0.05);
  EXPECT_NEAR(number(r, 1, "largest_load_with_control_N"), 60e3, 2e3);
  for (const char* set : {"one", "other"}) expect_force(r.simulation->loads().on(set), 0.0, 0.0);
}

// Promise: the amounts of the forces are shares: by whatever unit they are stated, they come to the same
// load.
TEST(DriveControl, AmountsAreShares) {
  const auto at = [](const char* size) {
    return Finished(
        body(kMiddle + controlled("0.1 mm/s", kHeld + does("right", fmt::format("force = \"{}\"\n"
                                                                                "direction = [1, 0]",
                                                                                size)))));
  };
  const Finished newton = at("1 N"), kilonewton = at("100 kN");
  const double load = number(kilonewton, 0, "largest_load_factor") * 100e3;
  EXPECT_GT(load, 1e3);
  EXPECT_NEAR(number(newton, 0, "largest_load_factor"), load, 1e-4 * load);
  EXPECT_NEAR(number(newton, 0, "largest_load_with_control_N"),
              number(kilonewton, 0, "largest_load_with_control_N"), 1e-4 * load);
}

// Promise: sets that are pulled apart bear a load once; sets that are pulled the same way bear it together.
TEST(DriveControl, SetsThatArePulledApartBearTheLoadOnce) {
  const std::string right = does("right", "force = \"3 kN\"\ndirection = [1, 0]");
  const Finished apart(
      body(kMiddle + controlled("0.1 mm/s", kHeld + does("other", "force = \"3 kN\"\ndirection = [1, 0]") +
                                                does("one", "force = \"3 kN\"\ndirection = [-1, 0]"))));
  const double factor = number(apart, 0, "largest_load_factor");
  EXPECT_GT(factor, 0.1);
  const double peak = factor * 3e3;
  EXPECT_NEAR(number(apart, 0, "control_error_of_largest_load"),
              number(apart, 0, "largest_load_with_control_N") / peak - 1.0, 1e-9);
  const Finished together(body(
      kMiddle + controlled("0.1 mm/s", kHeld + right + does("right", "force = \"2 kN\"\ndirection = [1, 0]") +
                                           does("other", "force = \"1 kN\"\ndirection = [2, 0]"))));
  EXPECT_NEAR(number(together, 0, "control_error_of_largest_load"),
              number(together, 0, "largest_load_with_control_N") /
                      (6e3 * number(together, 0, "largest_load_factor")) -
                  1.0,
              1e-9);
}

// Promise: what a controlled stage reports does not depend on whether it was broken off.
TEST(DriveControl, AStateHoldsWhatIsReported) {
  const std::string text = body(
      kMiddle + controlled("1 mm/s", kHeld + does("right", "force = \"60 kN\"\ndirection = [1, 0]") +
                                         "[[stages.until]]\nrecord = \"grip\"\nshare_of_peak = 0.3\n" +
                                         "[[stages.until]]\nrecord = \"middle\"\nrate_above = \"1 m/s\"\n"));
  const auto told = [](Trial& trial) {
    trial.run.run();
    const StageCourse& record = trial.run.courses()[0];
    StageReport report = trial.run.stages()[0]->report(trial.run.history(), record.rows, record.outcome);
    return std::pair(report.results, report.lines);
  };
  Trial whole(text);
  const auto [results, lines] = told(whole);
  const std::size_t looks = whole.run.history().row_count();
  for (const std::size_t stop : {std::size_t{2}, looks / 3, looks / 2, looks - 2}) {
    Trial first(text), second(text);
    while (first.run.history().row_count() < stop) first.run.next();
    copy_state(first.run, second.run);
    const auto [others, other_lines] = told(second);
    ASSERT_EQ(others.size(), results.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      EXPECT_EQ(others[i].name, results[i].name);
      EXPECT_EQ(others[i].value, results[i].value) << results[i].name << ", stopped at " << stop;
    }
    EXPECT_EQ(other_lines, lines);
  }
}

}  // namespace
}  // namespace pyroclast::drive_loads_test
