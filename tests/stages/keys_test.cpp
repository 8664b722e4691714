#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/stages/drive.hpp"
#include "stages/drives.hpp"

/// What decks may say of stages, what is unusual, and what may not stand beside another.
namespace pyroclast::keys_test {
namespace {

std::string message(const std::string& text) {
  return pyroclast::message([&] { pyroclast::read(text); });
}

const std::string kNone = "no Error was thrown";

/// Whether a deck that is no error has a warning at a key.
bool warns(const std::string& text, const std::string& key) {
  const pyroclast::Setup setup = pyroclast::read(text);
  return std::ranges::any_of(setup.warnings, [&](const Diagnostic& w) { return w.key == key; });
}

std::string stage(const std::string& kind, const std::string& rest) {
  return "[[stages]]\nkind = \"" + kind + "\"\n" + rest + "\n";
}

std::string compress(const std::string& rest, const std::string& velocity = "0.5 mm/s") {
  return stage("compress", "velocity = \"" + velocity + "\"\nramp_time = \"20 ms\"\n" + rest);
}

// Promise: what lies outside of what is usual is a warning at its key, from just the stated bounds on.
TEST(Keys, UnusualValuesAreWarnedOf) {
  struct Case {
    std::string text;  ///< with {} for the value
    std::string key;
    double low, high;  ///< 0: none
  };
  const std::string settled = deck(kUniform + kSettle);
  const auto load = [](const std::string& rest) {
    return "[[stages]]\nkind = \"load\"\nramp_time = \"20 ms\"\nmost_steps = 100\n" + rest + "\n";
  };
  const std::string rest = "unbalanced_ratio = 1e-6\n";
  const auto coupled = [&](const std::string& from, const std::string& to) {
    return with(deck(kUniform + kSettle + heat("30 degC")), from, to);
  };
  const std::vector<Case> cases{
      {deck(kUniform + with(kSettle, "1e-6", "{}")), "stages[0].unbalanced_ratio", 1e-8, 0.01},
      {settled + load("stress = \"1 MPa\"\nunbalanced_ratio = {}"), "stages[1].unbalanced_ratio", 1e-8, 0.01},
      {settled + load("stress = \"{} Pa\"\n" + rest), "stages[1].stress", 0.0, 200e6},
      {settled + load("level = 0.1\nf_c = \"{} Pa\"\n" + rest), "stages[1].f_c", 1e6, 300e6},
      {settled + load("stress = \"1 MPa\"\nfailure_strain = {}\n" + rest), "stages[1].failure_strain", 1e-3,
       0.1},
      {settled + compress("stop_strain = 0.01", "{} m/s"), "stages[1].velocity", 1e-6, 0.01},
      {settled + compress("stop_strain = {}"), "stages[1].stop_strain", 0.0, 0.1},
      {settled + compress("to_strain = {}"), "stages[1].to_strain", 0.0, 0.1},
      {settled + compress("to_strain = -{}"), "stages[1].to_strain", 0.0, 0.1},
      {settled + compress("to_stress = \"{} Pa\""), "stages[1].to_stress", 0.0, 200e6},
      {with(deck(kUniform + kSettle + heat("30 degC")), "\"5 K/min\"", "\"{} K/s\""), "stages[1].rate", 1e-4,
       10.0},
      {coupled("exchange_increment = \"5 K\"", "exchange_increment = \"{} K\""),
       "coupling.exchange_increment", 0.1, 50.0},
      {coupled("unbalanced_ratio = 1e-3", "unbalanced_ratio = {}"), "coupling.unbalanced_ratio", 1e-8, 0.01},
      {coupled("platen_difference = \"20 kPa\"", "platen_difference = \"{} Pa\""),
       "coupling.platen_difference", 1e2, 1e6},
      {coupled("failure_strain = 0.005", "failure_strain = {}"), "coupling.failure_strain", 5e-4, 0.05},
      {free_deck(kUniform +
                 drive("duration = \"1 ms\"\nunbalanced_ratio = {}", does("left", "hold = [\"x\"]"))),
       "stages[0].unbalanced_ratio", 1e-8, 0.01},
      {free_deck(kUniform +
                 drive("duration = \"1 ms\"", does("left", "velocity = \"{} m/s\"\ndirection = \"x\""))),
       "stages[0].drives[0].velocity", 0.0, 0.1},
      {free_deck(kUniform +
                 drive("duration = \"1 ms\"", does("left", "velocity = \"-{} m/s\"\ndirection = \"x\""))),
       "stages[0].drives[0].velocity", 0.0, 0.1}};
  for (const Case& c : cases) {
    const auto warned = [&](double value) {
      return warns(with(c.text, "{}", fmt::format("{:.6g}", value)), c.key);
    };
    if (c.low > 0.0) {
      EXPECT_TRUE(warned(0.98 * c.low)) << c.key;
      EXPECT_FALSE(warned(1.02 * c.low)) << c.key;
    }
    EXPECT_FALSE(warned(0.98 * c.high)) << c.key;
    EXPECT_TRUE(warned(1.02 * c.high)) << c.key;
  }
}

// Promise: ends of ranges are refused or allowed as their keys say.
TEST(Keys, EndsOfRanges) {
  const std::string settled = deck(kUniform + kSettle);
  const auto load = [&](const std::string& rest) {
    return settled + "[[stages]]\nkind = \"load\"\nunbalanced_ratio = 1e-6\n" + rest + "\n";
  };
  const auto coupled = [&](const std::string& from, const std::string& to) {
    return with(deck(kUniform + kSettle + heat("30 degC")), from, to);
  };
  for (const auto& text :
       {deck(kUniform + with(kSettle, "100000", "1")),
        load("stress = \"0 MPa\"\nramp_time = \"0 s\"\nmost_steps = 1"),
        load("level = 0\nf_c = \"30 MPa\"\nramp_time = \"1 s\"\nmost_steps = 1"),
        settled + compress("stop_strain = 0.01\nstop_fraction_of_peak = 0"),
        settled + compress("stop_strain = 0.01\nstop_fraction_of_peak = 0.999"),
        settled + compress("to_stress = \"0 MPa\""),
        settled + with(compress("stop_strain = 0.01"), "20 ms", "0 ms"),
        settled + compress("stop_strain = 0.01\n" + with(kControl, "10 mm/s", "0.5 mm/s")),
        coupled("least_cycles = 50", "least_cycles = 0"), coupled("most_cycles = 5000", "most_cycles = 50")})
    EXPECT_EQ(message(text), kNone);
  for (const auto& [text, key] :
       {std::pair{deck(kUniform + with(kSettle, "100000", "0")), "most_steps"},
        std::pair{deck(kUniform + with(kSettle, "1e-6", "0")), "unbalanced_ratio"},
        std::pair{load("stress = \"-1 Pa\"\nramp_time = \"0 s\"\nmost_steps = 1"), "stress"},
        std::pair{load("stress = \"1 MPa\"\nramp_time = \"0 s\"\nmost_steps = 0"), "most_steps"},
        std::pair{load("stress = \"1 MPa\"\nramp_time = \"-1 s\"\nmost_steps = 1"), "ramp_time"},
        std::pair{load("stress = \"1 MPa\"\nramp_time = \"1 s\"\nmost_steps = 1\nfailure_strain = 1"),
                  "failure_strain"},
        std::pair{load("stress = \"1 MPa\"\nramp_time = \"1 s\"\nmost_steps = 1\nfailure_strain = 0"),
                  "failure_strain"},
        std::pair{settled + compress("stop_strain = 0.01\nstop_fraction_of_peak = 1"),
                  "stop_fraction_of_peak"},
        std::pair{settled + compress("stop_strain = 0.01\nstop_fraction_of_peak = -0.1"),
                  "stop_fraction_of_peak"},
        std::pair{settled + compress("stop_strain = 1"), "stop_strain"},
        std::pair{settled + compress("stop_strain = 0"), "stop_strain"},
        std::pair{settled + compress("to_strain = 1"), "to_strain"},
        std::pair{settled + compress("to_strain = -1"), "to_strain"},
        std::pair{settled + compress("to_strain = 0.001\nto_stress = \"1 MPa\""),
                  "either to_strain or to_stress"},
        std::pair{settled + compress("stop_strain = 0.01\n" + with(kControl, "10 mm/s", "0.49 mm/s")),
                  "fastest_velocity"},
        std::pair{coupled("most_cycles = 5000", "most_cycles = 49"), "must not be less than least_cycles"},
        std::pair{coupled("most_cycles = 5000", "most_cycles = 0"), "most_cycles"},
        std::pair{coupled("least_cycles = 50", "least_cycles = -1"), "least_cycles"},
        std::pair{coupled("failure_strain = 0.005", "failure_strain = 1"), "failure_strain"},
        std::pair{coupled("failure_strain = 0.005", "failure_strain = 0"), "failure_strain"}})
    expect_in(key, message(text));
}

// Promise: a level from 1 on will probably crush, below it will not.
TEST(Keys, ALevelOfTheStrengthIsWarnedOf) {
  const auto warned = [](const std::string& level) {
    return warns(deck(kUniform + kSettle + load("level = " + level + "\nf_c = \"30 MPa\"")),
                 "stages[1].level");
  };
  EXPECT_FALSE(warned("0.99"));
  EXPECT_TRUE(warned("1"));
}

// Promise: a stage's own coupling stands before the general one, key by key.
TEST(Keys, AStagesOwnCouplingStandsBeforeTheGeneralOne) {
  const Finished r(deck(kUniform + kSettle + heat("30 degC") +
                        "[stages.coupling]\nexchange_increment = \"2 K\"\n" + heat("40 degC") +
                        "[stages.coupling]\nmost_cycles = 50\n"));
  EXPECT_EQ(r.result(1, "exchanges"), 5.0);
  EXPECT_EQ(r.result(2, "exchanges"), 2.0);
  EXPECT_EQ(r.result(2, "cycles"), 100.0);
}

// Promise: a stress that cannot be borne is sought up to a strain of 2 % where the deck says no other.
TEST(Keys, AStressIsSoughtUpToTwoPercent) {
  const Finished r(deck(kUniform + kSettle + compress("to_stress = \"90 MPa\"", "9 mm/s")));
  EXPECT_EQ(r.run.outcome(), Outcome::not_reached);
  EXPECT_GE(r.last("stage_strain"), 0.02);
  EXPECT_LT(r.last("stage_strain"), 0.0201);
}

// ---- A controlled velocity -------------------------------------------------------------------------------

/// Steps and strain of a controlled compression, with these tolerances.
Finished controlled(const std::string& ratio, const std::string& kinetic, const std::string& difference,
                    const std::string& end) {
  return Finished(deck(
      kUniform + kSettle +
      stage("compress", "velocity = \"0.5 mm/s\"\nramp_time = \"20 ms\"\nstop_strain = " + end +
                            "\nfastest_velocity = \"8 mm/s\"\nunbalanced_ratio = " + ratio +
                            "\nkinetic_over_strain = " + kinetic + "\nplaten_difference = " + difference +
                            "\ndissipation_rate = \"1e9 1/s\"")));
}

// Promise: where the tolerances are never met, the velocity grows by a factor e in the time of its ramp, from
// the lowest to the highest, and stays there.
TEST(ControlledVelocity, GrowsByAFactorEInTheTimeOfItsRamp) {
  const Finished r = controlled("1e9", "1e9", "1e9", "0.002");
  const RowRange rows = r.run.courses()[1].rows;
  const auto time = r.run.history().values("time_s", rows), strain = r.run.history().values("strain", rows);
  const double begin = r.run.history().cell(rows.first - 1, "time_s").value();
  // way: half of the ramp, then (e^x - 1) ramps at the lowest, up to ln 16 ramps, then at the highest
  const auto way = [&](double t) {
    const double ramps = (t - begin) / 0.02, lowest = 0.5e-3 * 0.02;
    if (ramps < 1.0) return 0.5 * ramps * ramps * lowest;
    const double x = ramps - 1.0, full = std::log(16.0);
    if (x < full) return (0.5 + std::exp(x) - 1.0) * lowest;
    return (0.5 + 15.0 + 16.0 * (x - full)) * lowest;
  };
  ASSERT_GT(time.size(), 20u);
  for (std::size_t i = 3; i < time.size(); ++i)
    EXPECT_NEAR(strain[i], way(time[i]) / 0.12, 0.03 * way(time[i]) / 0.12 + 3e-6) << i;
}

/// Velocities of the platen between the rows of a stage, m/s, and the times between their middles.
std::pair<std::vector<double>, std::vector<double>> velocities(const Finished& r, int stage) {
  const RowRange rows = r.run.courses()[static_cast<std::size_t>(stage)].rows;
  const auto time = r.run.history().values("time_s", rows), strain = r.run.history().values("strain", rows);
  std::vector<double> velocity, between;
  for (std::size_t i = 1; i < time.size(); ++i) {
    velocity.push_back(0.12 * (strain[i] - strain[i - 1]) / (time[i] - time[i - 1]));
    if (i > 1) between.push_back(0.5 * (time[i] - time[i - 2]));
  }
  return {velocity, between};
}

// Promise: a velocity falls four times as fast as it rises, which is a factor e in the time of the ramp, to
// the lowest.
TEST(ControlledVelocity, FallsFourTimesAsFastAsItRises) {
  // until something cracks no tolerance is met; then that of the cracks is missed by far
  const Finished r(
      deck(kUniform + kSettle +
           stage("compress",
                 "velocity = \"0.5 mm/s\"\nramp_time = \"20 ms\"\nstop_strain = 0.003\n"
                 "fastest_velocity = \"8 mm/s\"\nunbalanced_ratio = 1e9\n"
                 "kinetic_over_strain = 1e9\nplaten_difference = 1e9\ndissipation_rate = \"0.6 1/s\"")));
  const auto [velocity, between] = velocities(r, 1);
  double rises = 0.0, falls = 0.0;
  for (std::size_t i = 0; i < between.size(); ++i) {
    if (velocity[i] < 2.4e-3 || velocity[i + 1] < 2.4e-3) continue;  // there a row is a choice
    const double rate = std::log(velocity[i + 1] / velocity[i]) / between[i];
    rises = std::max(rises, rate);
    falls = std::max(falls, -rate);
  }
  EXPECT_NEAR(rises, 1.0 / 0.02, 1.0);
  EXPECT_NEAR(falls, 4.0 / 0.02, 4.0);
  EXPECT_NEAR(velocity.back(), 0.5e-3, 1e-5);
}

// Promise: each of the tolerances of inertia binds by itself: what never meets it stays at the lowest
// velocity.
TEST(ControlledVelocity, EachToleranceBindsAlone) {
  const std::string no = "1e9", all = "1e-12";
  for (const Finished& r : {controlled(all, no, no, "0.0002"), controlled(no, all, no, "0.0002"),
                            controlled(no, no, all, "0.0002")}) {
    const auto velocity = velocities(r, 1).first;
    EXPECT_NEAR(velocity.back(), 0.5e-3, 0.02e-3);
    EXPECT_LT(*std::ranges::max_element(velocity), 0.52e-3);
  }
}

// Promise: the velocity settles where the one tolerance that binds is just met.
TEST(ControlledVelocity, SettlesWhereItsToleranceIsMet) {
  const Finished kinetic = controlled("1e9", "2e-4", "1e9", "0.0006");
  const RowRange rows = kinetic.run.courses()[1].rows;
  const auto value = [&](const char* column, std::size_t row) {
    return kinetic.run.history().cell(row, column).value();
  };
  double sum = 0.0;
  int count = 0;
  for (std::size_t row = (rows.first + rows.last) / 2; row < rows.last; ++row, ++count)
    sum += value("energy_kinetic_J", row) / (value("energy_zones_J", row) + value("energy_contacts_J", row)) /
           2e-4;
  EXPECT_GT(sum / count, 0.6);
  EXPECT_LT(sum / count, 1.4);
}

// ---- Drives beside each other ----------------------------------------------------------------------------

// Promise: a drive may not act on what another one under way moves or loads again and again; beside it, it
// may.
TEST(DrivesBeside, WhatIsSteeredIsLeftAlone) {
  const auto refused = [](const std::string& under_way, const std::string& own) {
    const Trial trial(
        free_deck(kUniform + drive("duration = \"1 ms\"", under_way) + drive("duration = \"1 ms\"", own)));
    const auto& stages = trial.run.stages();
    const auto& first = dynamic_cast<const Drive&>(*stages[0]);
    const auto& second = dynamic_cast<const Drive&>(*stages[1]);
    Acting acting = acting_on(*trial.simulation);
    first.check(*trial.simulation, acting);
    second.check(*trial.simulation, acting);
    return pyroclast::message([&] { second.check_beside(first, *trial.simulation, acting.supports); });
  };
  const std::string held = does("left", "hold = [\"x\", \"y\"]");
  const std::string pulled = held + does("right", "velocity = \"1 mm/s\"\ndirection = \"x\"");
  const std::string push = does("right", "force = \"1 kN\"\ndirection = [0, 1]");
  const std::string words = "the stage under way moves or loads set \"right\" itself";
  expect_in(words, refused(pulled, does("right", "hold = [\"x\"]")));
  expect_in(words, refused(pulled, does("right", "release = [\"x\"]")));
  expect_in(words, refused(pulled, does("top", "hold = [\"x\"]")));  // they share a corner
  EXPECT_EQ(refused(pulled, does("right", "hold = [\"y\"]")), kNone);
  EXPECT_EQ(refused(pulled, does("left", "hold = [\"x\"]")), kNone);
  EXPECT_EQ(refused(pulled, push), kNone);
  EXPECT_EQ(refused(held, does("left", "hold = [\"x\"]")), kNone);  // what is held is not steered
  expect_in(words, refused(held + push, push));
  expect_in(words, refused(held + push, does("right", "pressure = \"1 MPa\"")));
  EXPECT_EQ(refused(held + push, does("top", "pressure = \"1 MPa\"")), kNone);
  EXPECT_EQ(refused(held + push, does("right", "hold = [\"x\"]")), kNone);
  expect_in("the stage under way loads set \"right\"", refused(held + push, does("right", "hold = [\"y\"]")));
}

// Promise: a drive that moves or loads is one that loads; holding alone is not. Its sets are those it acts
// on.
TEST(DrivesBeside, ItsSetsAndWhetherItLoads) {
  const auto loads = [](const std::string& drives) {
    const Trial trial(free_deck(kUniform + drive("duration = \"1 ms\"", drives)));
    return trial.run.stages()[0]->loads();
  };
  const std::string held = does("left", "hold = [\"x\", \"y\"]");
  EXPECT_FALSE(loads(held));
  EXPECT_TRUE(loads(held + does("right", "velocity = \"1 mm/s\"\ndirection = \"x\"")));
  EXPECT_TRUE(loads(held + does("right", "force = \"1 kN\"\ndirection = [0, 1]")));
  EXPECT_TRUE(loads(held + does("right", "pressure = \"1 MPa\"")));
  const Trial trial(
      free_deck(kUniform + drive("duration = \"1 ms\"", held + does("right", "pressure = \"1 MPa\""))));
  EXPECT_EQ(trial.run.stages()[0]->sets(), (std::vector<std::string>{"left", "right"}));
}

// Promise: a drive's progress is the share of its duration, its rows and frames come at their intervals.
TEST(DrivesBeside, RowsAndFramesComeAtTheirIntervals) {
  Trial trial(
      free_deck(kUniform + drive("duration = \"10 ms\"\nlook_interval = \"1 ms\"\nframe_interval = \"4 ms\"",
                                 does("left", "hold = [\"x\", \"y\"]") +
                                     does("right", "velocity = \"0.1 mm/s\"\ndirection = \"x\""))));
  std::vector<double> looks, frames;
  double begin = 0.0;
  while (trial.run.next()) {
    const double now = trial.run.history().last("time_s").value() - begin;
    if (looks.empty()) begin = now;
    looks.push_back(now);
    if (looks.size() == 1) {
      looks[0] = 0.0;
      continue;
    }
    EXPECT_NEAR(trial.run.progress(), now / 0.01, 1e-6);
    if (trial.run.frame_is_due()) frames.push_back(now);
  }
  ASSERT_EQ(looks.size(), 11u);
  for (std::size_t i = 0; i < looks.size(); ++i) EXPECT_NEAR(looks[i], 1e-3 * static_cast<double>(i), 2e-4);
  ASSERT_EQ(frames.size(), 3u);  // and at the end
  EXPECT_NEAR(frames[0], 4e-3, 1e-3);
  EXPECT_NEAR(frames[1], 8e-3, 1e-3);
  EXPECT_NEAR(frames[2], 10e-3, 1e-3);
}

// Promise: a set that is not there, or that the press works, is refused, and so are two wishes for one set.
TEST(DrivesBeside, WhatContradictsIsRefused) {
  const auto refused = [](const std::string& drives) {
    return pyroclast::message(
        [&] { const Trial trial(free_deck(kUniform + drive("duration = \"1 ms\"", drives))); });
  };
  expect_in("there is no set \"nowhere\"; there are ", refused(does("nowhere", "hold = [\"x\"]")));
  const std::string twice =
      refused(does("left", "hold = [\"x\"]") + does("left", "release = [\"y\", \"x\"]"));
  expect_in("set \"left\" is held, driven or released along x twice in one stage", twice);
  // the later place first, and then the other one
  const auto line = [&](std::size_t from) {
    return std::stoi(twice.substr(twice.find("deck.toml:", from) + 10));
  };
  EXPECT_GT(line(0), line(twice.find(" at ")));
  expect_in(
      "set \"left\" is held, driven or released along y twice in one stage",
      refused(does("left", "hold = [\"y\"]") + does("left", "velocity = \"1 mm/s\"\ndirection = \"y\"")));
  const std::string held = does("left", "hold = [\"x\", \"y\"]");
  EXPECT_EQ(refused(does("left", "hold = [\"x\"]") + does("left", "hold = [\"y\"]")), kNone);
  expect_in("has a pressure that follows the body and one that does not",
            refused(held + does("right", "pressure = \"1 MPa\"") +
                    does("right", "pressure = \"1 MPa\"\nfollower = true")));
  EXPECT_EQ(refused(held + does("right", "pressure = \"1 MPa\"") + does("right", "pressure = \"2 MPa\"")),
            kNone);
  expect_in("a force acts along y on set \"left\"",
            refused(held + does("left", "force = \"1 N\"\ndirection = [0, 1]")));
  EXPECT_EQ(refused(does("left", "hold = [\"x\"]") + does("bottom", "hold = [\"y\"]") +
                    does("right", "force = \"1 kN\"\ndirection = [1, 0]")),
            kNone);
  expect_in("a body in the plane has no z", refused(does("left", "hold = [\"z\"]")));
  expect_in("list of \"x\", \"y\" and in a solid \"z\"; got \"w\"", refused(does("left", "hold = [\"w\"]")));
  expect_in("not two in one table", refused(does("left", "hold = [\"x\"]\npressure = \"1 MPa\"")));
  expect_in("one of hold, release, velocity, force and pressure is needed", refused(does("left", "")));
  expect_in("has no length", refused(held + does("right", "force = \"1 kN\"\ndirection = [0, 0]")));
  expect_in("must be two numbers", refused(held + does("right", "force = \"1 kN\"\ndirection = [0, 1, 0]")));
  for (const char* platen : {"bottom_platen", "top_platen"})
    expect_in(fmt::format("which the press works"), pyroclast::message([&] {
                const Trial trial(deck(kUniform + drive("duration = \"1 ms\"\nlook_interval = \"1 ms\"",
                                                        does(platen, "hold = [\"x\"]"))));
              }));
}

// Promise: a condition is one of its kinds, within its range, on a record that there is.
TEST(DrivesBeside, ConditionsThatAreNoneAreRefused) {
  const std::string records =
      record("end", "displacement", "set = \"right\"\ndirection = \"x\"") +
      record("gap", "opening", "set = \"left\"\nother = \"right\"\ndirection = \"x\"");
  const std::string held = does("left", "hold = [\"x\", \"y\"]");
  const auto refused = [&](const std::string& rest) {
    return message(free_deck(kUniform + records + drive("duration = \"1 ms\"", held + rest)));
  };
  const auto until = [&](const std::string& rest) {
    return refused("[[stages.until]]\nrecord = \"end\"\n" + rest);
  };
  EXPECT_EQ(until("above = \"-1 mm\""), kNone);
  EXPECT_EQ(until("below = \"0 mm\""), kNone);
  EXPECT_EQ(until("share_of_peak = 0.999\nleast_peak = \"1 um\""), kNone);
  EXPECT_EQ(until("rate_above = \"1e-9 m/s\""), kNone);
  const std::string alone =
      "one of above, below, share_of_peak, rate_above and rate_below is needed, and one alone";
  expect_in(alone, until(""));
  expect_in(alone, until("above = \"1 mm\"\nbelow = \"0 mm\""));
  for (const char* share : {"0", "1", "1.05"})
    expect_in("share_of_peak", until(std::string("share_of_peak = ") + share));
  expect_in("least_peak", until("share_of_peak = 0.5\nleast_peak = \"0 mm\""));
  expect_in("rate_above", until("rate_above = \"0 m/s\""));
  expect_in("rate_below", until("rate_below = \"0 m/s\""));
  expect_in("is no [[record]]; there are end, gap",
            refused("[[stages.until]]\nrecord = \"no\"\nabove = \"1 mm\""));
  const auto control = [&](const std::string& of, const std::string& rest,
                           const std::string& stiffness = "1 GN/m") {
    return refused("[stages.control]\nrecord = \"" + of + "\"\nrate = \"1 mm/s\"\nstiffness = \"" +
                   stiffness + "\"\nresponse_time = \"1 ms\"\n" + rest);
  };
  const std::string pull = does("right", "force = \"1 kN\"\ndirection = [1, 0]");
  EXPECT_EQ(control("gap", pull), kNone);
  expect_in("must be the name of a [[record]] of kind opening", control("end", pull));
  expect_in("must be the name of a [[record]] of kind opening", control("no", pull));
  expect_in("needs a force among the drives", control("gap", ""));
  expect_in("needs a force among the drives", control("gap", does("right", "pressure = \"1 MPa\"")));
  expect_in("stiffness", control("gap", pull, "0 N/m"));
  expect_in("look_interval",
            message(free_deck(kUniform + drive("duration = \"1 ms\"\nlook_interval = \"0 s\"", held))));
  expect_in("duration", message(free_deck(kUniform + drive("duration = \"0 s\"", held))));
}

}  // namespace
}  // namespace pyroclast::keys_test
