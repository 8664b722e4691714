#include "pyroclast/material/curve.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <latch>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/material/curve_file.hpp"
#include "pyroclast/material/expression.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

void expect_contains(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" lacks \"" << part << "\"";
  }
}

Curve triangle() {
  return Curve::table({20, 100, 500}, {1.0, 3.0, 0.5}, temperature_axis());
}

Curve formula(const std::string& text) {
  return Curve::expression(text, {20, 800}, temperature_axis());
}

TEST(Curve, AConstantHasTheSameValueEverywhere) {
  const Curve curve = Curve::constant(2.5);
  EXPECT_EQ(curve(-1e30), 2.5);
  EXPECT_EQ(curve(1e30), 2.5);
  EXPECT_EQ(curve.range(), Interval{});
  EXPECT_TRUE(curve.is_constant());
  EXPECT_EQ(curve.describe(), "2.5");
}

TEST(Curve, ATableHitsItsPointsExactlyAndIsLinearBetween) {
  const Curve curve = triangle();
  EXPECT_EQ(curve(20), 1.0);
  EXPECT_EQ(curve(100), 3.0);
  EXPECT_EQ(curve(500), 0.5);
  EXPECT_DOUBLE_EQ(curve(60), 2.0);
  EXPECT_DOUBLE_EQ(curve(300), 1.75);
  EXPECT_EQ(curve.range(), (Interval{20, 500}));
}

TEST(Curve, ACopyReadsTheSameValues) {
  Curve copy = Curve::constant(0.0);
  {
    const Curve original = triangle();
    copy = original;
  }
  EXPECT_EQ(copy(100), 3.0);
}

TEST(Curve, ReadingOutsideTheRangeNamesTheCurveTheAbscissaAndTheRange) {
  const Curve curve = triangle().named("material mortar: modulus");
  for (const double outside : {19.9, 500.1, -1e300}) {
    expect_contains(message([&] { curve(outside); }),
                    {"material mortar: modulus", "table of 3 points", "20 to 500 degC", "T = "});
  }
  expect_contains(message([&] { curve(500.5); }), {"T = 500.5 degC"});
  EXPECT_THROW(curve(std::numeric_limits<double>::quiet_NaN()), Error);
  EXPECT_THROW(Curve::constant(1.0)(std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(Curve, RoundingAtTheEndsOfTheRangeIsNotAnError) {
  const Curve curve = triangle();
  EXPECT_EQ(curve(std::nextafter(20.0, 0.0)), 1.0);
  EXPECT_EQ(curve(std::nextafter(500.0, 1000.0)), 0.5);
  EXPECT_THROW(curve(20.0 - 1e-5), Error);
  EXPECT_THROW(curve(500.0 + 1e-5), Error);
}

TEST(Curve, WrongTablesAreRefusedWithTheirPoint) {
  const auto table = [](std::vector<double> x, std::vector<double> y) {
    return message([&] { Curve::table(x, y, temperature_axis()); });
  };
  expect_contains(table({20}, {1}), {"at least 2 points", "has 1"});
  expect_contains(table({20, 30}, {1}), {"2 abscissae", "1 values"});
  expect_contains(table({20, 100, 100}, {1, 2, 3}), {"point 3", "T = 100 degC after 100", "ascend"});
  expect_contains(table({20, 10}, {1, 2}), {"point 2", "10", "ascend"});
  expect_contains(table({20, std::nan("")}, {1, 2}), {"point 2", "finite"});
  expect_contains(table({20, 30}, {1, INFINITY}), {"point 2", "finite"});
}

TEST(Curve, ExtremesOfTablesAreExact) {
  const Curve curve = triangle();
  EXPECT_EQ(curve.maximum(20, 500), 3.0);
  EXPECT_EQ(curve.minimum(20, 500), 0.5);
  EXPECT_EQ(curve.maximum(150, 500), curve(150));
  EXPECT_EQ(curve.minimum(20, 300), 1.0);
  EXPECT_EQ((curve * -2.0).minimum(20, 500), -6.0);
  EXPECT_EQ(Curve::constant(4.0).maximum(-1e9, 1e9), 4.0);
  EXPECT_THROW(curve.maximum(20, 501), Error);
  EXPECT_THROW(curve.maximum(300, 200), Error);
}

TEST(Curve, ExtremesOfFunctionsAreFoundAtBreaksAndBetween) {
  const Curve spike = Curve::function("spike", [](double x) { return x == 33.3 ? 7.0 : std::sin(x / 100.0); },
                                      {20, 500}, temperature_axis(), {33.3});
  EXPECT_EQ(spike.maximum(20, 500), 7.0);
  // Steps of 0.46 degC miss the crest by at most 0.23 degC: 1 - cos(0.0023) < 3e-6.
  EXPECT_NEAR(spike.maximum(40, 500), 1.0, 3e-6);
}

TEST(Curve, AMultipleScalesTheValuesAndKeepsRangeAndName) {
  const Curve curve = 30e9 * triangle().named("mortar modulus");
  EXPECT_DOUBLE_EQ(curve(60), 60e9);
  EXPECT_EQ(curve.range(), (Interval{20, 500}));
  EXPECT_EQ(curve.axis(), temperature_axis());
  expect_contains(message([&] { curve(600); }), {"mortar modulus", "20 to 500 degC"});
  EXPECT_TRUE((2.0 * Curve::constant(3.0)).is_constant());
}

TEST(Curve, AProductIsDefinedWhereBothFactorsAre) {
  const Curve other = Curve::table({50, 800}, {2.0, 2.0}, temperature_axis());
  const Curve product = triangle() * other;
  EXPECT_EQ(product.range(), (Interval{50, 500}));
  EXPECT_DOUBLE_EQ(product(60), 4.0);
  EXPECT_THROW(product(40), Error);
  EXPECT_THROW(product(600), Error);
  expect_contains(message([&] {
                    triangle() * Curve::table({600, 800}, {1, 1}, temperature_axis());
                  }),
                  {"20 to 500", "600 to 800", "nothing in common"});
  expect_contains(message([&] {
                    triangle() * Curve::table({0, 60}, {1, 1}, time_axis());
                  }),
                  {"T [degC]", "t [s]"});
}

TEST(Curve, AnExpressionEqualsItsDirectEvaluation) {
  const Curve curve =
      formula("(1 - 0.1 * (T - 20) / 100)^2 + exp(-T / 300) * sqrt(T) - min(T, 50) / (T + 1)");
  for (double T = 20.0; T <= 800.0; T += 0.37) {
    const double direct = std::pow(1 - 0.1 * (T - 20) / 100, 2) + std::exp(-T / 300) * std::sqrt(T) -
                          std::min(T, 50.0) / (T + 1);
    // A handful of roundings of 1e-16 each, in an order that the parser may choose.
    EXPECT_NEAR(curve(T), direct, 1e-13 * std::abs(direct)) << T;
  }
  EXPECT_EQ(curve.range(), (Interval{20, 800}));
  EXPECT_THROW(curve(801), Error);
}

TEST(Curve, AnExpressionKnowsConditionsAndTheUsualPrecedence) {
  EXPECT_EQ(formula("T <= 60 ? 1 : (800 - T) / 740")(60), 1.0);
  EXPECT_DOUBLE_EQ(formula("T <= 60 ? 1 : (800 - T) / 740")(430), 0.5);
  EXPECT_EQ(formula("-T^2")(20), -400.0);
  EXPECT_EQ(formula("2^3^2 + 0 * T")(20), 512.0);
  EXPECT_DOUBLE_EQ(formula("ln(exp(T / 100))")(250), 2.5);
}

// Promise: any number but 0 is true, also between constants.
TEST(Curve, AnExpressionKnowsAndAndOr) {
  EXPECT_EQ(formula("T > 60 && T < 80 ? 1 : 2")(70), 1.0);
  EXPECT_EQ(formula("T < 60 || T > 80 ? 1 : 2")(70), 2.0);
  EXPECT_EQ(formula("0.5 && 1 ? T : 0")(70), 70.0);
  EXPECT_EQ(formula("0 || 1e300 ? T : 0")(70), 70.0);
}

TEST(Curve, AnExpressionOfTimeUsesItsOwnVariable) {
  const Curve ramp = Curve::expression("20 + 5 * t / 60", {0, 9360}, time_axis());
  EXPECT_DOUBLE_EQ(ramp(60), 25.0);
  expect_contains(message([&] { ramp(9361); }), {"t = 9361 s", "0 to 9360 s"});
  expect_contains(message([&] {
                    Curve::expression("20 + T", {0, 1}, time_axis());
                  }),
                  {"\"T\" is not known", "variable is t"});
}

TEST(Curve, WrongExpressionsAreRefusedWithPositionAndReason) {
  const auto refusal = [](const std::string& text) { return message([&] { formula(text); }); };
  expect_contains(refusal("2 * foo(3)"), {"\"2 * foo(3)\"", "character 5", "\"foo\" is not known"});
  expect_contains(refusal("1 + "), {"character 5", "ends too early"});
  expect_contains(refusal("sin(T"), {"parenthesis is missing"});
  expect_contains(refusal("0.5 T"), {"character 5", "operator may be missing"});
  expect_contains(refusal("T = 5"), {"character 3", "\"==\""});
  expect_contains(refusal("0,5"), {"2 values", "decimal sign is a point"});
  expect_contains(refusal("  "), {"empty"});
}

TEST(Curve, AnExpressionNeedsAFiniteRange) {
  for (const Interval range : {Interval{}, Interval{20, 20}, Interval{800, 20}, Interval{20, INFINITY}}) {
    expect_contains(message([&] { Curve::expression("T", range, temperature_axis()); }),
                    {"formula \"T\"", "finite interval"});
  }
}

TEST(Curve, AValueThatIsNotFiniteIsAnError) {
  const Curve curve = formula("1 / (T - 100)");
  EXPECT_DOUBLE_EQ(curve(101), 1.0);
  expect_contains(message([&] { curve(100); }), {"1 / (T - 100)", "no finite value", "T = 100 degC"});
}

TEST(Curve, ThreadsMayReadOneExpressionAtTheSameTime) {
  const Curve curve = 3.0 * formula("T^2 - sin(T) * exp(-T / 100)");
  const auto direct = [](double T) { return 3.0 * (T * T - std::sin(T) * std::exp(-T / 100)); };
  // More threads than the expression keeps parsers for, so that some must share.
  constexpr int threads = 130;
  std::latch start(threads);
  std::vector<double> worst(threads, 0.0);
  std::vector<std::thread> pool;
  for (int k = 0; k < threads; ++k) {
    pool.emplace_back([&, k] {
      start.arrive_and_wait();
      for (int i = 0; i < 20000; ++i) {
        const double T = 20.0 + std::fmod(0.731 * i + 13.0 * k, 780.0);
        worst[k] = std::max(worst[k], std::abs(curve(T) / direct(T) - 1.0));
      }
    });
  }
  for (std::thread& thread : pool) thread.join();
  // A parser used by two at once mixes up temperatures and is wrong in the first digits.
  for (const double error : worst) EXPECT_LT(error, 1e-13);
}

TEST(Curve, TheDescriptionSaysKindAndRange) {
  EXPECT_EQ(triangle().describe(), "table of 3 points, values 0.5 to 3, T = 20 to 500 degC");
  EXPECT_EQ(formula("1 - T / 1000").describe(), "formula \"1 - T / 1000\", T = 20 to 800 degC");
  EXPECT_EQ(triangle().described_as("test").describe(), "test, T = 20 to 500 degC");
  expect_contains((2.5 * triangle()).describe(), {"2.5", "table of 3 points", "T = 20 to 500 degC"});
}

// Promise: a reading that misses the range by rounding, 1e-12 of the largest magnitude, gets the value at the
// end; temperatures count from absolute zero. Any other one is refused.
TEST(Curve, IsReadAtItsEndsUpToRounding) {
  const Curve cold = Curve::table({-20.0, 0.0}, {1.0, 2.0}, temperature_axis());
  EXPECT_EQ(cold(2e-10), 2.0);
  EXPECT_TRUE(cold.holds({-20.0 - 2e-10, 2e-10}));
  EXPECT_FALSE(cold.holds(4e-10));
  EXPECT_THROW(cold(4e-10), Error);
  const Curve later = Curve::table({0.0, 3600.0}, {1.0, 2.0}, time_axis());
  EXPECT_EQ(later(3600.0 + 3e-9), 2.0);
  EXPECT_EQ(later(-3e-9), 1.0);
  EXPECT_THROW(later(3600.0 + 4e-9), Error);
  EXPECT_THROW(later(-4e-9), Error);
}

Curve of_file(const std::string& content) {
  const auto table = MeasuredTable::parse(content, "folder/strength.csv", kCurveColumns);
  return curve_of_table(table, {"strength.csv", {}, {}}, temperature_axis(), unit::stress);
}

TEST(CurveFile, ValuesAreConvertedFromTheUnitsOfTheHeader) {
  const Curve curve = of_file("# from a test\nT [K], strength [MPa]\r\n\n293.15, 35\n 373.15 ,\t17.5\n");
  EXPECT_DOUBLE_EQ(curve(20), 35e6);
  EXPECT_DOUBLE_EQ(curve(100), 17.5e6);
  expect_contains(curve.describe(), {"table file strength.csv"});
}

TEST(CurveFile, ErrorsNameFileAndLine) {
  const auto refusal = [](const std::string& content) { return message([&] { of_file(content); }); };
  const std::string file = "folder/strength.csv", header = "T [degC], f [MPa]\n";
  expect_contains(refusal("20, 1\n30, 2\n"),
                  {file + ":1:", "column 1 has no unit", "\"temperature [degC]\""});
  expect_contains(refusal(header + "20, 1\n30, x1\n"), {file + ":3:", "\"x1\" in column \"f\" is no number"});
  expect_contains(refusal(header + "20, 1\n30, 2\n40 3\n"),
                  {file + ":4:", "\"40 3\" holds no number (delimiter: \",\")"});
  expect_contains(refusal(header + "20, 1, 5\n"), {file + ":2:", "3 cells"});
  expect_contains(refusal(header + "20, 1\n\n20, 2\n"), {file + ":4:", "from line 2 to line 4"});
  expect_contains(refusal(header + "20, 1\n"), {file, "at least 2 points"});
  expect_contains(refusal("T [bar], f [MPa]\n20, 1\n"),
                  {file + ":1:", "unit \"bar\" has the wrong dimension"});
  expect_contains(refusal(""), {file, "is empty"});
}

TEST(Expression, KeepsWorkingAfterAMove) {
  Expression first("2 * T", "T");
  EXPECT_EQ(first(3.0), 6.0);
  const Expression second = std::move(first);
  EXPECT_EQ(second(4.0), 8.0);
}

}  // namespace
}  // namespace pyroclast
