#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/stages/compress.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

// Promise: the load is what was asked for on both platens, whether as a stress or as a level.
TEST(LoadStage, BothPlatensCarryTheStressAskedFor) {
  const Finished a(deck(kUniform + kSettle + load("stress = \"6 MPa\"")));
  EXPECT_EQ(a.run.outcome(), Outcome::completed);
  // 1e-4: the platen's own weight is 1e-4 of it, the unbalanced ratio 1e-6
  EXPECT_NEAR(a.last("stress_top_MPa"), 6.0, 6.0 * 3e-4);
  EXPECT_NEAR(a.last("stress_bottom_MPa"), 6.0, 6.0 * 1e-3);  // with the weight of the specimen
  const Finished b(deck(kUniform + kSettle + load("level = 0.2\nf_c = \"30 MPa\"")));
  EXPECT_DOUBLE_EQ(a.last("strain"), b.last("strain"));
}

std::string compress(const std::string& until) {
  return "[[stages]]\nkind = \"compress\"\nvelocity = \"0.5 mm/s\"\nramp_time = \"20 ms\"\n" + until + "\n";
}

// Promise: a test that begins under a load has both platens at that load in its first point, so that its
// verdict and its modulus are those of the test.
TEST(CompressStage, BeginsAtTheLoadThatIsHeld) {
  const Finished r(deck(kUniform + kSettle + load("level = 0.5\nf_c = \"30 MPa\"") + heat("60 degC") +
                        kFailure + kControl));
  EXPECT_LT(r.result(3, "platen_difference_over_f_c_to_peak").value(), 0.05);
  const Finished free(deck(kUniform + kSettle + kFailure));
  EXPECT_NEAR(r.result(3, "f_c_MPa").value(), free.result(1, "f_c_MPa").value(),
              0.05 * free.result(1, "f_c_MPa").value());
}

// Promise: a load above the strength is told as a crushed specimen, with the stress it bore: not as rest, and
// not as steps that ran out.
TEST(LoadStage, ALoadAboveTheStrengthCrushes) {
  const Finished strong(deck(kUniform + kSettle + kFailure));
  const double strength = strong.result(1, "f_c_MPa").value();
  for (const double share : {1.5, 3.0}) {
    const Finished r(
        deck(kUniform + kSettle +
             with(load(fmt::format("level = {}\nf_c = \"{} MPa\"\nf_c_of = \"the same specimen\"", share,
                                   strength)),
                  "ramp_time = \"20 ms\"", fmt::format("ramp_time = \"{} ms\"", 400.0 * share))));
    EXPECT_EQ(r.run.outcome(), Outcome::crushed);
    const double borne = r.result(1, "largest_stress_MPa").value();
    EXPECT_GT(borne, 0.9 * strength);
    EXPECT_LT(borne, 1.2 * strength);  // inertia: the load rises to it within 0.4 s
    EXPECT_NE(r.report(1).lines.front().find("the same specimen"), std::string::npos);
    ASSERT_EQ(r.report(1).warnings.size(), 1u);
    EXPECT_EQ(std::ranges::count_if(r.setup.warnings,
                                    [](const Diagnostic& w) { return w.key == "stages[1].level"; }),
              1);
  }
}

// Promise: a force that follows a motion begins where the platens press, so that unloading throws nothing.
TEST(LoadStage, BeginsAtTheForceThatAMotionLeft) {
  const Finished r(deck(kUniform + kSettle + compress("stop_strain = 0.0002") + load("stress = \"0 MPa\"") +
                        compress("stop_strain = 0.0002")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(r.end_of(2, "strain"), 0.0, 2e-5);  // an elastic body is back
  EXPECT_NEAR(r.end_of(3, "stress_MPa"), r.end_of(1, "stress_MPa"), 0.03 * r.end_of(1, "stress_MPa"));
  EXPECT_LT(r.energy_error_over_turnover(), 1e-4);
}

// Promise: a compression goes to a stress or a strain, down or up; what it unloads has a modulus, and the
// ledger closes over the cycle.
TEST(CompressStage, UnloadsAndReloads) {
  const Finished r(deck(kUniform + kSettle + compress("to_stress = \"5 MPa\"") +
                        compress("to_stress = \"0 MPa\"") + compress("to_strain = 0.0003")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const double look = 0.3;  // MPa in a look
  EXPECT_NEAR(r.end_of(1, "stress_top_MPa"), 5.0, look);
  EXPECT_GE(r.end_of(1, "stress_top_MPa"), 5.0);
  EXPECT_NEAR(r.end_of(2, "stress_top_MPa"), 0.0, look);
  EXPECT_NEAR(r.end_of(2, "strain"), 0.0, 2e-5);
  EXPECT_NEAR(r.end_of(3, "strain"), 0.0003, 2e-5);
  EXPECT_NEAR(r.result(2, "E_unloading_GPa").value(), r.result(1, "E_GPa").value(),
              0.02 * r.result(1, "E_GPa").value());
  EXPECT_LT(r.energy_error_over_turnover(), 1e-4);
}

// Promise: what the results are read from does not depend on how often rows are written.
TEST(CompressStage, ResultsDoNotDependOnTheRowsOfTheHistory) {
  const std::string text = deck(kUniform + kSettle + kFailure);
  const Finished fine(text), coarse(with(text, "history_strain = 1e-5", "history_strain = 3e-4"));
  for (const auto* name : {"E_GPa", "f_c_MPa", "strain_at_peak", "strain_ic"}) {
    ASSERT_TRUE(fine.result(1, name)) << name;
    EXPECT_EQ(coarse.result(1, name), fine.result(1, name)) << name;
  }
}

// Promise: a stage that is to end at a share of f_c goes on until f_c is known.
TEST(CompressStage, EndsBehindItsPeak) {
  const Finished r(deck(kUniform + kSettle + kFailure + "stop_fraction_of_peak = 0.97\n"));
  EXPECT_EQ(r.run.outcome(), Outcome::stress_fallen);
  EXPECT_LT(r.last("stress_MPa"), 0.97 * r.result(1, "f_c_MPa").value());
  EXPECT_GE(r.last("stage_strain"), r.result(1, "strain_at_peak").value() + kStrengthRule.lasting);
}

// Promise: a fall that is no deeper than the precision with which exchanges leave the body ends no stage.
TEST(CompressStage, GoesOnWhereTheStressFallsWithinThePrecisionOfRest) {
  const Finished r(with(deck(kUniform + kSettle + kFailure + "stop_fraction_of_peak = 0.97\n"),
                        "platen_difference = \"20 kPa\"", "platen_difference = \"90 MPa\""));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_FALSE(r.result(1, "f_c_MPa"));
}

// Promise: what a blow brings before the wave has run through the body twice is no strength, and ends no
// stage.
TEST(CompressStage, ABlowIsNoStrength) {
  const Finished r(
      deck(kUniform + kSettle +
           with(with(kFailure, "1 mm/s", "200 mm/s"), "ramp_time = \"10 ms\"", "ramp_time = \"0 ms\"") +
           "stop_fraction_of_peak = 0.9\n"));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  ASSERT_EQ(r.report(1).warnings.size(), 1u);
  const std::string told =
      fmt::format("while the first stress wave still ran through the specimen ({:.3g} ms)",
                  2.0 * 1e3 * wave_time(*r.simulation));
  EXPECT_NE(r.report(1).warnings[0].find(told), std::string::npos) << r.report(1).warnings[0];
}

// Promise: a stress that the specimen cannot bear ends the run, which says so.
TEST(CompressStage, SaysWhenAStressIsNotReached) {
  const Finished r(
      deck(kUniform + kSettle + compress("to_stress = \"90 MPa\"\nstop_strain = 0.004") + kCompress));
  EXPECT_EQ(r.run.outcome(), Outcome::not_reached);
  EXPECT_EQ(r.run.courses()[2].outcome, Outcome::not_begun);
}

// Promise: a body that shrinks under nothing but its weight goes on resting on the lower platen; it does not
// hover where it shrank to.
TEST(HeatStage, ABodyThatShrinksStaysOnThePlaten) {
  const Finished r(deck(kUniform + kSettle + heat("320 degC") + heat("20 degC")));
  const double weight =
      2200.0 * 9.81 * 0.12 * 1e-6;  // MPa, of the specimen; the lower platen's is 0.29 of it
  for (std::size_t row = r.run.courses()[2].rows.first; row < r.run.history().row_count(); ++row)
    if (r.run.history().cell(row, "converged") == 1.0) {
      EXPECT_GT(*r.run.history().cell(row, "stress_bottom_MPa"), (0.79 + 0.29) * weight) << "row " << row;
    }
  EXPECT_EQ(r.result(2, "exchanges_not_converged"), 0);
  EXPECT_NEAR(r.last("specimen_strain"), 0.0, 1e-5);
  EXPECT_NEAR(r.last("strain"), 0.0, 1e-5);  // nor does the upper platen
  EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
}

// Promise: what comes back on cooling is told, by the deck already.
TEST(HeatStage, HealingIsSaid) {
  const auto healing = [](const std::string& stages) {
    const pyroclast::Setup setup = pyroclast::read(deck(kUniform + kSettle + stages));
    return std::ranges::count_if(setup.warnings, [](const Diagnostic& w) {
      return w.message.find("real concrete does not heal") != std::string::npos;
    });
  };
  EXPECT_EQ(healing(heat("320 degC")), 0);
  EXPECT_EQ(healing(heat("320 degC") + heat("20 degC")), 1);
}

// Promise: E stays that of the hottest, in zones and contacts, and the thermal strain goes back.
TEST(HeatStage, WhatHeatTookStaysGoneOnCooling) {
  const std::string text =
      with(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC") + heat("20 degC")),
           "reversible", "irreversible");
  for (const Diagnostic& warning : pyroclast::read(text).warnings)
    EXPECT_EQ(warning.message.find("does not heal"), std::string::npos);
  const Finished r(text);
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const double softening = 1.0 - 0.8 * 300.0 / 800.0;  // E(320) / E(20)
  EXPECT_NEAR(r.last("strain"), r.end_of(1, "strain") / softening, 0.02 * r.end_of(1, "strain"));
  EXPECT_NEAR(r.end_of(2, "strain") + 3e-3, r.last("strain"), 0.01 * r.last("strain"));
  const auto blocks = zone_blocks(r.simulation->model());
  for (std::size_t z = 0; z < blocks.size(); ++z)
    if (!r.simulation->model().is_of_bearing(blocks[z])) {
      const double mu = r.simulation->motion().read().properties_of_zone(static_cast<int>(z)).mu;
      EXPECT_DOUBLE_EQ(mu, 0.5 * softening * 29.4e9 / 1.2);
    }
}

// Promise: an even body of one expansion expands by alpha dT in both directions and stays sound; the energy
// ledger closes.
TEST(HeatStageVerification, AnEvenBodyExpandsFreely) {
  const Finished r(deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_DOUBLE_EQ(r.last("temperature_degC"), 220.0);
  EXPECT_NEAR(r.last("heating_time_s"), 200.0 / (5.0 / 60.0), 1e-9);
  const double softening = 1.0 - 0.8 * 200.0 / 800.0;
  const double loaded = r.end_of(1, "specimen_strain") / softening;
  EXPECT_NEAR(r.last("specimen_strain"), loaded - 2e-3, 1e-5);  // 0.5 % of the expansion: what motion is left
  // and Poisson's part of the load
  expect_known({"Lateral strain of an even body that is heated under a small load", "alpha dT", "1"},
               r.last("lateral_strain"), 2e-3, 1e-5);
  EXPECT_EQ(r.last("tension_mortar_mortar_damaged"), 0);
  EXPECT_EQ(r.result(2, "exchanges"), 40);
  EXPECT_EQ(r.result(2, "exchanges_not_converged"), 0);
  EXPECT_FALSE(r.result(2, "critical_temperature_degC"));
  EXPECT_LT(r.energy_error_over_turnover(), 1e-6);
}

// Promise: cooled down again, an elastic body is where it was.
TEST(HeatStage, CoolingBringsAnElasticBodyBack) {
  const Finished r(
      deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC") + heat("20 degC")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(r.last("strain"), r.end_of(1, "strain"), 1e-6);
  EXPECT_NEAR(1e6 * r.last("stress_top_MPa"), 3e6,
              2e4);  // the difference between platens that counts as rest
}

// Promise: a modulus that falls adds strain under a constant load (total form, physics of the zones).
TEST(HeatStageVerification, ALoadedBodyShortensAsItSoftens) {
  const Finished r(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("420 degC")));
  const double softening = 1.0 - 0.8 * 400.0 / 800.0;  // E(420) / E(20)
  expect_known({"Strain of a loaded specimen that softens, without its expansion",
                "strain at 20 degC over E(T) / E", "1"},
               r.last("strain") + 4e-3, r.end_of(1, "strain") / softening, 0.02 * r.end_of(1, "strain"));
}

// Promise: between fixed platens the thrust is that of the thermal strain, less what the platens give, E as
// measured at 20 degC.
TEST(HeatStageVerification, FixedPlatensTakeTheThrust) {
  const Finished measured(deck(kUniform + kSettle + load("stress = \"1 MPa\"")));
  const double young = 1e6 / measured.last("strain");
  const Finished r(deck(kUniform + kSettle + heat("70 degC", "fixed")));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const double expected = young * (1.0 - 0.8 * 50.0 / 800.0) * (5e-4 + r.last("strain"));
  expect_known({"Thrust of a heated specimen between fixed platens", "E(T) (alpha dT + strain)", "Pa"},
               1e6 * r.last("stress_top_MPa"), expected, 0.005 * expected);
  EXPECT_NEAR(r.last("strain"), 0.0, 0.02 * 5e-4);
}

// Promise: a load above the strength that is left is found: the platen runs away, and where is told.
TEST(HeatStage, ASpecimenThatIsTooWeakRunsAway) {
  const Finished r(deck(kUniform + kSettle + load("stress = \"15 MPa\"") + heat("820 degC")));
  EXPECT_EQ(r.run.outcome(), Outcome::ran_away);
  const auto critical = r.result(2, "critical_temperature_degC");
  ASSERT_TRUE(critical);
  EXPECT_EQ(*critical, r.last("temperature_degC"));
  EXPECT_GT(*critical, 200.0);
  EXPECT_LT(*critical, 700.0);
  EXPECT_DOUBLE_EQ(r.result(2, "load_stress_MPa").value(), 15.0);
}

// Promise: an exchange that does not come to rest within its cycles is flagged.
TEST(HeatStage, AnExchangeThatIsCutShortIsFlagged) {
  const Finished r(with(deck(kUniform + kSettle + heat("120 degC"), "\"3e-5 1/K\""), "most_cycles = 5000",
                        "most_cycles = 60"));
  EXPECT_EQ(r.result(1, "exchanges_not_converged"), 20);
  EXPECT_EQ(r.result(1, "cycles"), 1200);
  EXPECT_GT(r.result(1, "worst_unbalanced_ratio"), 1e-5);
}

// Promise: strain of a compression after heating counts from its own beginning, so that the modulus is that
// of the hot body.
TEST(CompressStage, AfterHeatingMeasuresTheHotModulus) {
  const Finished cold(deck(kUniform + kSettle + kCompress));
  const Finished hot(deck(kUniform + kSettle + load("stress = \"0.2 MPa\"") + heat("420 degC") + kCompress));
  const auto a = cold.result(1, "E_GPa"), b = hot.result(3, "E_GPa");
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(*b / *a, 0.6, 0.02);
  EXPECT_NEAR(hot.last("stage_strain"), 0.0002, 2e-5);
}

const std::string kPredictor = "least_cycles = 50\npredictor = true";

// Promise: the predictor changes how a body gets to its new size, not which size: an even body under load
// expands by alpha dT and softens as without it, in fewer cycles, and the energy ledger closes.
TEST(Predictor, BringsABodyToTheSameStateInFewerCycles) {
  const std::string text = deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC"));
  const Finished plain(text);
  const Finished predicted(with(text, "least_cycles = 50", kPredictor));
  EXPECT_EQ(predicted.run.outcome(), Outcome::completed);
  EXPECT_NEAR(predicted.last("specimen_strain"), plain.last("specimen_strain"),
              1e-5);  // motion left in `plain`
  EXPECT_NEAR(predicted.last("lateral_strain"), plain.last("lateral_strain"), 1e-5);
  EXPECT_EQ(predicted.result(2, "exchanges_not_converged"), 0);
  EXPECT_LT(predicted.result(2, "cycles").value(), plain.result(2, "cycles").value());
  EXPECT_LT(predicted.energy_error_over_turnover(), 1e-6);
}

// Promise: it does so for increments of a fraction of a kelvin too.
TEST(Predictor, ForetellsSmallIncrements) {
  const std::string text = with(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("30 degC")),
                                "exchange_increment = \"5 K\"", "exchange_increment = \"0.5 K\"");
  const Finished plain(text);
  const Finished predicted(with(text, "least_cycles = 50", kPredictor));
  EXPECT_EQ(predicted.result(2, "exchanges"), 20);
  EXPECT_LT(predicted.result(2, "cycles").value(), 0.8 * plain.result(2, "cycles").value());
}

// Promise: cooled down again with the predictor, an elastic body is where it was.
TEST(Predictor, CoolingBringsAnElasticBodyBack) {
  const Finished r(
      with(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC") + heat("20 degC")),
           "least_cycles = 50", kPredictor));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(r.last("strain"), r.end_of(1, "strain"), 1e-6);
}

// Promise: the predictor leaves fixed platens where they are.
TEST(Predictor, FixedPlatensTakeTheThrust) {
  const std::string text = deck(kUniform + kSettle + heat("70 degC", "fixed"));
  const Finished plain(text);
  const Finished predicted(with(text, "least_cycles = 50", kPredictor));
  EXPECT_NEAR(predicted.last("stress_top_MPa"), plain.last("stress_top_MPa"),
              0.01 * plain.last("stress_top_MPa"));
  EXPECT_NEAR(predicted.last("strain"), 0.0, 0.02 * 5e-4);  // but for the platens' own give
}

// Promise: a controlled velocity finds the modulus and the strength of the slow test in fewer steps, and is
// quasi-static up to the peak.
TEST(CompressStage, AControlledVelocityFindsTheSlowStrengthInFewerSteps) {
  const Finished slow(deck(kUniform + kSettle + kFailure));
  const Finished fast(deck(kUniform + kSettle + kFailure + kControl));
  const auto modulus = slow.result(1, "E_GPa"), strength = slow.result(1, "f_c_MPa");
  ASSERT_TRUE(modulus && strength);
  EXPECT_NEAR(fast.result(1, "E_GPa").value(), *modulus, 0.005 * *modulus);
  // a brittle body of 60 blocks: one crack more or less
  EXPECT_NEAR(fast.result(1, "f_c_MPa").value(), *strength, 0.02 * *strength);
  EXPECT_LT(fast.last("step"), slow.last("step") / 2);
  EXPECT_EQ(fast.result(1, "quasi_static"), 1.0);
  EXPECT_LT(fast.energy_error_over_turnover(), 5e-3);
}

// Promise: the controlled velocity stays between its bounds, whatever the tolerances.
TEST(CompressStage, AControlledVelocityStaysWithinItsBounds) {
  for (const auto* tolerance : {"unbalanced_ratio = 1e-12", "unbalanced_ratio = 1"}) {
    const Finished r(deck(kUniform + kSettle + with(kFailure, "0.004", "0.0005") +
                          with(kControl, "unbalanced_ratio = 2e-4", tolerance)));
    const RowRange rows = r.run.courses()[1].rows;
    const auto strain = r.run.history().values("strain", rows), time = r.run.history().values("time_s", rows),
               stage_strain = r.run.history().values("stage_strain", rows);
    for (std::size_t i = 1; i < strain.size(); ++i) {
      if (stage_strain[i] < 1e-4) continue;  // past the ramp
      // the platens' faces give a little less than their outer sides are driven
      const double velocity = (strain[i] - strain[i - 1]) * 0.12 / (time[i] - time[i - 1]);
      EXPECT_GT(velocity, 0.9e-3);
      EXPECT_LT(velocity, 10.5e-3);
    }
  }
}

// Promise: frames come at the stated steps of temperature, and at the end.
TEST(Frames, ComeAtStepsOfTemperature) {
  const Finished r(with(deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC")),
                        "frame_strain = 1e-3", "frame_strain = 1e-3\nframe_temperature = \"50 K\""));
  const std::vector<double> expected{20, 20, 20, 50, 100, 150, 200, 220};
  ASSERT_EQ(r.frames.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(r.frames[i], expected[i]);
}

// Promise: with conduction the mechanics gets the computed field: a prism heated on one side bends that way,
// and temperatures differ over it.
TEST(ExposeStage, HeatsOneSideMoreThanTheOther) {
  const Finished r(with(deck(kSettle + kExpose + kHeatedFace), "most_cycles = 5000", "most_cycles = 2000"));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(r.last("heating_time_s"), 360.0, 1e-6);
  EXPECT_NEAR(r.last("temperature_max_degC"), 70.0, 0.1);
  EXPECT_LT(r.last("temperature_min_degC"), 69.9);
  EXPECT_GT(r.last("temperature_degC"), r.last("temperature_min_degC"));
  // 5 %: what motion is left, and the weight
  EXPECT_NEAR(r.last("lateral_strain"), 1e-5 * (r.last("temperature_degC") - 20.0), 2.5e-5);
}

// Promise: each compression of a run is a test of its own: with its own modulus and strength, from its own
// rows.
TEST(CompressStage, TwoOfThemAreReportedEachByItself) {
  const std::string unload = compress("to_stress = \"0 MPa\"");
  const Finished one(deck(kUniform + kSettle + kFailure));
  const Finished two(deck(kUniform + kSettle + kFailure + unload + kFailure));
  for (const auto* name : {"E_GPa", "f_c_MPa", "strain_at_peak"}) {
    ASSERT_TRUE(one.result(1, name)) << name;
    EXPECT_EQ(two.result(1, name), one.result(1, name)) << name;
  }
  // broken by the first, it is softer, and its blocks slide without another peak
  ASSERT_TRUE(two.result(3, "E_GPa"));
  EXPECT_LT(two.result(3, "E_GPa").value(), 0.9 * two.result(1, "E_GPa").value());
  EXPECT_FALSE(two.result(3, "f_c_MPa"));
}

// Promise: what contradicts itself is refused at its line.
TEST(Stages, ContradictionsAreRefused) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const DeckError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(deck(kUniform + kSettle + heat("120 degC"))), "");
  EXPECT_NE(message(deck(kUniform + kSettle + heat("920 degC"))).find("820"), std::string::npos);
  EXPECT_EQ(message(deck(kUniform + kSettle + kFailure + kControl)), "");
  EXPECT_NE(message(deck(kUniform + kSettle + with(kFailure, "1 mm/s", "20 mm/s") + kControl))
                .find("must not be less than velocity"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + with(kFailure, "10 ms", "0 s") + kControl)).find("ramp_time"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + kFailure + "unbalanced_ratio = 1e-4\n")).find("has no effect"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + load("level = 0.2\nf_c = \"30 MPa\"\nstress = \"6 MPa\"")))
                .find("either stress, or level"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + kExpose)).find("conduction"), std::string::npos);
  EXPECT_NE(message(with(deck(kSettle + kExpose), "least_cycles = 50", kPredictor)).find("uniform"),
            std::string::npos);
}

// Promise: a load stage is not over before all of the load is on, however soon the body rests; also where the
// ramp is a whole number of steps.
TEST(LoadStage, EndsWithAllOfItsLoad) {
  for (const char* ramp : {"20 ms", "19.9 ms", "7 ms", "1 ms", "0 ms"}) {
    std::string text = deck(kUniform + kSettle + load("stress = \"3 MPa\""));
    const auto stage = text.rfind("ramp_time = \"20 ms\"\nunbalanced_ratio = 1e-6");
    text.replace(stage, std::string("ramp_time = \"20 ms\"\nunbalanced_ratio = 1e-6").size(),
                 std::string("ramp_time = \"") + ramp + "\"\nunbalanced_ratio = 1000");
    const Finished run(text);
    EXPECT_EQ(run.run.outcome(), Outcome::completed);
    EXPECT_NEAR(run.simulation->press().stress_held(), 3e6, 1e-6) << ramp;  // rounding of 3e6 Pa
  }
}

}  // namespace
}  // namespace pyroclast
