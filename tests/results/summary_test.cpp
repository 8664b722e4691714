#include "pyroclast/results/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stages/small_runs.hpp"

/// What declares the numbers of a run meaningless, by histories that are made by hand.
namespace pyroclast::summary_test {
namespace {

using nlohmann::json;

/// A finished run. Its history is of the test's own making where that says so; the rest is what it measured.
struct Made : Finished {
  using Finished::Finished;

  /// Puts a value into a column at some rows, or takes what is there away.
  void put(RowRange rows, std::string_view column, std::optional<double> value) {
    History made;
    const History& measured = run.history();
    for (const Column& c : measured.columns()) made.add_column(c);
    for (std::size_t row = 0; row < measured.row_count(); ++row) {
      auto cells = measured.row(row);
      if (rows.first <= row && row < rows.last) cells.at(measured.index(column)) = value;
      made.add_row(std::move(cells));
    }
    const_cast<History&>(measured) = std::move(made);
  }
  void put(std::string_view column, std::optional<double> value) {
    put({0, run.history().row_count()}, column, value);
  }
  RowRange rows_of(int stage) const { return run.courses().at(stage).rows; }

  /// A ledger in which 10 J were turned over, of which the sum with signs is -2 J.
  void turn_over_ten_joules() {
    put("energy_loading_J", 3.0);
    put("energy_gravity_J", -2.0);
    put("energy_property_change_J", -4.0);
    put("energy_mass_scaling_J", 1.0);
  }
  /// What contacts dissipated in all.
  void dissipate(double energy) {
    const auto names = simulation->motion().dissipations();
    for (const auto& name : names)
      put("dissipated_" + std::string(name) + "_J", energy / static_cast<double>(names.size()));
  }
  Summary summary() const { return summarize(run); }
  json as_json() const { return json::parse(summary_text(summary(), run)); }
};

const std::string kTwoTests = kUniform + kSettle + kCompress + kCompress;

/// Three stages: settle, compress, compress.
Made tests() {
  return Made(deck(kTwoTests));
}

/// How many of the warnings have these words.
std::ptrdiff_t count_of(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::count_if(warnings, [&](const auto& w) { return w.find(words) != std::string::npos; });
}

const std::string kOfTurnover = "of the energy turned over";
const std::string kOfDissipated = "of the energy that contacts dissipated";

// ---- The energy ledger -----------------------------------------------------------------------------------

// Promise: what was turned over is the sum of the sizes of what was put in; parts of opposite sign do not
// cancel.
TEST(EnergyLedger, TheErrorIsJudgedByTheSizesOfWhatWasPutIn) {
  Made r = tests();
  r.turn_over_ten_joules();
  r.put("energy_error_J", 0.02);
  EXPECT_DOUBLE_EQ(r.summary().soundness.energy_error.value(), 0.002);
  r.put("energy_error_J", -0.02);
  EXPECT_DOUBLE_EQ(r.summary().soundness.energy_error.value(), -0.002);
  r.put("energy_mass_scaling_J", std::nullopt);  // what is not there is nothing
  r.put("energy_error_J", 0.018);
  EXPECT_DOUBLE_EQ(r.summary().soundness.energy_error.value(), 0.002);
  for (const char* part :
       {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"}) {
    Made alone = tests();
    for (const char* other :
         {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
      alone.put(other, other == std::string(part) ? -4.0 : 0.0);
    alone.put("energy_error_J", 0.01);
    EXPECT_DOUBLE_EQ(alone.summary().soundness.energy_error.value(), 0.0025) << part;
  }
}

// Promise: little energy is energy too, put in or dissipated.
TEST(EnergyLedger, LittleEnergyIsJudgedToo) {
  Made r = tests();
  for (const char* part :
       {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
    r.put(part, 1e-4);
  r.dissipate(1e-5);
  r.put("energy_error_J", 1e-6);
  EXPECT_NEAR(r.summary().soundness.energy_error.value(), 2.5e-3, 1e-12);
  EXPECT_NEAR(r.summary().soundness.error_over_dissipated.value(), 0.1, 1e-9);
}

// Promise: where nothing was turned over, nothing can be missing; where nothing was measured, nothing is
// said.
TEST(EnergyLedger, NothingTurnedOverHasNoError) {
  Made r = tests();
  for (const char* part :
       {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
    r.put(part, 0.0);
  r.put("energy_error_J", 1.0);
  EXPECT_EQ(r.summary().soundness.energy_error, 0.0);
  r.put("energy_error_J", std::nullopt);
  EXPECT_EQ(r.summary().soundness.energy_error, std::nullopt);
  EXPECT_EQ(r.summary().soundness.error_over_dissipated, std::nullopt);
  EXPECT_TRUE(r.as_json()["energy_J"]["error_over_turnover"].is_null());
}

// Promise: the last value that is there counts, of whatever stage.
TEST(EnergyLedger, TheLastValueCounts) {
  Made r = tests();
  r.turn_over_ten_joules();
  r.put("energy_error_J", 0.03);
  const std::size_t end = r.run.history().row_count();
  r.put({end - 2, end - 1}, "energy_error_J", 0.02);
  r.put({end - 1, end}, "energy_error_J", std::nullopt);
  EXPECT_DOUBLE_EQ(r.summary().soundness.energy_error.value(), 0.002);
  r.put({end - 1, end}, "energy_error_J", 0.01);
  EXPECT_DOUBLE_EQ(r.summary().soundness.energy_error.value(), 0.001);
}

// Promise: a ledger that closes within 0.5 % of the turnover is sound, of either sign; beyond is a warning
// with the number, but results stay.
TEST(EnergyLedger, HalfAPercentOfTheTurnoverIsTheBoundOfAWarning) {
  Made r = tests();
  r.turn_over_ten_joules();
  r.dissipate(0.0);
  for (const double sign : {1.0, -1.0}) {
    for (const double within : {0.0499, 0.05}) {
      r.put("energy_error_J", sign * within);
      EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
    }
    r.put("energy_error_J", sign * 0.0501);
    const Summary s = r.summary();
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_EQ(s.warnings[0].find("the energy ledger closes only within "), 0u);
    EXPECT_EQ(count_of(s.warnings, "0.50 % " + kOfTurnover), 1);
    EXPECT_TRUE(s.is_sound());
    EXPECT_EQ(r.as_json()["is_good"], true);
  }
}

/// Whether a stage has a modulus, or none since its ledger does not close.
bool has_results(const Summary& s, int stage) {
  const StageReport& report = s.stages.at(stage).report;
  const auto named = [&](const char* name) { return std::ranges::find(report.results, name, &Result::name); };
  const bool has_none = std::ranges::all_of(report.results, [](const Result& result) {
    return result.name == "none_because" || std::holds_alternative<std::monostate>(result.value);
  });
  EXPECT_EQ(has_none, named("none_because") != report.results.end());
  EXPECT_EQ(has_none, count_of(report.warnings, "this stage has no results: the energy ledger closes") == 1);
  EXPECT_EQ(has_none, count_of(report.lines, "no results, because the energy ledger closes only") == 1);
  return !has_none;
}

// Promise: within 5 % of the turnover a stage keeps its results; beyond it has none, says why, and the run is
// no good.
TEST(EnergyLedger, FivePercentOfTheTurnoverIsTheBoundOfResults) {
  Made r = tests();
  r.turn_over_ten_joules();
  for (const double sign : {1.0, -1.0}) {
    r.put("energy_error_J", sign * 0.5);
    EXPECT_TRUE(r.summary().is_sound());
    r.put("energy_error_J", sign * 0.499);
    EXPECT_TRUE(r.summary().is_sound());
    for (int stage : {0, 1, 2}) EXPECT_TRUE(has_results(r.summary(), stage));
    EXPECT_EQ(r.as_json()["is_good"], true);
    r.put("energy_error_J", sign * 0.512);
    const Summary s = r.summary();
    EXPECT_FALSE(s.is_sound());
    for (int stage : {0, 1, 2}) EXPECT_FALSE(has_results(s, stage));
    EXPECT_EQ(s.stages[1].report.warnings.size(), 1u);
    EXPECT_EQ(count_of(s.stages[1].report.warnings, "only within 5.12 % of the energy turned over;"), 1);
    const json told = r.as_json();
    EXPECT_EQ(told["is_good"], false);
    EXPECT_TRUE(told["stages"][1]["results"]["E_GPa"].is_null());
    EXPECT_EQ(told["stages"][1]["results"]["none_because"],
              "the energy ledger closes only within 5.12 % of the energy turned over");
  }
}

// Promise: a stage is judged by the ledger as it stood at its end, not by that of the whole run.
TEST(EnergyLedger, AStageIsJudgedByItsOwnPart) {
  Made later = tests();
  later.turn_over_ten_joules();
  later.put("energy_error_J", 0.0);
  later.put(later.rows_of(2), "energy_error_J", 0.6);
  EXPECT_TRUE(has_results(later.summary(), 0));
  EXPECT_TRUE(has_results(later.summary(), 1));
  EXPECT_FALSE(has_results(later.summary(), 2));
  EXPECT_FALSE(later.summary().is_sound());
  // what the last stage turns over does not make good what the first one lost
  Made first = tests();
  first.turn_over_ten_joules();
  first.put("energy_error_J", 0.6);
  first.put(first.rows_of(2), "energy_loading_J", 1000.0);
  EXPECT_FALSE(has_results(first.summary(), 1));
  EXPECT_TRUE(has_results(first.summary(), 2));
  EXPECT_FALSE(first.summary().is_sound());
  // the last row of a stage is its end
  Made at_the_end = tests();
  at_the_end.turn_over_ten_joules();
  at_the_end.put("energy_error_J", 0.0);
  const std::size_t end = at_the_end.rows_of(1).last;
  at_the_end.put({end - 1, end}, "energy_error_J", 0.6);
  EXPECT_FALSE(has_results(at_the_end.summary(), 1));
  EXPECT_TRUE(has_results(at_the_end.summary(), 2));
}

// ---- Strengths of several stages
// ---------------------------------------------------------------------------

// Promise: a strength above that at which the specimen failed before is told as hardening, and is in doubt;
// one below it, or after a stage that found none, is not.
TEST(Strengths, AFailedSpecimenHasNoGreaterOne) {
  const auto warnings = [](const std::vector<Result::Value>& strengths) {
    Summary summary;
    for (const Result::Value& strength : strengths) {
      summary.stages.push_back({"compress", Outcome::completed, {}});
      summary.stages.back().report.results = {{kStrength, strength}, doubt_of(kStrength, {})};
    }
    warn_of_hardening(summary.stages);
    std::vector<std::size_t> counts;
    for (const auto& stage : summary.stages) {
      const auto& told = stage.report.warnings;
      counts.push_back(told.size());
      EXPECT_EQ(stage.report.results[1].value, told.empty() ? Result::Value() : Result::Value(told.back()));
    }
    return counts;
  };
  using Counts = std::vector<std::size_t>;
  const Result::Value none;
  EXPECT_EQ(warnings({27.9, none, 33.4}), (Counts{0, 0, 1}));
  EXPECT_EQ(warnings({27.9, 20.0, 25.0}), (Counts{0, 0, 0}));
  EXPECT_EQ(warnings({none, 33.4}), (Counts{0, 0}));
  EXPECT_EQ(warnings({27.9, 30.0, 29.0}), (Counts{0, 1, 0}));
}

// ---- What contacts dissipated ----------------------------------------------------------------------------

// Promise: within 1 % of what contacts dissipated the ledger is sound, of either sign; beyond is a warning,
// whose advice names only what the deck can change.
TEST(EnergyLedger, OnePercentOfTheDissipatedIsTheBoundOfAWarning) {
  Made r = tests();
  r.turn_over_ten_joules();
  r.dissipate(2.0);
  for (const double sign : {1.0, -1.0}) {
    r.put("energy_error_J", sign * 0.0199);
    EXPECT_DOUBLE_EQ(r.summary().soundness.error_over_dissipated.value(), sign * 0.00995);
    EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
    r.put("energy_error_J", sign * 0.02);
    EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
    r.put("energy_error_J", sign * 0.0202);
    const Summary s = r.summary();
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_EQ(s.warnings[0],
              "the energy ledger closes only within 1 % of the energy that contacts dissipated, not within 1 "
              "%: a lower "
              "mechanics.safety leaves less");
    EXPECT_TRUE(s.is_sound());
  }
  r.put("energy_error_J", 0.04);
  EXPECT_EQ(count_of(r.summary().warnings,
                     "only within 2 % of the energy that contacts dissipated, not within 1 %"),
            1);
}

// Promise: an error that is rounding beside the turnover is none, however little contacts dissipated; and
// where they dissipated nothing, or what is rounding beside the turnover, there is no share of it.
TEST(EnergyLedger, RoundingIsNoShareOfTheDissipated) {
  Made r = tests();
  r.turn_over_ten_joules();
  r.dissipate(2e-5);
  r.put("energy_error_J", -0.99e-5);
  EXPECT_EQ(r.summary().soundness.error_over_dissipated, 0.0);
  r.put("energy_error_J", -1.01e-5);
  EXPECT_NEAR(r.summary().soundness.error_over_dissipated.value(), -0.505, 1e-9);
  EXPECT_EQ(count_of(r.summary().warnings, kOfDissipated), 1);
  // of several losses one that is not there is nothing
  const auto losses = r.simulation->motion().dissipations();
  ASSERT_GE(losses.size(), 2u);
  r.dissipate(2.0 * static_cast<double>(losses.size()));
  r.put("dissipated_" + std::string(losses[0]) + "_J", std::nullopt);
  r.put("energy_error_J", 0.02);
  EXPECT_DOUBLE_EQ(r.summary().soundness.error_over_dissipated.value(),
                   0.01 / static_cast<double>(losses.size() - 1));
  r.put("energy_error_J", -1.01e-5);
  for (const double rounding : {0.0, 0.99e-5}) {
    r.dissipate(rounding);
    EXPECT_EQ(r.summary().soundness.error_over_dissipated, std::nullopt);
    EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
  }
  r.put("energy_error_J", std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(r.summary().soundness.error_over_dissipated, std::nullopt);
  r.dissipate(1.01e-5);  // a millionth of the turnover is 1e-5
  r.put("energy_error_J", -2e-5);
  EXPECT_NEAR(r.summary().soundness.error_over_dissipated.value(), -2.0 / 1.01, 1e-9);
  // just a millionth, of 1 J
  for (const char* part : {"energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
    r.put(part, 0.0);
  r.put("energy_loading_J", 1.0);
  r.put("energy_error_J", 1e-6);
  EXPECT_EQ(r.summary().soundness.error_over_dissipated, 0.0);
  r.dissipate(0.0);
  r.put("dissipated_" + std::string(losses[0]) + "_J", 1e-6);
  r.put("energy_error_J", 1e-3);
  EXPECT_EQ(r.summary().soundness.error_over_dissipated, std::nullopt);
}

// ---- Exchanges of temperatures ---------------------------------------------------------------------------

/// A body of one expansion whose face is heated, 20 to 70 degC, and whose contacts weaken.
std::string heated(const std::string& ratio) {
  return with(with(deck(kSettle + kExpose + kHeatedFace), "[[\"20 degC\", 1], [\"820 degC\", 0.1]]", ratio),
              "most_cycles = 5000", "most_cycles = 60");
}

const std::string kTooLarge = "exchanges of temperatures are too large";

/// Returns the mean stress of an exchange of 5 K over the strength, by hand, at ten temperatures.
template <class Strain>
double mean_stress(const Made& r, double low, double high, double strength, Strain strain_per_kelvin) {
  double sum = 0.0;
  for (int i = 1; i <= 10; ++i) {
    const double step = (high - low) / 10.0, to = low + i * step;
    sum += estimate_modulus(r.simulation->model(), r.simulation->materials(), to) *
           strain_per_kelvin(to - step, to) * 5.0;
  }
  return sum / 10.0 / strength;
}

double even_expansion(double, double) {
  return 1e-5;
}

// Promise: a held body takes up E alpha dT at once; told is the mean of that between the coldest and the
// hottest of the stage, over the tensile strength at the coldest.
TEST(ExchangeStress, IsThatOfAHeldBodyOverItsStrength) {
  Made r(heated("[[\"20 degC\", 1], [\"25 degC\", 1], [\"30 degC\", 0.5], [\"820 degC\", 0.5]]"));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  const auto told = [&] { return r.summary().soundness.exchange_stress.value(); };
  const auto expected = [&](double low, double high, double strength) {
    return mean_stress(r, low, high, strength, even_expansion);
  };
  r.put("temperature_min_degC", 20.0);
  r.put("temperature_max_degC", 70.0);
  EXPECT_NEAR(told(), expected(20.0, 70.0, 2.5e6), 1e-9);
  EXPECT_EQ(count_of(r.summary().warnings, kTooLarge), 0);
  // the hottest of any row counts, and so does the coldest
  r.put("temperature_max_degC", 45.0);
  const RowRange rows = r.rows_of(1);
  r.put({rows.first, rows.first + 1}, "temperature_max_degC", 120.0);
  EXPECT_NEAR(told(), expected(20.0, 120.0, 2.5e6), 1e-9);
  r.put("temperature_max_degC", 75.0);
  r.put("temperature_min_degC", 40.0);
  r.put({rows.last - 1, rows.last}, "temperature_min_degC", 35.0);
  EXPECT_NEAR(told(), expected(35.0, 75.0, 1.25e6), 1e-9);
  // rows of other stages do not count
  r.put("temperature_min_degC", 20.0);
  r.put("temperature_max_degC", 70.0);
  r.put(r.rows_of(0), "temperature_max_degC", 500.0);
  r.put({0, r.rows_of(0).first}, "temperature_max_degC", 500.0);
  EXPECT_NEAR(told(), expected(20.0, 70.0, 2.5e6), 1e-9);
  EXPECT_DOUBLE_EQ(r.as_json()["exchange_stress_over_strength"], told());
}

// Promise: contacts whose strength is gone dissipate hardly anything, so they bring no warning: what an
// exchange does there changes no result (docs/understand/theory.md).
TEST(ExchangeStress, StrengthThatIsGoneDoesNotCount) {
  const auto of = [](const std::string& ratio) {
    Made r(heated(ratio));
    r.put("temperature_min_degC", 20.0);
    r.put("temperature_max_degC", 70.0);
    return r.summary().soundness.exchange_stress.value();
  };
  EXPECT_DOUBLE_EQ(of("[[\"20 degC\", 1], [\"60 degC\", 0.01], [\"820 degC\", 0.01]]"),
                   of("[[\"20 degC\", 1], [\"820 degC\", 1]]"));
}

// Promise: where all temperatures are the same, no exchange strains anything.
TEST(ExchangeStress, ThereIsNoneAtOneTemperature) {
  Made r(heated("[[\"20 degC\", 1], [\"820 degC\", 1]]"));
  r.put("temperature_min_degC", r.simulation->field().mean());
  r.put("temperature_max_degC", r.simulation->field().mean());
  EXPECT_EQ(r.summary().soundness.exchange_stress, std::nullopt);
}

// Promise: every stage counts, the first one too.
TEST(ExchangeStress, TheFirstStageCounts) {
  const Made r(with(deck(kExpose + kHeatedFace), "most_cycles = 5000", "most_cycles = 60"));
  EXPECT_GT(r.summary().soundness.exchange_stress.value(), 0.0);
}

// Promise: of several stages the one with the largest exchanges counts, whichever it is.
TEST(ExchangeStress, TheLargestOfAllStagesCounts) {
  const auto of = [](const std::string& first, const std::string& second) {
    const auto stage = [](const std::string& increment) {
      return with(kExpose, "6 min", "1 min") +
             "[stages.coupling]\nmost_cycles = 60\nexchange_increment = \"" + increment + "\"\n";
    };
    Made r(deck(kSettle + stage(first) + stage(second) + kHeatedFace));
    r.put("temperature_min_degC", 20.0);
    r.put("temperature_max_degC", 70.0);
    return r.summary().soundness.exchange_stress.value();
  };
  const double small = of("2 K", "2 K");
  EXPECT_NEAR(of("2 K", "6 K"), 3.0 * small, 1e-9);
  EXPECT_NEAR(of("6 K", "2 K"), 3.0 * small, 1e-9);
}

// Promise: where expansion grows with the temperature, each part of the way is judged by its own.
TEST(ExchangeStress, EachPartOfTheWayHasItsOwnExpansion) {
  const std::string bent =
      "{ table = [[\"20 degC\", \"1e-5 1/K\"], [\"45 degC\", \"1e-5 1/K\"], [\"50 degC\", \"3e-5 1/K\"], "
      "[\"820 degC\", \"3e-5 1/K\"]] }";
  std::string text = with(deck(kSettle + kExpose + kHeatedFace, bent),
                          "[[\"20 degC\", 1], [\"820 degC\", 0.1]]", "[[\"20 degC\", 1], [\"820 degC\", 1]]");
  Made r(with(text, "most_cycles = 5000", "most_cycles = 60"));
  r.put("temperature_min_degC", 20.0);
  r.put("temperature_max_degC", 70.0);
  const auto largest = [&](double from, double to) {
    double strain = 0.0;
    for (const BlockMaterial& material : r.simulation->materials().block_materials)
      if (!material.is_of_bearing)
        strain =
            std::max(strain, (material.thermal_strain(to) - material.thermal_strain(from)) / (to - from));
    return strain;
  };
  const double expected = mean_stress(r, 20.0, 70.0, 2.5e6, largest);
  EXPECT_NEAR(r.summary().soundness.exchange_stress.value(), expected, 1e-9 * expected);
  // half as much again as that of the even body, at least
  EXPECT_GT(expected, 1.5 * mean_stress(r, 20.0, 70.0, 2.5e6, even_expansion));
}

// Promise: up to the strength an exchange is small enough; beyond it is told.
TEST(ExchangeStress, IsTooLargeFromTheStrengthOn) {
  const auto at = [](double increment) {
    Made r(with(heated("[[\"20 degC\", 1], [\"820 degC\", 1]]"), "exchange_increment = \"5 K\"",
                "exchange_increment = \"" + std::to_string(increment) + " K\""));
    return r.summary();
  };
  const double at_five = at(5.0).soundness.exchange_stress.value();
  const double strength = 5.0 / at_five;  // K: an exchange of that brings it
  const Summary below = at(0.99 * strength), above = at(1.02 * strength);
  EXPECT_NEAR(below.soundness.exchange_stress.value(), 0.99, 0.005);
  EXPECT_EQ(count_of(below.warnings, kTooLarge), 0);
  EXPECT_EQ(
      count_of(above.warnings,
               kTooLarge + ": in the mean one brings 1 of the tensile strength at once, and above 1 cracks "
                           "dissipate too much; a smaller coupling.exchange_increment brings less"),
      1);
}

// Promise: a uniform field strains nothing by its exchanges, and a stage without any says nothing.
TEST(ExchangeStress, ThereIsNoneOfAUniformField) {
  Made r(deck(kUniform + kSettle + heat("30 degC")));
  EXPECT_EQ(r.summary().soundness.exchange_stress, std::nullopt);
  EXPECT_EQ(tests().summary().soundness.exchange_stress, std::nullopt);
}

// Promise: where temperatures are exchanged, a smaller increment is advised too.
TEST(EnergyLedger, AdviceNamesTheExchangesWhereThereAreAny) {
  Made r(deck(kUniform + kSettle + heat("30 degC")));
  r.turn_over_ten_joules();
  r.dissipate(1.0);
  r.put("energy_error_J", 0.02);
  EXPECT_EQ(count_of(r.summary().warnings,
                     kOfDissipated + ", not within 1 %: a lower mechanics.safety leaves less, and so does a "
                                     "smaller coupling.exchange_increment"),
            1);
}

// ---- The heat ledger -------------------------------------------------------------------------------------

/// A wall between two temperatures, heated for a minute.
Made wall() {
  std::string text = with(shipped_case("thermal_wall"), "count = 2000", "count = 100");
  text = with(text, "duration = \"2 h\"", "duration = \"1 min\"");
  return Made(with(text, "frame_interval = \"15 min\"", "frame_interval = \"40 s\""));
}

constexpr const char* kHeatTerms[] = {"heat_stored_J", "heat_prescribed_J", "heat_flux_J",
                                      "heat_convection_J", "heat_radiation_J"};

// Promise: the heat ledger is judged by the largest of its terms, whatever its sign, and not by its error.
TEST(HeatLedger, TheErrorIsJudgedByTheLargestTerm) {
  Made r = wall();
  for (const char* largest : kHeatTerms) {
    for (const char* term : kHeatTerms) r.put(term, term == std::string(largest) ? -50.0 : 20.0);
    for (const double sign : {1.0, -1.0}) {
      r.put("heat_error_J", 100.0 * sign);
      EXPECT_DOUBLE_EQ(r.summary().soundness.heat_error.value(), 2.0) << largest;
    }
  }
  for (const char* term : kHeatTerms) r.put(term, 1e-3);  // little heat is heat too
  r.put("heat_error_J", 5e-4);
  EXPECT_DOUBLE_EQ(r.summary().soundness.heat_error.value(), 0.5);
  for (const char* term : kHeatTerms) r.put(term, 0.0);
  EXPECT_EQ(r.summary().soundness.heat_error, 0.0);
  // what flowed in and out again counts, in whatever row, the first and the last too
  const std::size_t rows = r.run.history().row_count();
  for (const std::size_t row : {std::size_t{0}, rows / 2, rows - 1}) {
    r.put("heat_flux_J", 0.0);
    r.put({row, row + 1}, "heat_flux_J", -0.01);
    EXPECT_DOUBLE_EQ(r.summary().soundness.heat_error.value(), 0.05) << row;
  }
  for (const char* term : kHeatTerms) r.put(term, std::nullopt);
  r.put("heat_stored_J", 0.25);
  r.put("heat_error_J", 0.25);
  EXPECT_DOUBLE_EQ(r.summary().soundness.heat_error.value(), 1.0);
  r.put("heat_error_J", std::nullopt);
  EXPECT_EQ(r.summary().soundness.heat_error, std::nullopt);
}

// Promise: heat is conserved to one part in a million, or there is a warning.
TEST(HeatLedger, AMillionthIsTheBoundOfAWarning) {
  Made r = wall();
  for (const char* term : kHeatTerms) r.put(term, -10.0);
  r.put("heat_error_J", 0.99e-5);
  EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
  r.put("heat_error_J", -1.02e-5);
  EXPECT_EQ(r.summary().warnings,
            std::vector<std::string>{"the heat ledger closes only within 1e-06 of its largest term"});
  r.put("heat_error_J", 5e-3);
  EXPECT_EQ(r.summary().warnings,
            std::vector<std::string>{"the heat ledger closes only within 0.0005 of its largest term"});
  for (const char* term : kHeatTerms) r.put(term, 1.0);
  r.put("heat_error_J", -1e-6);  // just that
  EXPECT_EQ(r.summary().warnings, std::vector<std::string>{});
}

// ---- Jumps -----------------------------------------------------------------------------------------------

const std::string kJumps = "jumps exceed an edge";

// Promise: a jump longer than its edge is told where results rest on it, with the place, the last row that
// decided them included.
TEST(LargeJumps, CountUpToWhatDecidedTheResults) {
  Made r = tests();
  r.put("largest_jump", 1.0);
  EXPECT_EQ(count_of(r.summary().warnings, kJumps), 0);
  const RowRange rows = r.rows_of(1);
  r.put({rows.first + 2, rows.first + 3}, "largest_jump", 1.01);
  r.put({rows.first + 2, rows.first + 3}, "temperature_degC", 321.0);
  r.put({rows.first + 2, rows.first + 3}, "strain", 0.00125);
  EXPECT_EQ(count_of(r.summary().warnings, kJumps + " from 321 degC and strain 0.00125 on, before"), 1);
  // behind the row that decided a stage's results they rest on nothing more
  Made failed(deck(kUniform + kSettle + kFailure));
  failed.put("largest_jump", 0.5);
  const std::size_t decided =
      failed.rows_of(1).first + failed.summary().stages.at(1).report.decided_at.value();
  ASSERT_LT(decided + 1, failed.rows_of(1).last);
  failed.put({decided + 1, decided + 2}, "largest_jump", 1.01);
  EXPECT_EQ(count_of(failed.summary().warnings, kJumps), 0);
  failed.put({decided, decided + 1}, "largest_jump", 1.01);
  EXPECT_EQ(count_of(failed.summary().warnings, kJumps), 1);
  // the first stage counts as any other
  Made first = tests();
  first.put("largest_jump", 0.5);
  first.put(first.rows_of(0), "largest_jump", 1.01);
  EXPECT_EQ(count_of(first.summary().warnings, kJumps), 1);
  // rows before any stage do not count
  Made before = tests();
  before.put("largest_jump", 0.5);
  before.put({0, before.rows_of(0).first}, "largest_jump", 2.0);
  EXPECT_EQ(count_of(before.summary().warnings, kJumps), 0);
}

// ---- Outcomes --------------------------------------------------------------------------------------------

// Promise: a body that did not come to rest makes the run no good, and the summary says so; what comes behind
// has not begun, and has nothing to report.
TEST(Outcomes, ARunThatDidNotSettleIsNoGood) {
  Made r(deck(kUniform + with(kSettle, "most_steps = 100000", "most_steps = 10") + kCompress));
  EXPECT_EQ(r.run.outcome(), Outcome::not_settled);
  const Summary s = r.summary();
  EXPECT_EQ(s.outcome, Outcome::not_settled);
  EXPECT_EQ(s.warnings.at(0), describe(Outcome::not_settled));
  EXPECT_EQ(s.stages.at(0).outcome, Outcome::not_settled);
  EXPECT_EQ(s.stages.at(1).outcome, Outcome::not_begun);
  EXPECT_TRUE(s.stages.at(1).report.results.empty());
  const json told = r.as_json();
  EXPECT_EQ(told["outcome_id"], "not_settled");
  EXPECT_EQ(told["outcome"], describe(Outcome::not_settled));
  EXPECT_EQ(told["is_good"], false);
  EXPECT_EQ(told["stages"][0]["outcome_id"], "not_settled");
  EXPECT_EQ(told["stages"][0]["is_good"], false);
  EXPECT_EQ(told["warnings"][0], describe(Outcome::not_settled));
}

// Promise: a run that goes on has not failed yet, and a completed one has no warning of its outcome.
TEST(Outcomes, ARunThatGoesOnHasNotFailed) {
  Trial trial(deck(kTwoTests));
  while (trial.run.next() && trial.run.stage_number() < 1) {
  }
  const Summary s = summarize(trial.run);
  EXPECT_EQ(s.warnings, std::vector<std::string>{});
  EXPECT_EQ(s.outcome, Outcome::running);
  EXPECT_EQ(s.stages[2].outcome, Outcome::not_begun);
  EXPECT_EQ(tests().summary().warnings, std::vector<std::string>{});
}

// ---- The file --------------------------------------------------------------------------------------------

// Promise: each number of the file is the last value of its own column.
TEST(SummaryFile, EachNumberIsTheLastOfItsColumn) {
  Made r = tests();
  const std::pair<const char*, const char*> energies[] = {{"loading", "energy_loading_J"},
                                                          {"gravity", "energy_gravity_J"},
                                                          {"property_change", "energy_property_change_J"},
                                                          {"mass_scaling", "energy_mass_scaling_J"},
                                                          {"elastic_zones", "energy_zones_J"},
                                                          {"elastic_contacts", "energy_contacts_J"},
                                                          {"kinetic", "energy_kinetic_J"},
                                                          {"local_damping", "energy_local_damping_J"},
                                                          {"viscous_damping", "energy_viscous_damping_J"}};
  double value = 100.0;
  for (const auto& [name, column] : energies) r.put(column, value += 1.0);
  r.put("energy_error_J", 0.25);
  r.put("mean_opening_m", 3e-5);
  r.put("step", 4321.0);
  std::vector<std::string> crack_columns;
  for (const Column& column : r.run.history().columns())
    if (column.name.ends_with("_damaged") || column.name.ends_with("_broken") ||
        (column.name.ends_with("_length_m") && !column.name.starts_with("heat")))
      crack_columns.push_back(column.name);
  EXPECT_GE(crack_columns.size(), 3u);
  for (const auto& column : crack_columns) r.put(column, value += 1.0);
  std::vector<std::string> losses;
  for (const auto& name : r.simulation->motion().dissipations()) losses.emplace_back(name);
  for (const auto& name : losses) r.put("dissipated_" + name + "_J", value += 1.0);

  const Summary s = r.summary();
  const json told = r.as_json();
  double expected = 100.0;
  for (const auto& [name, column] : energies) EXPECT_EQ(told["energy_J"][name], expected += 1.0) << name;
  EXPECT_EQ(told["energy_J"]["error"], 0.25);
  EXPECT_EQ(told["cracks"]["mean_opening_m"], 3e-5);
  EXPECT_EQ(told["steps"], 4321);
  for (const std::string& column : crack_columns) {
    expected += 1.0;
    bool found = false;
    for (const char* what : {"damaged", "broken", "broken_length_m", "length_m"})
      if (!found && column.ends_with(std::string("_") + what)) {
        const std::string crack = column.substr(0, column.size() - std::string(what).size() - 1);
        ASSERT_TRUE(told["cracks"].contains(crack)) << crack;
        EXPECT_EQ(told["cracks"][crack][what], expected) << column;
        found = true;
      }
    EXPECT_TRUE(found);
  }
  for (const std::string& name : losses) EXPECT_EQ(told["energy_J"]["dissipated_" + name], expected += 1.0);
  EXPECT_EQ(told["energy_J"]["error_over_turnover"], *s.soundness.energy_error);
  EXPECT_EQ(told["energy_J"]["error_over_dissipated"], *s.soundness.error_over_dissipated);
}

// Promise: the first look is enough to have numbers.
TEST(SummaryFile, TheFirstLookHasNumbers) {
  Trial trial(deck(kTwoTests));
  ASSERT_TRUE(trial.run.next());
  ASSERT_EQ(trial.run.history().row_count(), 1u);
  const json told = json::parse(summary_text(summarize(trial.run), trial.run));
  EXPECT_EQ(told["steps"], 0);
  EXPECT_TRUE(told["energy_J"]["kinetic"].is_number());
  EXPECT_TRUE(told["energy_J"]["error_over_turnover"].is_number());
}

// Promise: what is not of the history comes from the simulation, in the units of its names.
TEST(SummaryFile, TellsWhatTheBodyIs) {
  Made r = tests();
  Summary s = r.summary();
  s.title = "a title";
  s.wall_time = 12.5;
  s.expansion_reading = "free";
  const json told = json::parse(summary_text(s, r.run));
  EXPECT_EQ(told["title"], "a title");
  EXPECT_EQ(summary_text(s, r.run).find("{\n  \"title\": \"a title\",\n  \""), 0u)
      << "for readers, a key a line";
  EXPECT_EQ(told["wall_time_s"], 12.5);
  EXPECT_EQ(told["expansion_reading"], "free");
  EXPECT_EQ(told["estimated_E_GPa"],
            estimate_modulus(r.simulation->model(), r.simulation->materials()) * 1e-9);
  EXPECT_DOUBLE_EQ(told["t_b_m"], 1.6e-3);
  EXPECT_EQ(told["time_step_s"], r.simulation->motion().time_step());
  EXPECT_EQ(told["mass_over_real_mass"], r.simulation->motion().mass_ratio());
  const auto& specimen = std::get<specimen::Specimen<2>>(*r.simulation->specimen());
  EXPECT_EQ(told["specimen"]["blocks"], specimen.cells.cells.size());
  EXPECT_EQ(told["specimen"]["fraction_asked"], 0.1);
  double sum = 0.0;
  for (const auto& [phase, fraction] : told["specimen"]["fraction"].items()) sum += fraction.get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_FALSE(told.contains("heat_J"));
}

// Promise: a run that only conducts has heat and no energies, and its solver tells what it did.
TEST(SummaryFile, HeatAloneTellsItsTermsAndItsSolver) {
  Made r = wall();
  double value = 0.0;
  for (const char* term : kHeatTerms) r.put(term, value += 1.0);
  r.put("heat_error_J", 0.5);
  const json told = r.as_json();
  double expected = 0.0;
  for (const char* name : {"stored", "prescribed", "flux", "convection", "radiation"})
    EXPECT_EQ(told["heat_J"][name], expected += 1.0) << name;
  EXPECT_EQ(told["heat_J"]["error"], 0.5);
  EXPECT_DOUBLE_EQ(told["heat_J"]["error_over_largest"], 0.1);
  const HeatWork work = r.simulation->field().conduction()->work();
  EXPECT_EQ(told["heat_solver"]["steps"], work.steps);
  EXPECT_EQ(told["heat_solver"]["steps_taken_back"], work.retries);
  EXPECT_EQ(told["heat_solver"]["evaluations"], work.stages);
  EXPECT_FALSE(told["heat_solver"].contains("coupling"));
  EXPECT_FALSE(told["heat_solver"].contains("gap_length_m"));
  EXPECT_FALSE(told.contains("energy_J"));
  EXPECT_FALSE(told.contains("cracks"));
}

// Promise: a study may ask for what is a number in the file: numbers, flags, and what may become a number, by
// their paths; no texts.
TEST(SummaryFile, NumbersAreNamedByTheirPaths) {
  const Made r = tests();
  const auto names = summary_numbers(r.run);
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  for (const char* name : {"f_c_MPa", "E_GPa", "quasi_static", "energy_J.kinetic",
                           "energy_J.error_over_turnover", "cracks.mean_opening_m", "specimen.blocks",
                           "is_good", "wall_time_s", "steps", "exchange_stress_over_strength"})
    EXPECT_TRUE(has(name)) << name;
  for (const char* name : {"title", "outcome", "outcome_id", "sign", "stages", "warnings", "energy_J",
                           "cracks", "f_c_none_because", "f_c_doubtful_because", "expansion_reading"})
    EXPECT_FALSE(has(name)) << name;
  EXPECT_TRUE(std::ranges::is_sorted(names));
}

// Promise: results of the test are those that a laboratory would report; how they were computed is none.
TEST(SummaryFile, ResultsOfTheTestAreToldFromThoseOfTheComputation) {
  const Made r = tests();
  const auto names = test_results(r.run), numbers = summary_numbers(r.run);
  EXPECT_TRUE(std::ranges::includes(numbers, names));
  for (const char* name : {"f_c_MPa", "E_GPa", "strain_at_peak", "toe_strain"})
    EXPECT_TRUE(std::ranges::binary_search(names, name)) << name;
  for (const char* name : {"steps", "unbalanced_ratio", "quasi_static", "kinetic_over_elastic_to_peak",
                           "platen_difference_over_f_c_after_peak", "wall_time_s", "f_c_none_because",
                           "strain_ic_doubtful_because"})
    EXPECT_FALSE(std::ranges::binary_search(names, name)) << name;
}

}  // namespace
}  // namespace pyroclast::summary_test
