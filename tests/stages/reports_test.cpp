#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/stages/compress.hpp"
#include "pyroclast/stages/conduct.hpp"
#include "pyroclast/stages/expose.hpp"
#include "pyroclast/stages/heat.hpp"
#include "pyroclast/stages/load.hpp"
#include "pyroclast/stages/settle.hpp"
#include "result_of.hpp"
#include "stages/drives.hpp"

/// What stages report of histories that are made by hand, when they give up, and what they foretell.
namespace pyroclast::reports_test {
namespace {

/// A history of these columns, each with as many values.
History history_of(const std::map<std::string, std::vector<double>>& columns) {
  History history;
  for (const auto& [name, values] : columns) history.add_column({name, "1"});
  for (std::size_t row = 0; row < columns.begin()->second.size(); ++row) {
    history.add_row();
    for (const auto& [name, values] : columns) history.set(name, values.at(row));
  }
  return history;
}

Forecast forecast(const std::string& text, int stage) {
  const Trial trial(text);
  Foreseen foreseen{.temperature = 20.0, .hottest = 70.0};
  return trial.run.stages()[static_cast<std::size_t>(stage)]->forecast(*trial.simulation, foreseen);
}

// ---- Not settled -----------------------------------------------------------------------------------------

// Promise: a body that does not come to rest within the stated steps ends the run, which says so, after just
// these steps; it is looked at every 200.
TEST(NotSettled, SettlingGivesUpAfterItsSteps) {
  for (const int most : {1, 150, 200, 201, 450}) {
    const std::string settle =
        "[[stages]]\nkind = \"settle\"\nunbalanced_ratio = 1e-12\nmost_steps = " + std::to_string(most) +
        "\n";
    const Finished r(deck(kUniform + settle + kCompress));
    EXPECT_EQ(r.run.outcome(), Outcome::not_settled);
    EXPECT_EQ(r.run.courses()[0].outcome, Outcome::not_settled);
    EXPECT_EQ(r.run.courses()[1].outcome, Outcome::not_begun);
    EXPECT_EQ(r.result(0, "steps"), most);
    EXPECT_EQ(r.last("step"), most);
    EXPECT_EQ(r.result(0, "unbalanced_ratio"), r.last("unbalanced_ratio"));
    const RowRange rows = r.run.courses()[0].rows;
    EXPECT_EQ(rows.last - rows.first, static_cast<std::size_t>((most + 199) / 200));
  }
}

// Promise: rest is below the stated ratio, and only then; strains count from there.
TEST(NotSettled, RestIsBelowTheStatedRatio) {
  const Finished r(deck(kUniform + kSettle + kCompress));
  const RowRange rows = r.run.courses()[0].rows;
  const auto ratio = r.run.history().values("unbalanced_ratio", rows);
  for (std::size_t i = 0; i + 1 < ratio.size(); ++i) EXPECT_GE(ratio[i], 1e-6);
  EXPECT_LT(ratio.back(), 1e-6);
  EXPECT_EQ(r.result(0, "steps"), 200.0 * static_cast<double>(ratio.size()));
  const StageReport before = Settle({1e-6, 10}).report(r.run.history(), {}, Outcome::not_begun);
  EXPECT_EQ(number(before, "steps"), 0.0);
  EXPECT_TRUE(is_none(before, "unbalanced_ratio"));
}

// Promise: a load that is on and does not rest within the stated steps behind its ramp ends the run.
TEST(NotSettled, LoadingGivesUpAfterItsStepsBehindTheRamp) {
  const double step = Trial(deck(kUniform + kSettle)).simulation->motion().time_step();
  const std::string text = with(load("stress = \"1 MPa\""), "unbalanced_ratio = 1e-6\nmost_steps = 100000",
                                "unbalanced_ratio = 1e-14\nmost_steps = 500");
  const Finished r(deck(kUniform + kSettle + text + kCompress));
  EXPECT_EQ(r.run.outcome(), Outcome::not_settled);
  EXPECT_EQ(r.run.courses()[2].outcome, Outcome::not_begun);
  const double ramp = 0.02 / step;
  EXPECT_GE(r.result(1, "steps").value(), ramp + 500.0);
  EXPECT_LT(r.result(1, "steps").value(), ramp + 500.0 + 200.0);
  EXPECT_TRUE(r.report(1).warnings.empty());
  // behind a ramp of no time at just its steps, as it is looked at then
  const Finished at_once(deck(kUniform + kSettle + with(with(text, "\"20 ms\"", "\"0 s\""), "500", "400")));
  EXPECT_EQ(at_once.run.outcome(), Outcome::not_settled);
  EXPECT_EQ(at_once.result(1, "steps"), 400.0);
}

// Promise: a drive that does not rest within its duration ends the run as not settled; one whose conditions
// are not met goes on as not reached; both tell what was not met.
TEST(NotSettled, ADriveTellsWhatWasNotMet) {
  const std::string corner =
      "[[sets]]\nname = \"corner\"\nwithin = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n";
  const std::string held = does("left", "hold = [\"x\"]") + does("corner", "hold = [\"y\"]") +
                           does("right", "velocity = \"1 mm/s\"\ndirection = \"x\"");
  const std::string records = record("grip", "force", "set = \"left\"\ndirection = \"x\"") +
                              record("pull", "stress", "set = \"specimen\"\ndirection = \"x\"") +
                              record("end", "displacement", "set = \"right\"\ndirection = \"x\"");
  const auto until = [](const std::string& what) { return "[[stages.until]]\n" + what + "\n"; };
  const std::string next = drive("duration = \"1 ms\"", does("corner", "hold = [\"y\"]"));
  const std::string conditions =
      until("record = \"end\"\nabove = \"1 m\"") + until("record = \"pull\"\nbelow = \"-50 MPa\"") +
      until("record = \"grip\"\nshare_of_peak = 0.5") + until("record = \"end\"\nrate_above = \"7 m/s\"") +
      until("record = \"pull\"\nrate_below = \"2 Pa/s\"");
  const Finished r(
      free_deck(kUniform + corner + records + drive("duration = \"3 ms\"", held + conditions) + next));
  EXPECT_EQ(r.run.courses()[0].outcome, Outcome::not_reached);
  const std::vector<std::string> warnings = r.report(0).warnings;
  ASSERT_EQ(warnings.size(), 5u);
  const auto last = [&](const char* column) {
    const auto value = r.end_of(0, column);
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", value);
    return std::string(text);
  };
  const std::string not_met = "not met within the duration: ";
  EXPECT_EQ(warnings[0], not_met + "end is " + last("end_m") + " m, not above 1");
  EXPECT_EQ(warnings[1], not_met + "pull is " + last("pull_MPa") + " MPa, not below -50");
  EXPECT_EQ(warnings[2], not_met + "grip had no peak; it is " + last("grip_N") + " N");
  EXPECT_EQ(warnings[3], not_met + "end did not change faster than 7 m/s");
  EXPECT_EQ(warnings[4], not_met + "pull did not change more slowly than 2e-06 MPa/s");

  const Finished s(free_deck(kUniform + corner + records +
                             drive("duration = \"1 ms\"\nunbalanced_ratio = 1e-9",
                                   held + until("record = \"end\"\nabove = \"1 m\"")) +
                             next));
  EXPECT_EQ(s.run.outcome(), Outcome::not_settled);
  EXPECT_EQ(s.run.courses()[1].outcome, Outcome::not_begun);
  ASSERT_EQ(s.report(0).warnings.size(), 2u);
  EXPECT_EQ(s.report(0).warnings[1], not_met + "the unbalanced ratio is not below 1e-09");
}

// ---- Exchanges of temperatures ---------------------------------------------------------------------------

Heat::Keys heating() {
  Heat::Keys keys{.to = 200.0, .rate = 0.1, .exchange = {}};
  keys.exchange.coupling.increment = 5.0;
  keys.exchange.coupling.least_cycles = 50;
  keys.exchange.coupling.most_cycles = 5000;
  keys.exchange.frame_temperature = 50.0;
  return keys;
}

/// Of three exchanges, with a row before and one behind that are of other stages.
History exchanges() {
  return history_of({{"temperature_degC", {900.0, 40.0, 60.0, 80.0, 900.0}},
                     {"temperature_max_degC", {900.0, 70.0, 95.0, 90.0, 900.0}},
                     {"heating_time_s", {900.0, 10.0, 20.0, 30.0, 900.0}},
                     {"cycles", {900.0, 100.0, 200.0, 300.0, 900.0}},
                     {"converged", {0.0, 1.0, 0.0, 0.0, 0.0}},
                     {"unbalanced_ratio", {9.0, 1e-5, 3e-3, 5e-2, 9.0}},
                     {"stress_MPa", {90.0, 2.0, 6.0, 4.0, 90.0}}});
}

/// What the answer whether a specimen fails holds for.
constexpr const char* kConditions =
    "of this one specimen of plain concrete in plane stress: no steel, no spalling, no member";

constexpr auto* kNoLoad = "no load by a platen: the run does not tell whether the specimen fails under one";

// Promise: exchanges that did not come to rest are counted and told, and the worst of them.
TEST(ExchangeReports, CountsWhatDidNotComeToRest) {
  const StageReport r = Heat(heating()).report(exchanges(), {1, 4}, Outcome::completed);
  EXPECT_EQ(number(r, "exchanges"), 3.0);
  EXPECT_EQ(number(r, "exchanges_not_converged"), 2.0);
  EXPECT_EQ(number(r, "worst_unbalanced_ratio"), 5e-2);
  EXPECT_EQ(number(r, "cycles"), 600.0);
  EXPECT_EQ(number(r, "highest_temperature_degC"), 95.0);
  EXPECT_EQ(number(r, "largest_exchange_increment_K"), 5.0);
  EXPECT_TRUE(is_none(r, "critical_temperature_degC"));
  EXPECT_TRUE(is_none(r, "critical_time_s"));
  EXPECT_EQ(value_of(r, "critical_temperature_none_because"),
            Result::Value(std::string("no load by a platen was held")));
  EXPECT_TRUE(is_none(r, "largest_thrust_MPa"));  // it never began between platens
  EXPECT_TRUE(is_none(r, "load_stress_MPa"));
  EXPECT_TRUE(is_none(r, "platen"));
  EXPECT_EQ(r.lines,
            (std::vector<std::string>{
                "0 to 80 degC in the mean, 95 degC where it is hottest, in 3 exchanges of up to 5 K, 600 "
                "cycles; 2 did not come to rest",
                kNoLoad}));
  EXPECT_TRUE(is_none(r, "answer_is"));
  EXPECT_EQ(r.warnings, std::vector<std::string>{
                            "2 of 3 exchanges of temperature did not come to rest within the stated cycles "
                            "(worst unbalanced ratio 5.0e-02); history.csv flags them"});
  // what is hottest is told where it is more than a kelvin above the mean
  for (const double hottest : {80.99, 81.01}) {
    const History even = history_of({{"temperature_degC", {80.0}},
                                     {"temperature_max_degC", {hottest}},
                                     {"heating_time_s", {1.0}},
                                     {"cycles", {1.0}},
                                     {"converged", {1.0}},
                                     {"unbalanced_ratio", {0.0}}});
    EXPECT_EQ(Heat(heating()).report(even, {0, 1}, Outcome::completed).lines[0].find("in the mean") !=
                  std::string::npos,
              hottest > 81.0);
  }
  const StageReport first = Heat(heating()).report(exchanges(), {1, 2}, Outcome::completed);
  EXPECT_TRUE(first.warnings.empty());
  EXPECT_EQ(number(first, "exchanges_not_converged"), 0.0);
}

// Promise: a specimen that ran away did so at the last exchange: that is the critical temperature, and it is
// not told as one that did not come to rest.
TEST(ExchangeReports, TheLastExchangeIsWhereItRanAway) {
  const StageReport r = Heat(heating()).report(exchanges(), {1, 4}, Outcome::ran_away);
  EXPECT_EQ(number(r, "critical_temperature_degC"), 80.0);
  EXPECT_EQ(number(r, "critical_time_s"), 30.0);
  EXPECT_TRUE(is_none(r, "critical_temperature_none_because"));
  EXPECT_EQ(number(r, "exchanges"), 3.0);
  EXPECT_EQ(number(r, "exchanges_not_converged"), 1.0);
  EXPECT_EQ(number(r, "worst_unbalanced_ratio"), 3e-3);
  EXPECT_EQ(r.lines[1],
            std::string("critical temperature 80 degC, after 0.5 min of heating, ") + kConditions);
}

// Promise: before its first look a stage names its results, all of them empty.
TEST(ExchangeReports, NothingIsKnownBeforeTheFirstLook) {
  const StageReport r = Heat(heating()).report(exchanges(), {}, Outcome::running);
  for (const char* name : {"highest_temperature_degC", "worst_unbalanced_ratio", "largest_thrust_MPa",
                           "critical_temperature_degC"})
    EXPECT_TRUE(is_none(r, name)) << name;
  EXPECT_EQ(number(r, "exchanges"), 0.0);
  EXPECT_TRUE(r.lines.empty() && r.warnings.empty());
}

// Promise: between platens the report tells the load, or the thrust where they are fixed.
TEST(ExchangeReports, TellsTheLoadOrTheThrust) {
  const Finished free(deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("30 degC")));
  EXPECT_EQ(std::get<std::string>(value_of(free.report(2), "platen")), "force");
  EXPECT_NEAR(number(free.report(2), "load_stress_MPa"), 0.5, 1e-3);
  EXPECT_EQ(free.report(2).lines.back(),
            fmt::format("load 0.50 MPa: no failure {}; strain {:.4f} at the end, compression positive",
                        kConditions, free.run.history().values("strain", free.run.courses()[2].rows).back()));
  EXPECT_EQ(free.report(2).lines.front().find("20 to 30 degC in 2 exchanges of up to 5 K"), 0u);
  const Finished fixed(deck(kUniform + kSettle + heat("30 degC", "fixed")));
  const auto stress = fixed.run.history().values("stress_MPa", fixed.run.courses()[1].rows);
  const double thrust = *std::ranges::max_element(stress);
  EXPECT_GT(thrust, 0.1);
  EXPECT_DOUBLE_EQ(number(fixed.report(1), "largest_thrust_MPa"), thrust);
  EXPECT_EQ(fixed.report(1).lines.back().find("thrust up to "), 0u);
  EXPECT_EQ(std::get<std::string>(value_of(fixed.report(1), "field")), "uniform");
  EXPECT_TRUE(is_none(fixed.report(1), "answer_is"));
  EXPECT_EQ(value_of(free.report(2), "answer_is"), Result::Value(std::string(kConditions)));
}

// Promise: a heated body without load is not said to have withstood one.
TEST(ExchangeReports, DoesNotTellOfAFailureWhereNothingLoadsTheBody) {
  const Finished unloaded(deck(kUniform + kSettle + heat("30 degC")));
  EXPECT_EQ(unloaded.report(1).lines.back(), kNoLoad);
  EXPECT_TRUE(is_none(unloaded.report(1), "answer_is"));
}

// Promise: heating takes the time that its rate says, up or down, and a last part of an increment its part.
TEST(ExchangeReports, HeatingTakesItsTime) {
  const Finished r(deck(kUniform + kSettle + heat("32 degC") + heat("25 degC")));
  const History& history = r.run.history();
  EXPECT_EQ(history.values("temperature_degC", r.run.courses()[1].rows), (std::vector<double>{25, 30, 32}));
  EXPECT_EQ(history.values("temperature_degC", r.run.courses()[2].rows), (std::vector<double>{27, 25}));
  EXPECT_NEAR(r.end_of(1, "heating_time_s"), 12.0 / (5.0 / 60.0), 1e-9);
  EXPECT_NEAR(r.end_of(2, "heating_time_s"), 19.0 / (5.0 / 60.0), 1e-9);
  const Finished nothing(deck(kUniform + kSettle + heat("20 degC")));
  EXPECT_EQ(nothing.run.outcome(), Outcome::completed);
}

// Promise: heating ends at just its temperature, though its increments are no sums of powers of two.
TEST(ExchangeReports, HeatingEndsAtJustItsTemperature) {
  const Finished r(with(deck(kUniform + kSettle + heat("21 degC") + heat("20 degC")),
                        "exchange_increment = \"5 K\"", "exchange_increment = \"0.1 K\""));
  EXPECT_EQ(r.end_of(1, "temperature_degC"), 21.0);
  EXPECT_EQ(r.result(1, "exchanges"), 10.0);
  EXPECT_EQ(r.end_of(2, "temperature_degC"), 20.0);
  EXPECT_EQ(r.result(2, "exchanges"), 10.0);
}

// Promise: what is left of the way is told while it goes on.
TEST(ExchangeReports, ProgressIsTheShareOfTheWay) {
  Trial trial(deck(kUniform + kSettle + heat("40 degC")));
  std::vector<double> progress;
  while (trial.run.next())
    if (trial.run.stage_number() == 1) progress.push_back(trial.run.progress());
  ASSERT_EQ(progress.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(progress[i], 0.25 * static_cast<double>(i + 1), 1e-12);
}

// ---- Loads -----------------------------------------------------------------------------------------------

// Promise: a ramp's share grows evenly to 1; without a ramp all is there at once.
TEST(LoadReports, ARampGrowsEvenly) {
  EXPECT_DOUBLE_EQ(ramp_share(30, 1e-3, 0.1), 0.3);
  EXPECT_EQ(ramp_share(0, 1e-3, 0.1), 0.0);
  EXPECT_EQ(ramp_share(100, 1e-3, 0.1), 1.0);
  EXPECT_EQ(ramp_share(900, 1e-3, 0.1), 1.0);
  EXPECT_EQ(ramp_share(0, 1e-3, 0.0), 1.0);
}

// Promise: a load tells its stress and level, what was borne at most, and where it ended.
TEST(LoadReports, TellsWhatWasBorne) {
  Load::Keys keys{.stress = 6e6, .level = 0.2, .strength = 30e6, .strength_of = "a twin"};
  const History history =
      history_of({{"stress_MPa", {9.0, 1.0, 5.0, 3.0, 9.0}}, {"strain", {9.0, 1e-4, 2e-4, 3e-4, 9.0}}});
  const StageReport r = Load(keys).report(history, {1, 4}, Outcome::completed);
  EXPECT_EQ(number(r, "load_stress_MPa"), 6.0);
  EXPECT_EQ(number(r, "load_level"), 0.2);
  EXPECT_EQ(number(r, "f_c_of_level_MPa"), 30.0);
  EXPECT_EQ(std::get<std::string>(value_of(r, "f_c_of_level_is")), "a twin");
  EXPECT_EQ(number(r, "largest_stress_MPa"), 5.0);
  EXPECT_EQ(number(r, "strain"), 3e-4);
  EXPECT_EQ(r.lines, std::vector<std::string>{"load 6.00 MPa: 0.2 of f_c 30.00 MPa, a twin"});
  EXPECT_TRUE(r.warnings.empty());
  const StageReport crushed = Load(keys).report(history, {1, 4}, Outcome::crushed);
  EXPECT_EQ(crushed.warnings, std::vector<std::string>{
                                  "crushed: the specimen bore 5.00 MPa at most of the 6.00 MPa of the load"});
  keys.level.reset();
  const StageReport plain = Load(keys).report(history, {1, 1}, Outcome::not_begun);
  for (const char* name :
       {"load_level", "f_c_of_level_MPa", "f_c_of_level_is", "largest_stress_MPa", "strain"})
    EXPECT_TRUE(is_none(plain, name)) << name;
  EXPECT_TRUE(plain.lines.empty());
}

// Promise: the load rises evenly over its ramp from what was held before.
TEST(LoadReports, TheLoadRisesEvenlyFromWhatWasHeld) {
  Trial trial(deck(kUniform + kSettle + load("stress = \"1 MPa\"") + load("stress = \"3 MPa\"")));
  const double step = trial.simulation->motion().time_step();
  std::vector<std::pair<double, double>> held;  // steps of the stage, Pa
  std::vector<double> progress;
  double first_step = 0.0;
  while (trial.run.next()) {
    const double now = trial.run.history().last("step").value();
    if (trial.run.stage_number() == 1) first_step = now;
    if (trial.run.stage_number() != 2) continue;
    held.emplace_back(now - first_step, trial.simulation->press().stress_held());
    progress.push_back(trial.run.progress());
  }
  ASSERT_GT(held.size(), 5u);
  for (std::size_t i = 0; i < held.size(); ++i) {
    // held for the last 20 steps: what the ramp has in their middle
    const double share = std::min(1.0, (held[i].first - 10.0) * step / 0.02);
    EXPECT_NEAR(held[i].second, 1e6 + share * 2e6, 1.0);
    EXPECT_NEAR(progress[i], std::min(1.0, held[i].first * step / 0.02), 1e-9);
  }
}

// ---- Heat alone ------------------------------------------------------------------------------------------

// Promise: heat alone reports its last row, and warns only where a steady state was asked for and is none.
TEST(ConductReports, TellsItsLastRow) {
  const History history = history_of({{"heating_time_s", {9.0, 10.0, 20.0, 9.0}},
                                      {"temperature_degC", {9.0, 30.0, 40.5, 9.0}},
                                      {"temperature_min_degC", {9.0, 20.0, 25.0, 9.0}},
                                      {"temperature_max_degC", {9.0, 50.0, 60.0, 9.0}},
                                      {"rate_K_s", {9.0, 0.2, 0.1, 9.0}}});
  Conduct::Keys keys;
  const StageReport r = Conduct(keys).report(history, {1, 3}, Outcome::completed);
  EXPECT_EQ(number(r, "heating_time_s"), 20.0);
  EXPECT_EQ(number(r, "temperature_mean_degC"), 40.5);
  EXPECT_EQ(number(r, "temperature_min_degC"), 25.0);
  EXPECT_EQ(number(r, "temperature_max_degC"), 60.0);
  EXPECT_EQ(number(r, "rate_K_s"), 0.1);
  EXPECT_EQ(std::get<bool>(value_of(r, "steady")), false);
  EXPECT_EQ(r.lines, std::vector<std::string>{"mean 40.5 degC, 25.0 to 60.0, changing by 0.1 K/s"});
  EXPECT_TRUE(r.warnings.empty());
  keys.steady_rate = 0.05;
  EXPECT_EQ(Conduct(keys).report(history, {1, 3}, Outcome::completed).warnings,
            std::vector<std::string>{
                "no steady state: the temperatures still change by 0.1 K/s, more than 0.05 K/s"});
  const StageReport steady = Conduct(keys).report(history, {1, 3}, Outcome::steady);
  EXPECT_TRUE(steady.warnings.empty());
  EXPECT_EQ(std::get<bool>(value_of(steady, "steady")), true);
  EXPECT_TRUE(is_none(Conduct(keys).report(history, {}, Outcome::not_begun), "rate_K_s"));
}

// ---- What stages foretell --------------------------------------------------------------------------------

// Promise: a body needs 1,100 steps for each tenth of its unbalanced ratio, and as many at least.
TEST(Forecasts, RestTakes1100StepsADecade) {
  EXPECT_DOUBLE_EQ(steps_to_rest(1e-4), 4400.0);
  EXPECT_DOUBLE_EQ(steps_to_rest(1e-2), 2200.0);
  EXPECT_DOUBLE_EQ(steps_to_rest(0.5), 1100.0);
  const Forecast settle = forecast(deck(kUniform + kSettle), 0);
  EXPECT_DOUBLE_EQ(settle.steps, 6600.0);
  EXPECT_DOUBLE_EQ(settle.looks, 33.0);
  EXPECT_EQ(settle.frames, 1.0);
  EXPECT_EQ(forecast(deck(kUniform + with(kSettle, "100000", "500")), 0).steps, 500.0);
}

// Promise: a load takes its ramp and then its rest, of which the ramp takes a part; a look at least.
TEST(Forecasts, ALoadTakesItsRampAndItsRest) {
  const double step = Trial(deck(kUniform + kSettle)).simulation->motion().time_step();
  const auto at = [&](double ramp, const std::string& most) {
    char text[32];
    std::snprintf(text, sizeof(text), "\"%.6g s\"", ramp);
    return forecast(
        deck(kUniform + kSettle + with(with(load("stress = \"1 MPa\""), "\"20 ms\"", text), "100000", most)),
        1);
  };
  const double slow = 0.02 / step;
  EXPECT_NEAR(at(0.02, "100000").steps, slow + std::max(6600.0 - slow, 200.0), 1.0);
  EXPECT_NEAR(at(0.2, "100000").steps, 10.0 * slow + std::max(6600.0 - 10.0 * slow, 200.0), 1.0);
  EXPECT_NEAR(at(0.02, "90").steps, slow + 90.0, 1.0);
  EXPECT_NEAR(at(0.02, "100000").looks, at(0.02, "100000").steps / 200.0, 1e-9);
  EXPECT_EQ(at(0.02, "100000").frames, 1.0);
}

// Promise: a compression takes the time of its way at full velocity, and half of its ramp more.
TEST(Forecasts, ACompressionTakesItsWay) {
  const Trial trial(deck(kUniform + kSettle));
  const double step = trial.simulation->motion().time_step(), height = trial.simulation->press().height();
  const auto compress = [](const std::string& until) {
    return deck(kUniform + kSettle + "[[stages]]\nkind = \"compress\"\nvelocity = \"0.5 mm/s\"\n" +
                "ramp_time = \"20 ms\"\n" + until + "\n");
  };
  const auto steps = [&](double strain) { return (strain * height / 0.5e-3 + 0.01) / step; };
  const Forecast a = forecast(compress("stop_strain = 0.003"), 1);
  EXPECT_NEAR(a.steps, steps(0.003), 1e-6 * a.steps);
  EXPECT_NEAR(a.looks, 300.0, 1e-9);
  EXPECT_NEAR(a.frames, 4.0, 1e-9);
  EXPECT_NEAR(forecast(compress("to_strain = -0.002"), 1).steps, steps(0.002), 1e-6 * a.steps);
  EXPECT_NEAR(forecast(compress("to_stress = \"5 MPa\""), 1).steps, steps(0.001), 1e-6 * a.steps);
  EXPECT_NEAR(forecast(compress("to_stress = \"5 MPa\"\nstop_strain = 0.0004"), 1).steps, steps(0.0004),
              1e-6 * a.steps);
  // a controlled velocity grows by a factor of e in each ramp time, to that which cracks leave it
  const auto controlled = [&](double fastest, double rate) {
    const std::string bounds = with(kControl, "10 mm/s", fmt::format("{:g} mm/s", 1e3 * fastest));
    return forecast(compress("stop_strain = 0.003\n" + with(bounds, "50 1/s", fmt::format("{:g} 1/s", rate))),
                    1)
        .steps;
  };
  const auto steps_at = [&](double velocity) {
    return (0.003 * height / velocity + 0.02 * (0.5 + std::log(velocity / 0.5e-3))) / step;
  };
  const double rate = 2e-3 / (1.1e-3 * height);  // at which cracks leave it 2 mm/s
  EXPECT_NEAR(controlled(8e-3, rate), steps_at(2e-3), 1e-6 * a.steps);
  EXPECT_NEAR(controlled(1e-3, rate), steps_at(1e-3), 1e-6 * a.steps) << "no faster than it may";
  EXPECT_NEAR(controlled(8e-3, 0.1 * rate), steps(0.003), 1e-6 * a.steps) << "nor slower";
}

// Promise: heating takes an exchange for each increment, begun ones too, and tells where it ends.
TEST(Forecasts, HeatingTakesItsExchanges) {
  const Forecast f = forecast(with(deck(kUniform + kSettle + heat("42 degC")), "frame_strain = 1e-3",
                                   "frame_strain = 1e-3\nframe_temperature = \"11 K\""),
                              1);
  EXPECT_EQ(f.exchanges, 5.0);  // 22 K by 5 K
  EXPECT_EQ(f.looks, 5.0);
  EXPECT_DOUBLE_EQ(f.frames, 3.0);
  EXPECT_EQ(f.heating_duration, 0.0);
  const Heat stage(heating());
  const Trial trial(deck(kUniform + kSettle));
  Foreseen foreseen{.temperature = 300.0, .hottest = 300.0};
  EXPECT_EQ(stage.forecast(*trial.simulation, foreseen).exchanges, 20.0);
  EXPECT_EQ(foreseen.temperature, 200.0);
}

// Promise: an exposure takes an exchange for each increment of what is hottest, its mean half of that; frames
// come in time where the deck says so.
TEST(Forecasts, AnExposureTakesTheHottest) {
  Expose::Keys keys{.duration = 600.0, .exchange = heating().exchange};
  const Trial trial(deck(kSettle + kExpose + kHeatedFace));
  Foreseen foreseen{.temperature = 20.0, .hottest = 120.0};
  const Forecast f = Expose(keys).forecast(*trial.simulation, foreseen);
  EXPECT_EQ(f.exchanges, 20.0);
  EXPECT_EQ(f.heating_duration, 600.0);
  EXPECT_DOUBLE_EQ(foreseen.temperature, 70.0);
  EXPECT_DOUBLE_EQ(f.frames, 2.0);  // 50 K by 50 K, and the end
  keys.frame_interval = 200.0;
  EXPECT_DOUBLE_EQ(Expose(keys).forecast(*trial.simulation, foreseen).frames, 4.0);
}

// Promise: heat alone takes its duration, with looks and frames at their intervals.
TEST(Forecasts, ConductionTakesItsDuration) {
  Conduct::Keys keys;
  keys.duration = 600.0;
  keys.interval = 60.0;
  keys.frame_interval = 200.0;
  const Trial trial(deck(kSettle + kExpose + kHeatedFace));
  Foreseen foreseen{.temperature = 20.0, .hottest = 120.0};
  const Forecast f = Conduct(keys).forecast(*trial.simulation, foreseen);
  EXPECT_DOUBLE_EQ(f.looks, 10.0);
  EXPECT_DOUBLE_EQ(f.frames, 4.0);
  EXPECT_EQ(f.heating_duration, 600.0);
  EXPECT_EQ(foreseen.temperature, 120.0);
}

// Promise: a drive takes its duration, with looks and frames at their intervals, and one frame more for the
// peak of a force.
TEST(Forecasts, ADriveTakesItsDuration) {
  const std::string corner =
      "[[sets]]\nname = \"corner\"\nwithin = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n";
  const std::string held = does("left", "hold = [\"x\"]") + does("corner", "hold = [\"y\"]");
  const double step = Trial(free_deck(kUniform + corner + drive("duration = \"1 ms\"", held)))
                          .simulation->motion()
                          .time_step();
  const Forecast plain = forecast(free_deck(kUniform + corner + drive("duration = \"50 ms\"", held)), 0);
  EXPECT_NEAR(plain.steps, 0.05 / step, 1e-6 / step);
  EXPECT_DOUBLE_EQ(plain.looks, 200.0);
  EXPECT_DOUBLE_EQ(plain.frames, 10.0);
  const Forecast stated = forecast(
      free_deck(kUniform + corner + record("grip", "force", "set = \"left\"\ndirection = \"x\"") +
                drive("duration = \"50 ms\"\nlook_interval = \"5 ms\"\nframe_interval = \"25 ms\"", held)),
      0);
  EXPECT_DOUBLE_EQ(stated.looks, 10.0);
  EXPECT_DOUBLE_EQ(stated.frames, 3.0);
}

// ---- Compression -----------------------------------------------------------------------------------------

// Promise: a compression goes on to its strain, by even looks and frames, and its progress is the share of
// its way; the first row not before the peak decided its results.
TEST(CompressReports, LooksFramesAndProgressAreEven) {
  Trial trial(deck(kUniform + kSettle + "[[stages]]\nkind = \"compress\"\nvelocity = \"1 mm/s\"\n" +
                   "ramp_time = \"2 ms\"\nstop_strain = 0.00205\n"));
  std::vector<double> strain, frames;
  while (trial.run.next()) {
    if (trial.run.stage_number() != 1) continue;
    strain.push_back(trial.run.history().last("stage_strain").value());
    EXPECT_NEAR(trial.run.progress(), std::min(1.0, strain.back() / 0.00205), 1e-9);
    if (trial.run.frame_is_due() && !trial.run.stage_is_over()) frames.push_back(strain.back());
  }
  for (std::size_t i = 3; i + 1 < strain.size(); ++i) EXPECT_NEAR(strain[i] - strain[i - 1], 1e-5, 2e-6);
  EXPECT_GE(strain.back(), 0.00205);
  EXPECT_LT(strain.back(), 0.00205 + 1.2e-5);
  ASSERT_EQ(frames.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(frames[i], 1e-3 * static_cast<double>(i + 1));
    EXPECT_LT(frames[i], 1e-3 * static_cast<double>(i + 1) + 1.2e-5);
  }
}

// Promise: the velocity rises evenly over its ramp; it is chosen anew at each point of the curve, 1e-5 of
// strain.
TEST(CompressReports, TheVelocityRisesOverItsRamp) {
  for (const double ramp : {0.02, 0.0}) {
    const Finished r(deck(kUniform + kSettle +
                          with(kCompress, "ramp_time = \"20 ms\"",
                               ramp > 0.0 ? "ramp_time = \"20 ms\"" : "ramp_time = \"0 s\"")));
    const RowRange rows = r.run.courses()[1].rows;
    const double begin = r.run.history().cell(rows.first - 1, "time_s").value();
    const auto strain = r.run.history().values("stage_strain", rows),
               time = r.run.history().values("time_s", rows);
    for (std::size_t i = 0; i < strain.size(); ++i) {
      const double t = time[i] - begin;
      const double way = t < ramp ? 0.5 * t * t / ramp : t - 0.5 * ramp;
      EXPECT_NEAR(strain[i], 0.5e-3 * way / 0.12, 0.7e-5) << ramp << " " << t;
    }
  }
}

TEST(CompressReports, TheRowOfThePeakDecided) {
  const Finished r(deck(kUniform + kSettle + kFailure));
  const RowRange rows = r.run.courses()[1].rows;
  const auto strain = r.run.history().values("stage_strain", rows);
  const double peak = r.result(1, "strain_at_peak").value();
  const auto decided = r.report(1).decided_at;
  ASSERT_TRUE(decided);
  EXPECT_GE(strain[*decided], peak);
  EXPECT_LT(strain[*decided - 1], peak);
  const Finished no_peak(deck(kUniform + kSettle + kCompress));
  EXPECT_FALSE(no_peak.report(1).decided_at);
}

// ---- A platen that is apart ------------------------------------------------------------------------------

// Promise: a platen that stands apart from the body is brought to it first: what a compression measures
// counts from where they meet.
TEST(CompressReports, AGapIsClosedFirst) {
  const Finished touching(deck(kUniform + kSettle + kCompress));
  const Finished apart(deck(kUniform + kSettle + heat("120 degC") + heat("20 degC", "fixed") + kCompress));
  // the body has shrunk by 1e-3 of its height under the platen
  EXPECT_GT(apart.end_of(3, "strain"), apart.end_of(2, "strain") + 1e-4);
  EXPECT_NEAR(apart.end_of(3, "stage_strain"), touching.end_of(1, "stage_strain"), 2e-5);
  // a body that was heated and cooled bears nearly as much
  EXPECT_GT(apart.end_of(3, "stress_MPa"), 0.85 * touching.end_of(1, "stress_MPa"));
  EXPECT_LT(apart.end_of(3, "stress_MPa"), 1.05 * touching.end_of(1, "stress_MPa"));
}

// Promise: while the platen comes to the body, the stage says so, and then no more.
TEST(CompressReports, SaysThatThePlatenComes) {
  Trial trial(deck(kUniform + kSettle + heat("120 degC") + heat("20 degC", "fixed") + kCompress));
  std::vector<std::string> said;
  trial.run.between_batches([&](pyroclast::Run& run, const Wishes&) {
    if (run.last_begun_stage() != 3) return;
    if (said.empty() || said.back() != run.stage().doing()) said.push_back(run.stage().doing());
    if (!run.stage().doing().empty()) {
      EXPECT_EQ(run.stage().progress(*trial.simulation), 0.0);
    }
  });
  trial.run.run();
  EXPECT_EQ(said, (std::vector<std::string>{"moving the platen to the specimen", ""}));
}

// ---- States ----------------------------------------------------------------------------------------------

/// What a run gives: its rows, which of them are frames, and what its stages report.
struct Told {
  std::vector<std::vector<std::optional<double>>> rows;
  std::vector<bool> frames;
  std::vector<double> progress;
  std::vector<std::string> lines;
  std::vector<std::pair<std::string, Result::Value>> results;
  bool operator==(const Told&) const = default;
};

/// Goes to the end of a run, from a look on.
Told tell(Trial& trial, std::size_t from) {
  Told told;
  std::size_t look = trial.run.history().row_count();
  while (trial.run.next()) {
    if (look++ < from) continue;
    told.rows.push_back(trial.run.history().row(trial.run.history().row_count() - 1));
    told.frames.push_back(trial.run.frame_is_due());
    told.progress.push_back(trial.run.progress());
  }
  for (std::size_t i = 0; i < trial.run.stages().size(); ++i) {
    const StageCourse& record = trial.run.courses()[i];
    const StageReport report =
        trial.run.stages()[i]->report(trial.run.history(), record.rows, record.outcome);
    told.lines.insert(told.lines.end(), report.lines.begin(), report.lines.end());
    for (const Result& result : report.results) told.results.emplace_back(result.name, result.value);
  }
  return told;
}

// Promise: however slow a compression is, what is left of it is a state to go on from.
TEST(States, ASlowCompressionHasOne) {
  const std::string text = deck(kUniform + kSettle + with(kCompress, "0.5 mm/s", "1e-9 mm/s"));
  Trial first(text), second(text);
  StateCopy copy;
  struct Enough {};
  cut_batches(first.run, 100);
  first.run.between_batches([&](pyroclast::Run& run, const Wishes&) {
    if (run.last_begun_stage() != 1) return;
    copy.take([&](StateVisitor& visitor) { run.visit_state(visitor); });
    throw Enough();
  });
  EXPECT_THROW(first.run.run(), Enough);
  EXPECT_NO_THROW(copy.put([&](StateVisitor& visitor) { second.run.visit_state(visitor); }));
  EXPECT_EQ(second.run.last_begun_stage(), 1);
}

// Promise: a stage goes on from its state, at whatever look that was taken, as if it had not been broken off.
TEST(States, EachStageGoesOnFromAnyLook) {
  const std::string driven =
      with(with(kControl, "10 mm/s", "4 mm/s"), "unbalanced_ratio = 2e-4", "unbalanced_ratio = 2e-3");
  const std::string frames = "frame_strain = 1e-3\nframe_temperature = \"11 K\"";
  const std::string fast = "[[stages]]\nkind = \"compress\"\nvelocity = \"2 mm/s\"\nramp_time = \"10 ms\"\n";
  // loads that were there before, and others over them along a ramp
  const std::string first_loads = does("left", "hold = [\"x\", \"y\"]") +
                                  does("right", "force = \"9 kN\"\ndirection = [3, 4]") +
                                  does("top", "pressure = \"2 MPa\"");
  const std::string other_loads =
      does("right", "force = \"5 kN\"\ndirection = [0, -1]\nramp_time = \"15 ms\"") +
      does("top", "pressure = \"-1 MPa\"\nramp_time = \"18 ms\"");
  const std::string loaded_again =
      free_deck(kUniform + drive("duration = \"10 ms\"\nlook_interval = \"1 ms\"", first_loads) +
                drive("duration = \"20 ms\"\nlook_interval = \"1 ms\"", other_loads));
  // heat alone, twice, so that neither the time nor the frames of the second one begin at 0
  const std::string conducts =
      "[[stages]]\nkind = \"conduct\"\nduration = \"100 s\"\ninterval = \"15 s\"\n"
      "[[stages]]\nkind = \"conduct\"\nduration = \"170 s\"\ninterval = \"20 s\"\nsteady_rate = \"1e-9 "
      "K/s\"\n";
  std::string walls = with(shipped_case("thermal_wall"), "count = 2000", "count = 100");
  const auto of_stage = walls.find("[[stages]]"), of_probes = walls.find("[[probes]]");
  walls = with(walls.substr(0, of_stage) + conducts + walls.substr(of_probes), "\"15 min\"", "\"35 s\"");
  const std::vector<std::string> texts{
      deck(kUniform + kSettle + load("stress = \"1 MPa\"") + kCompress + fast + "to_stress = \"0 MPa\"\n"),
      with(with(deck(kUniform + kSettle + load("stress = \"1 MPa\"") + heat("62 degC") +
                     heat("40 degC", "fixed")),
                "frame_strain = 1e-3", frames),
           "least_cycles = 50", "least_cycles = 50\npredictor = true"),
      with(deck(kUniform + kSettle + heat("70 degC") + heat("20 degC", "fixed") + fast +
                "stop_strain = 0.0008\n" + driven),
           "frame_strain = 1e-3", "frame_strain = 2e-4"),
      deck(kUniform + kSettle + fast + "stop_strain = 0.0024\n"),
      with(with(deck(kSettle + kExpose + kHeatedFace), "most_cycles = 5000", "most_cycles = 60"),
           "frame_strain = 1e-3", "frame_strain = 1e-3\nframe_interval = \"100 s\""),
      loaded_again,
      walls};
  for (std::size_t t = 0; t < texts.size(); ++t) {
    const std::size_t looks = [&] {
      Trial counted(texts[t]);
      counted.run.run();
      return counted.run.history().row_count();
    }();
    Trial straight(texts[t]), in_pieces(texts[t]);
    cut_batches(in_pieces.run, 7);
    EXPECT_EQ(tell(in_pieces, 0), tell(straight, 0)) << t << ": where batches end changes no result";
    for (const double share : {0.3, 0.55, 0.9}) {
      const auto stop = static_cast<std::size_t>(share * static_cast<double>(looks));
      Trial again(texts[t]), first(texts[t]), second(texts[t]);
      while (first.run.history().row_count() < stop) first.run.next();
      copy_state(first.run, second.run);
      const Told expected = tell(again, stop), told = tell(second, stop);
      EXPECT_EQ(told.rows, expected.rows) << t << ", look " << stop << " of " << looks;
      EXPECT_EQ(told.frames, expected.frames) << t << ", look " << stop << " of " << looks;
      EXPECT_EQ(told.progress, expected.progress) << t << ", look " << stop << " of " << looks;
      EXPECT_EQ(told.lines, expected.lines) << t << ", look " << stop << " of " << looks;
      EXPECT_EQ(told.results, expected.results) << t << ", look " << stop << " of " << looks;
    }
  }
}

}  // namespace
}  // namespace pyroclast::reports_test
