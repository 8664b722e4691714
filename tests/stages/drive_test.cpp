#include "pyroclast/stages/drive.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "in_plane.hpp"
#include "known.hpp"
#include "messages.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "stages/drives.hpp"

namespace pyroclast {
namespace {

/// Left side held along x, one corner along y.
const std::string kHeld = does("left", "hold = [\"x\"]") + does("corner", "hold = [\"y\"]");
const std::string kCorner =
    "[[sets]]\nname = \"corner\"\nwithin = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n";
const std::string kToRest = "duration = \"2 s\"\nunbalanced_ratio = 1e-8";

const std::string kRecords =
    record("stress", "stress", "set = \"specimen\"\ndirection = \"x\"") +
    record("across", "stress", "set = \"specimen\"\ndirection = \"y\"") +
    record("grip", "force", "set = \"left\"\ndirection = \"x\"") +
    record("end", "displacement", "set = \"right\"\ndirection = \"x\"") +
    record("stretch", "opening", "set = \"left\"\nother = \"right\"\ndirection = \"x\"");

std::string message(const std::string& text) {
  return pyroclast::message([&] { const Trial trial(text); });
}

// Whatever a body is made of, its mean stress is that of the tractions on its outline.
TEST(DriveVerification, APressureOnOneSideIsTheMeanStressAndTheReactionOfTheOther) {
  const Finished run(
      free_deck(kUniform + kCorner + kRecords +
                drive(kToRest, kHeld + does("right", "pressure = \"-1 MPa\"\nramp_time = \"5 ms\""))));
  EXPECT_EQ(run.run.outcome(), Outcome::completed);
  expect_known({"mean stress of a body of blocks under a tension of 1 MPa on one side", "equilibrium", "MPa"},
               run.last("stress_MPa"), 1.0, 1e-5);
  expect_known({"its mean stress across", "equilibrium", "MPa"}, run.last("across_MPa"), 0.0, 1e-5);
  expect_known({"the reaction of the side that is held", "equilibrium", "N"}, run.last("grip_N"),
               -1e6 * kHeight, 1e-5 * 1e6 * kHeight);
  EXPECT_NEAR(run.last("end_m"), run.last("stretch_m"), 1e-15);
  // 29.4 GPa, and contacts that give way
  EXPECT_GT(run.last("stretch_m"), 1e6 / 29.4e9 * kWidth);
  EXPECT_LT(run.last("stretch_m"), 2.0 * 1e6 / 29.4e9 * kWidth);
}

// Pulled apart along faces of random blocks: each face takes its share of G_f1, wherever the crack goes.
TEST(DriveVerification, WhatTensionDissipatesIsTheFractureEnergyOfWhatCrackedOfEachFace) {
  constexpr double kEnergy = 60.0;  // kMortarBond, J/m²
  const Finished run(free_deck(
      kUniform + kCorner + kRecords +
      drive("duration = \"0.2 s\"", kHeld +
                                        does("right",
                                             "velocity = \"0.6 mm/s\"\ndirection = \"x\"\n"
                                             "ramp_time = \"10 ms\"") +
                                        "[[stages.until]]\nrecord = \"end\"\nabove = \"60 um\"\n")));
  const Motion& motion = run.simulation->motion();
  double lost = 0.0, most = 0.0;
  for (int c = 0; c < motion.model().contact_count(); ++c) {
    const double share = motion.read().remembered(c, Remembers::tension_damage);
    lost += kEnergy * motion.model().joint(c).area * share;
    most = std::max(most, share);
  }
  EXPECT_EQ(most, 1.0);
  EXPECT_GT(lost, 0.5 * kEnergy * kHeight);
  expect_known(
      {"energy dissipated in tension by a body of random blocks", "sum of G_f1 A D_t over its contacts", "J"},
      run.last("dissipated_tension_J"), lost, 1e-9 * lost);
}

TEST(Drive, AForceOnASideIsSharedOutLikeAPressure) {
  const auto stretch = [](const std::string& how) {
    return Finished(free_deck(kUniform + kCorner + kRecords +
                              drive(kToRest, kHeld + does("right", how + "\nramp_time = \"5 ms\""))))
        .last("stretch_m");
  };
  const double of_pressure = stretch("pressure = \"-1 MPa\"");
  EXPECT_NEAR(stretch("force = \"120 kN\"\ndirection = [1, 0]"), of_pressure, 1e-8 * of_pressure);
}

TEST(Drive, WhatIsMovedGoesItsWayAndIsHeldThere) {
  const Finished run(free_deck(
      kUniform + kCorner + kRecords +
      drive("duration = \"30 ms\"",
            kHeld + does("right", "velocity = \"1 mm/s\"\ndirection = \"x\"\nramp_time = \"10 ms\"")) +
      drive("duration = \"10 ms\"", does("corner", "hold = [\"y\"]"))));
  // half of the ramp, then 20 ms
  EXPECT_NEAR(run.end_of(0, "end_m"), 1e-3 * (0.5 * 0.01 + 0.02), 1e-12);
  EXPECT_EQ(run.end_of(1, "end_m"), run.end_of(0, "end_m"));
}

// The right side moves ever faster: at 1 m/s² it has 2 mm/s after 2 ms.
TEST(Drive, ARateEndsAStage) {
  const auto time = [](const std::string& until) {
    return Finished(
               free_deck(kUniform + kCorner + kRecords +
                         drive("duration = \"10 ms\"\nlook_interval = \"0.2 ms\"",
                               kHeld + does("right", "velocity = \"10 mm/s\"\ndirection = \"x\"\n" + until))))
        .last("time_s");
  };
  const std::string faster = "factor = { table = [[\"0 s\", 0], [\"10 ms\", 1]] }\n";
  const std::string slower = "factor = { table = [[\"0 s\", 1], [\"10 ms\", 0]] }\n";
  const double begin = time(faster) - 10e-3;
  const auto at = [&](const std::string& factor, const std::string& rate) {
    return time(factor + "[[stages.until]]\nrecord = \"end\"\n" + rate + "\n") - begin;
  };
  EXPECT_NEAR(at(faster, "rate_above = \"2 mm/s\""), 2e-3, 0.4e-3);
  EXPECT_NEAR(at(slower, "rate_below = \"4 mm/s\""), 6e-3, 0.4e-3);
}

TEST(Drive, AFactorOverTimeActsOnTheAmount) {
  const Finished run(
      free_deck(kUniform + kCorner + kRecords +
                drive("duration = \"20 ms\"",
                      kHeld + does("right",
                                   "velocity = \"1 mm/s\"\ndirection = \"x\"\n"
                                   "factor = { table = [[\"0 s\", 0], [\"10 ms\", 1], [\"20 ms\", 0]] }"))));
  EXPECT_NEAR(run.last("end_m"), 1e-3 * 0.01, 1e-9);
}

TEST(Drive, LoadsStayUntilTheyAreChanged) {
  const Finished run(free_deck(
      kUniform + kCorner + kRecords +
      drive(kToRest, kHeld + does("right", "force = \"60 kN\"\ndirection = [1, 0]\nramp_time = \"5 ms\"")) +
      drive(kToRest, does("corner", "hold = [\"y\"]")) +
      drive(kToRest, does("right", "force = \"-30 kN\"\ndirection = [1, 0]\nramp_time = \"5 ms\""))));
  EXPECT_NEAR(run.end_of(0, "grip_N"), -60e3, 1.0);
  EXPECT_NEAR(run.end_of(1, "grip_N"), -60e3, 1.0);
  EXPECT_NEAR(run.end_of(2, "grip_N"), 30e3, 1.0);
}

// Promise: what a stage comes to is what acts after it, to the last part of a ramp, in stages however short.
TEST(Drive, WhatActsAfterAStageIsItsEnd) {
  const auto left = [](const std::string& keys, const std::string& load) {
    const Finished run(free_deck(kUniform + kCorner + kRecords +
                                 drive(keys, kHeld + does("right", "pressure = \"-1 MPa\"\n" + load)) +
                                 drive(kToRest, does("corner", "hold = [\"y\"]"))));
    return run.end_of(1, "grip_N");
  };
  const double whole = -1e6 * kHeight;
  EXPECT_NEAR(left("duration = \"1 ms\"", "factor = { table = [[\"0 s\", 0], [\"1 ms\", 1]] }"), whole, 1.0);
  EXPECT_NEAR(left("duration = \"1 ms\"", "ramp_time = \"1 ms\""), whole, 1.0);
  EXPECT_NEAR(left("duration = \"50 us\"", "ramp_time = \"50 us\""), whole, 1.0);
  // a stage that a condition ends before its ramp keeps what it came to: a fifth
  EXPECT_NEAR(left("duration = \"10 ms\"\nlook_interval = \"1 ms\"",
                   "ramp_time = \"10 ms\"\n[[stages.until]]\nrecord = \"grip\"\nrate_above = \"1e-9 N/s\""),
              0.1 * whole, 1.0);
}

// Promise: a stage lasts for its duration in whole steps, not for more.
TEST(Drive, LastsWholeSteps) {
  for (const auto& [duration, steps] :
       {std::pair{"1.001 ms", 101}, {"1 ms", 100}, {"0.3 us", 1}, {"70 us", 7}}) {
    const Finished run(free_deck(
        kUniform + kCorner + kRecords +
        drive(fmt::format("duration = \"{}\"", duration), kHeld + does("right", "pressure = \"1 Pa\""))));
    EXPECT_EQ(run.run.simulation().motion().steps(), steps) << duration;
  }
}

// Promise: a body that bears nothing any more, or never did, rests.
TEST(Drive, AnUnloadedBodyRests) {
  const Finished unloaded(
      free_deck(kUniform + kCorner + kRecords +
                drive(kToRest, kHeld + does("right", "pressure = \"3 MPa\"\nramp_time = \"5 ms\"")) +
                drive(kToRest, does("right", "pressure = \"0 MPa\"\nramp_time = \"5 ms\""))));
  EXPECT_EQ(unloaded.run.outcome(), Outcome::completed);
  EXPECT_NEAR(unloaded.last("grip_N"), 0.0, 1e-3);
  const Finished never(free_deck(kUniform + kCorner + kRecords + drive(kToRest, kHeld)));
  EXPECT_EQ(never.run.outcome(), Outcome::completed);
}

TEST(Drive, EndsByARecord) {
  const std::string moved =
      kHeld + does("right", "velocity = \"2 mm/s\"\ndirection = \"x\"\nramp_time = \"1 ms\"");
  const auto run = [&](const std::string& until) {
    return Finished(free_deck(
        kUniform + kCorner + kRecords +
        drive("duration = \"50 ms\"\nlook_interval = \"0.2 ms\"", moved + "[[stages.until]]\n" + until)));
  };
  const Finished above = run("record = \"end\"\nabove = \"5 um\"\n");
  EXPECT_EQ(above.run.outcome(), Outcome::completed);
  EXPECT_GT(above.last("end_m"), 5e-6);
  EXPECT_LT(above.last("end_m"), 6e-6);
  // it cracks
  const Finished past_peak = run("record = \"grip\"\nshare_of_peak = 0.5\n");
  EXPECT_EQ(past_peak.run.outcome(), Outcome::completed);
  EXPECT_LT(past_peak.last("end_m"), 1e-4);
  EXPECT_EQ(run("record = \"end\"\nabove = \"1 m\"\n").run.outcome(), Outcome::not_reached);
}

// Promise: one of the frames is that of the peak, however few there are.
TEST(Drive, AFrameStandsBehindThePeakOfTheFirstForce) {
  Trial trial(free_deck(
      kUniform + kCorner + kRecords +
      drive("duration = \"40 ms\"\nlook_interval = \"0.2 ms\"\nframe_interval = \"30 ms\"",
            kHeld + does("right", "velocity = \"2 mm/s\"\ndirection = \"x\"\nramp_time = \"1 ms\""))));
  std::vector<double> grip;
  std::vector<std::size_t> frames;
  while (trial.run.next()) {
    grip.push_back(std::abs(trial.run.history().last("grip_N").value_or(0.0)));
    if (trial.run.frame_is_due()) frames.push_back(grip.size() - 1);
  }
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(grip) - grip.begin());
  EXPECT_EQ(std::ranges::count_if(
                frames, [&](std::size_t row) { return row > peak && grip[row] > 0.95 * grip[peak]; }),
            1);
  EXPECT_LE(frames.size(), 5U);  // beside those at the start, at 30 ms and at the end
}

// A body that still swings when it is pulled: the peaks of its first noise are no peaks of the test.
TEST(Drive, APeakOfNoiseIsNoPeak) {
  const auto run = [&](const std::string& least) {
    const std::string text =
        free_deck(kUniform + kCorner + kRecords +
                  drive("duration = \"2 ms\"", kHeld + does("right",
                                                            "velocity = \"0.4 mm/s\"\ndirection = \"x\"\n"
                                                            "factor = { table = [[\"0 s\", 1], [\"1 ms\", "
                                                            "1], [\"1.01 ms\", -1], [\"2 ms\", -1]] }")) +
                  drive("duration = \"50 ms\"\nlook_interval = \"0.2 ms\"",
                        does("right", "velocity = \"2 mm/s\"\ndirection = \"x\"\nramp_time = \"10 ms\"") +
                            "[[stages.until]]\nrecord = \"grip\"\nshare_of_peak = 0.9\n" + least));
    return Finished(with(with(text, "local_damping = 0.8", "local_damping = 0.05"), "500 1/s", "10 1/s"));
  };
  const Finished by_itself = run("");
  EXPECT_EQ(by_itself.run.outcome(), Outcome::completed);
  const double peak = std::abs(by_itself.result(1, "peak_grip_N").value());
  EXPECT_GT(peak, 2e6 * kHeight);
  const Finished stated = run("least_peak = \"100 kN\"\n");
  EXPECT_EQ(stated.last("time_s"), by_itself.last("time_s"));
}

std::string result(const std::string& name, const std::string& rest) {
  return "[[stages.results]]\nname = \"" + name + "\"\n" + rest + "\n";
}

const std::string kPull = does("right", "force = \"120 kN\"\ndirection = [1, 0]\nramp_time = \"50 ms\"");

// Load and stretch rise together from nothing: the area under their curve is half of their product.
TEST(Drive, MakesNumbersOfItsRecords) {
  const Finished run(
      free_deck(kUniform + kCorner + kRecords +
                drive("duration = \"60 ms\"\nlook_interval = \"0.2 ms\"",
                      kHeld + kPull + result("height", "kind = \"given\"\nvalue = \"12 cm\"") +
                          result("pull", "kind = \"largest\"\nrecord = \"grip\"") +
                          result("last_stretch", "kind = \"last\"\nrecord = \"stretch\"") +
                          result("stretch_then", "kind = \"at_peak\"\nrecord = \"stretch\"\nof = \"grip\"") +
                          result("W", "kind = \"work\"\nrecord = \"grip\"\nover = \"stretch\"") +
                          result("f_t",
                                 "kind = \"formula\"\nformula = \"-pull / (height * thickness)\"\n"
                                 "unit = \"MPa\"") +
                          result("none", "kind = \"formula\"\nformula = \"1 / weight\"\nunit = \"mm\""))));
  const auto value = [&](const char* name) { return run.result(0, name).value(); };
  EXPECT_NEAR(value("height_cm"), 12.0, 1e-12);
  EXPECT_EQ(value("pull_N"), value("largest_grip_N"));
  EXPECT_NEAR(value("pull_N"), -120e3, 3e3);
  EXPECT_NEAR(value("f_t_MPa"), 1.0, 0.025);
  EXPECT_EQ(value("last_stretch_m"), run.last("stretch_m"));
  EXPECT_NEAR(value("W_J"), -0.5 * 120e3 * value("last_stretch_m"), 0.02 * -value("W_J"));
  EXPECT_NEAR(value("loading_work_J"), -value("W_J"), 0.02 * value("loading_work_J"));
  EXPECT_FALSE(run.result(0, "none_mm").has_value());  // without weight
  EXPECT_GT(value("largest_grip_time_s"), 0.049);
  // a force that rises to the end has no peak, and who asked for it is told
  EXPECT_FALSE(run.result(0, "peak_grip_N").has_value());
  EXPECT_FALSE(run.result(0, "stretch_then_m").has_value());
  ASSERT_EQ(run.report(0).warnings.size(), 1U);
  EXPECT_EQ(run.report(0).warnings.front().rfind("grip has no peak: while the body was driven on", 0), 0U);
}

// Promise: the peak of a record is where the body fails. What unloads it by command is none, nor what it
// bears later; rows of the history do not matter.
TEST(Drive, APeakIsWhereTheBodyFailsWhileItIsDrivenOn) {
  const auto run = [&](const std::string& factor, const std::string& interval) {
    return Finished(free_deck(
        kUniform + kCorner + kRecords +
        drive("duration = \"50 ms\"\nlook_interval = \"" + interval + "\"",
              kHeld +
                  does("right", "velocity = \"2 mm/s\"\ndirection = \"x\"\nramp_time = \"1 ms\"\n" + factor) +
                  result("stretch_then", "kind = \"at_peak\"\nrecord = \"stretch\"\nof = \"grip\""))));
  };
  const Finished straight = run("", "0.2 ms"), coarse = run("", "5 ms");
  const double peak = straight.result(0, "peak_grip_N").value();
  EXPECT_LT(peak, -2e6 * kHeight);
  for (const auto* name : {"peak_grip_N", "peak_grip_time_s", "stretch_then_m"})
    EXPECT_EQ(coarse.result(0, name), straight.result(0, name)) << name;
  // to half of the way to the peak, back to nothing, and on
  const double half = 0.5 * straight.result(0, "peak_grip_time_s").value();
  const Finished back = run(fmt::format("factor = {{ table = [[\"0 s\", 1], [\"{0} s\", 1], [\"{1} s\", -1], "
                                        "[\"{2} s\", -1], [\"{3} s\", 1], [\"50 ms\", 1]] }}",
                                        half, half + 1e-4, 1.8 * half, 1.8 * half + 1e-4),
                            "0.2 ms");
  EXPECT_NEAR(back.result(0, "peak_grip_N").value(), peak, 0.05 * std::abs(peak));
  const Finished only_back =
      run(fmt::format("factor = {{ table = [[\"0 s\", 1], [\"{0} s\", 1], [\"{1} s\", -1], "
                      "[\"{2} s\", -1], [\"{3} s\", 0], [\"50 ms\", 0]] }}",
                      half, half + 1e-4, 1.8 * half, 1.8 * half + 1e-4),
          "0.2 ms");
  EXPECT_FALSE(only_back.result(0, "peak_grip_N").has_value());
}

// Promise: a result in a unit whose nothing is elsewhere is one in that unit.
TEST(Drive, ResultsOfTemperatureAreInTheirUnit) {
  const Finished run(free_deck(
      kUniform + kCorner + kRecords +
      drive("duration = \"1 ms\"", kHeld + result("f", "kind = \"given\"\nvalue = \"68 degF\"") +
                                       result("k", "kind = \"given\"\nvalue = \"293.15 K\"") +
                                       result("g", "kind = \"formula\"\nformula = \"f\"\nunit = \"degF\""))));
  EXPECT_NEAR(run.result(0, "f_degF").value(), 68.0, 1e-9);
  EXPECT_NEAR(run.result(0, "k_K").value(), 293.15, 1e-9);
  EXPECT_NEAR(run.result(0, "g_degF").value(), 68.0, 1e-9);
}

TEST(Drive, ARecordWithTheNameOfAnotherColumnIsRefused) {
  EXPECT_NE(message(free_deck(kUniform + kCorner +
                              "[[record]]\nname = \"temperature\"\nkind = \"temperature\"\nset = \"left\"\n" +
                              drive("duration = \"1 ms\"", kHeld)))
                .find("two columns \"temperature_degC\""),
            std::string::npos);
}

// Promise: a fall is that of a peak once it has lasted for a tenth of the time for which the body was driven.
TEST(Drive, APeakLastsForATenthOfTheTimeToIt) {
  const auto run = [&](double duration) {
    return Finished(free_deck(
        kUniform + kCorner + kRecords +
        drive(fmt::format("duration = \"{:.6g} s\"\nlook_interval = \"0.2 ms\"", duration),
              kHeld + does("right", "velocity = \"0.4 mm/s\"\ndirection = \"x\"\nramp_time = \"1 ms\""))));
  };
  const Finished whole = run(0.1);
  const double peak = whole.result(0, "peak_grip_N").value(),
               time = whole.result(0, "peak_grip_time_s").value();
  const auto rows = whole.run.courses()[0].rows;
  const auto grip = whole.run.history().values("grip_N", rows),
             at = whole.run.history().values("time_s", rows);
  const auto fallen =
      std::ranges::find_if(grip, [&](double g) { return std::abs(g) > 0.99 * std::abs(peak); });
  const auto below =
      std::find_if(fallen, grip.end(), [&](double g) { return std::abs(g) < 0.8 * std::abs(peak); });
  ASSERT_NE(below, grip.end());
  const double later = at[static_cast<std::size_t>(below - grip.begin())] + 1e-3;
  ASSERT_GT(later, 1.12 * time);
  const Finished beyond = run(later), short_of_it = run(1.08 * time);
  ASSERT_GT(std::abs(beyond.last("grip_N")), 0.55 * std::abs(peak));  // no collapse
  EXPECT_EQ(beyond.result(0, "peak_grip_N"), peak);
  EXPECT_EQ(beyond.result(0, "peak_grip_time_s"), time);
  EXPECT_FALSE(short_of_it.result(0, "peak_grip_N"));
  EXPECT_EQ(short_of_it.result(0, "largest_grip_N"), peak);
}

TEST(Drive, ResultsThatCannotBeMadeAreRefused) {
  const auto refused = [](const std::string& results) {
    return message(free_deck(kUniform + kCorner + kRecords + drive("duration = \"1 ms\"", kHeld + results)));
  };
  const auto says = [](const std::string& told, const std::string& part) {
    EXPECT_NE(told.find(part), std::string::npos) << told;
  };
  says(refused(result("p", "kind = \"peak\"\nrecord = \"gripp\"")), "is no [[record]]; there are stress");
  says(refused(result("w", "kind = \"work\"\nrecord = \"end\"\nover = \"end\"")), "must be of kind force");
  says(refused(result("f", "kind = \"formula\"\nformula = \"2 * pp\"")),
       "\"pp\" is not known; names are thickness, weight");
  says(refused(result("q", "kind = \"given\"\nvalue = \"3 mol\"")), "of none of the kinds");
  says(refused(result("peak_grip", "kind = \"last\"\nrecord = \"grip\"")),
       "\"peak_grip_N\" is a result that every stage with this record has");
  says(refused(result("weight", "kind = \"given\"\nvalue = \"3 kN\"")), "is known to formulas already");
  says(refused(result("2a", "kind = \"given\"\nvalue = \"3 kN\"")), "must begin with a letter");
}

TEST(Drive, WhatCannotBeDoneIsRefusedBeforeTheRun) {
  const auto refused = [](const std::string& drives, const std::string& more = "") {
    return message(free_deck(kUniform + kCorner + more + drive("duration = \"1 ms\"", drives)));
  };
  const auto says = [](const std::string& told, const std::string& part) {
    EXPECT_NE(told.find(part), std::string::npos) << told;
  };
  says(refused(kHeld + does("rigth", "hold = [\"x\"]")),
       "there is no set \"rigth\"; there are aggregate, bottom, corner, left");
  says(refused(kHeld + does("bottom", "velocity = \"1 mm/s\"\ndirection = \"x\"")),
       "both are held or driven along x");
  says(refused(kHeld + does("left", "force = \"1 kN\"\ndirection = [1, 0]")), "held or driven along x");
  says(refused(does("right", "force = \"1 kN\"\ndirection = [1, 0]")), "moving along x and y, and turning");
  says(refused(does("left", "hold = [\"x\"]") + does("right", "pressure = \"1 MPa\"")), "moving along y");
  says(refused(does("corner", "hold = [\"x\", \"y\"]") + does("right", "pressure = \"1 MPa\"")),
       "against turning about one point");
  says(refused(kHeld, "[[sets]]\nname = \"nothing\"\nnearest = [\"0 mm\", \"0 mm\"]\nwithin = \"no\"\n"),
       "there is no such set of gridpoints");
  says(refused(kHeld, "[[sets]]\nname = \"far\"\ncentre = [\"1 m\", \"1 m\"]\nradius = \"1 mm\"\n"),
       "\"far\" is empty");
  says(refused(kHeld, "[[sets]]\nname = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n"),
       "the name of one that there is");
  says(refused(kHeld, record("r", "stress", "set = \"corner\"\ndirection = \"x\"")), "which holds no zone");
  says(message(free_deck(kUniform + kSettle + kCompress)), "\"compress\" needs the table [platens]");
  says(refused(kHeld + does("right", "pressure = \"1 MPa\"\nramp_time = \"2 ms\"")),
       "ramp_time = \"2 ms\": must end within the duration of the stage");
  says(refused(kHeld + does("right", "force = \"0 N\"\ndirection = [1, 0]")),
       "no force acts on set \"right\" along that direction, so that this ends nothing");
  says(refused(kHeld + does("right", "pressure = \"0 Pa\"")), "no pressure acts on set \"right\"");
  const std::string pressed = drive("duration = \"1 ms\"", kHeld + does("right", "pressure = \"1 MPa\""));
  says(refused(does("right", "force = \"0 N\"\ndirection = [1, 0]"), pressed),
       "ends nothing; a pressure does (");
  EXPECT_EQ(refused(does("right", "pressure = \"0 Pa\""), pressed), "no Error was thrown");
  says(refused(kHeld + does("left", "pressure = \"1 MPa\"")), "all of which is held or driven along it");
  const std::string pulled =
      drive("duration = \"1 ms\"", kHeld + does("right", "force = \"1 kN\"\ndirection = [1, 1]"));
  says(refused(does("right", "force = \"0 N\"\ndirection = [1, -1]"), pulled), "along that direction");
  EXPECT_EQ(refused(does("right", "force = \"0 N\"\ndirection = [0, 1]"), pulled), "no Error was thrown");
}

TEST(Drive, ASlitNeedsALawThatKnowsDamage) {
  std::string text = free_deck(drive("duration = \"1 ms\"", kHeld + does("right", "pressure = \"1 MPa\"")) +
                               kUniform + kCorner);
  text = with(text, "temperature_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.1]] }\n" + kMortarBond,
              "law = \"elastic\"\n");
  text = with(text, "strength_factor = 1.0\n", "");
  text = with(text, "seed = 1\n",
              "seed = 1\n[[specimen.notches]]\nname = \"cut\"\nmouth = [\"0 mm\", \"60 mm\"]\n"
              "tip = [\"20 mm\", \"60 mm\"]\nwidth = \"0 mm\"\n");
  const std::string told = message(text);
  EXPECT_NE(told.find(": specimen.notches[0]: cut is a slit through contacts of "), std::string::npos)
      << told;
  EXPECT_NE(told.find("which the law \"elastic\" never parts"), std::string::npos) << told;
}

// A body that is held as it may expand stays without stress.
TEST(DriveVerification, AHeldBodyExpandsWithoutStress) {
  const Finished run(free_deck(kUniform + kCorner + kRecords + drive("duration = \"1 ms\"", kHeld) +
                               with(heat("70 degC"), "platen = \"force\"\n", "")));
  EXPECT_EQ(run.run.outcome(), Outcome::completed);
  EXPECT_EQ(run.result(1, "exchanges_not_converged"), 0.0);
  expect_known(
      {"stretch of a body of one expansion that is held on one side, 20 to 70 degC", "alpha dT l", "m"},
      run.last("stretch_m"), 1e-5 * 50.0 * kWidth, 1e-3 * 1e-5 * 50.0 * kWidth);
  EXPECT_NEAR(run.last("stress_MPa"), 0.0, 0.02);
}

// Promise: an exchange of a body that nothing loads rests when the body has grown, not when it is only slow.
TEST(DriveVerification, AFreeBodyHasGrownWhenItsExchangeRests) {
  std::string text =
      free_deck(kCorner + kRecords + drive("duration = \"1 ms\"", kHeld) + kExpose +
                "[heat]\nfield = \"conduction\"\n[[heat.boundaries]]\nfaces = \"outline\"\n"
                "kind = \"temperature\"\n"
                "temperature = { from = \"20 degC\", rate = \"6 K/min\", to = \"33 degC\" }\n");
  text = with(text, "duration = \"6 min\"\nplaten = \"force\"", "duration = \"1 h\"");
  text = with(text, "exchange_increment = \"5 K\"\nunbalanced_ratio = 1e-3\nplaten_difference = \"20 kPa\"",
              "exchange_increment = \"20 K\"\nunbalanced_ratio = 1e-5\nplaten_difference = \"0.1 MPa\"");
  const Finished run(text);
  EXPECT_EQ(run.last("converged"), 1.0);
  const double growth = 1e-5 * 13.0 * kWidth;
  expect_known({"growth of a free body at rest, 13 K in one exchange", "alpha dT l", "m"}, run.last("end_m"),
               growth, 0.01 * growth);
}

TEST(Drive, AFollowerTurnsWithTheBodyAndADeadLoadDoesNot) {
  for (const bool follows : {true, false}) {
    const std::string text =
        with(free_deck(kUniform + kCorner +
                       drive("duration = \"20 ms\"", does("specimen", "hold = [\"x\", \"y\"]"))),
             "mass = \"scaled\"\n", "mass = \"scaled\"\nkinematics = \"finite\"\n");
    Trial trial(text);
    Simulation& simulation = *trial.simulation;
    Mechanics<2>& mechanics = in_plane::mechanics(simulation.motion());
    const auto& right = simulation.model().set("right");
    simulation.loads().set({{"right", {.pressure = 1e6, .is_follower = follows}}});
    Vec<2> before{};
    std::vector<int> once = right;
    sort_unique(once);
    for (int g : once) before += mechanics.read().applied_force(g);
    EXPECT_NEAR(before[0], -1e6 * kHeight, 1e-3);
    EXPECT_NEAR(before[1], 0.0, 1e-3);
    // a quarter turn about the origin, in one step
    const double step = mechanics.time_step();
    for (int g = 0; g < simulation.model().gridpoint_count(); ++g) {
      const Vec<3> x = simulation.model().place(g);
      mechanics.constraints().prescribe_velocity(g, 0, (-x[1] - x[0]) / step);
      mechanics.constraints().prescribe_velocity(g, 1, (x[0] - x[1]) / step);
    }
    mechanics.advance(1);
    simulation.loads().set({});
    Vec<2> after{};
    for (int g : once) after += mechanics.read().applied_force(g);
    EXPECT_NEAR(after[follows ? 1 : 0], -1e6 * kHeight, 1e-3);
    EXPECT_NEAR(after[follows ? 0 : 1], 0.0, 1e-3);
  }
}

const std::string kMiddle =
    "[[sets]]\nname = \"one\"\nbox = [[\"10 mm\", \"0 mm\"], [\"20 mm\", \"120 mm\"]]\n"
    "[[sets]]\nname = \"other\"\nbox = [[\"40 mm\", \"0 mm\"], [\"50 mm\", \"120 mm\"]]\n" +
    record("middle", "opening", "set = \"one\"\nother = \"other\"\ndirection = \"x\"");

TEST(Drive, GoesOnToTheBitFromAStateOnItsWay) {
  const std::string text = free_deck(
      kUniform + kCorner + kMiddle + kRecords +
      drive(kToRest, kHeld + does("right", "force = \"60 kN\"\ndirection = [1, 0]\nramp_time = \"5 ms\"")) +
      drive("duration = \"20 ms\"\n[stages.control]\nrecord = \"middle\"\nrate = \"1 mm/s\"\n"
            "stiffness = \"2 GN/m\"\nresponse_time = \"2 ms\"",
            does("right", "force = \"60 kN\"\ndirection = [1, 0]") + "[[stages.until]]\nrecord = \"grip\"\n" +
                "share_of_peak = 0.5\n"));
  Trial whole(text);
  const Outcome outcome = whole.run.run();
  const std::size_t looks = whole.run.history().row_count();
  for (const std::size_t stop : {std::size_t{3}, looks / 2, looks - 3}) {
    Trial first(text), second(text);
    while (first.run.history().row_count() < stop) first.run.next();
    copy_state(first.run, second.run);
    EXPECT_EQ(second.run.run(), outcome);
    ASSERT_EQ(second.run.history().row_count(), looks);
    for (std::size_t row = 0; row < looks; ++row)
      EXPECT_EQ(second.run.history().row(row), whole.run.history().row(row)) << "stopped at " << stop;
  }
}

}  // namespace
}  // namespace pyroclast
