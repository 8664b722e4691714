#include "pyroclast/thermal/heat_material.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "known.hpp"
#include "messages.hpp"
#include "pyroclast/material/builtin_curves.hpp"

namespace pyroclast {
namespace {

constexpr Interval range{20.0, 1200.0};
constexpr double window = 5.0;

std::string message(const HeatMaterial& material) {
  return pyroclast::message([&] { HeatTable(material, "mortar", TemperatureGrid(range), window); });
}

HeatMaterial concrete() {
  return {builtin_curves().at("en1992_conductivity_upper").curve, en1992_specific_heat(3.0) * 2300.0};
}

TEST(HeatTableVerification, EnthalpyIsTheIntegralOfTheMoisturePeak) {
  const HeatTable table(concrete(), "mortar", TemperatureGrid(range), window);
  // EN 1992-1-2 3.3.2 at 3 %: 900 to 100 degC, 2020 to 115, falling to 1000 at 200, rising to 1100 at 400.
  const double exact =
      2300.0 * (80.0 * 900.0 + 15.0 * 2020.0 + 85.0 * 1510.0 + 200.0 * 1050.0 + 800.0 * 1100.0);
  // The jump at 100 degC is cornered to 0.1 K / 2^40.
  expect_known({"Heat of concrete of 3 % moisture from 20 to 1200 degC",
                "EN 1992-1-2, 3.3.2, integrated by hand", "J/m3"},
               table.enthalpy(12000) - table.enthalpy(200), exact, 1e-12 * exact);
}

TEST(HeatTable, BoundsHoldWithinTheWindow) {
  const HeatMaterial material = concrete();
  const HeatTable table(material, "mortar", TemperatureGrid(range), window);
  for (double t = 20.0; t <= 1200.0; t += 0.7) {
    const double low = std::max(t - window, 20.0), high = std::min(t + window, 1200.0);
    // The table's capacity is the mean over 0.1 K, in which the peak falls by up to 0.12 %.
    EXPECT_LE(table.least_capacity(t), material.heat_capacity(low) * 1.0012);
    EXPECT_LE(table.least_capacity(t), material.heat_capacity(high) * 1.0012);
    EXPECT_GE(table.greatest_conductivity(t), material.conductivity(low) * (1.0 - 1e-9));
    EXPECT_NEAR(table.conductivity(t), material.conductivity(t), 1e-6);  // (0.1 K)² / 8 times the curvature
  }
}

/// Moist concrete whose curves go on below the datum.
HeatMaterial cold_concrete() {
  return {Curve::table({-50.0, 200.0, 1200.0}, {2.0, 1.7, 0.6}, temperature_axis()),
          Curve::table({-50.0, 99.97, 115.0, 200.0, 1200.0}, {1.9e6, 2.1e6, 4.6e6, 2.3e6, 2.5e6},
                       temperature_axis())};
}

TEST(HeatTable, WhatStandsAtAKnotDoesNotDependOnTheRange) {
  const TemperatureGrid narrow({150.03, 300.0}), wide({-40.0, 1200.0});
  const HeatTable at_once(cold_concrete(), "mortar", wide, window);
  HeatTable table(cold_concrete(), "mortar", narrow, window);
  const auto expect_same = [&](const TemperatureGrid& grid) {
    for (int cell = grid.first_cell(); cell <= grid.last_cell(); ++cell) {
      ASSERT_EQ(table.enthalpy(cell), at_once.enthalpy(cell)) << TemperatureGrid::knot(cell);
      const double t = TemperatureGrid::knot(cell) + 0.043;
      ASSERT_EQ(table.conductivity(t), at_once.conductivity(t)) << t;
    }
  };
  expect_same(narrow);
  table.extend(TemperatureGrid({20.0, 700.0}));
  expect_same(TemperatureGrid({20.0, 700.0}));
  table.extend(wide);
  expect_same(wide);
  for (double t = -40.0; t <= 1200.0; t += 0.7) {
    ASSERT_EQ(table.least_capacity(t), at_once.least_capacity(t)) << t;
    ASSERT_EQ(table.greatest_conductivity(t), at_once.greatest_conductivity(t)) << t;
  }
}

TEST(HeatTable, TheEnthalpyIsZeroAtTheReferenceTemperatureOrTheNearestEndOfTheCurve) {
  const HeatTable cold(cold_concrete(), "mortar", TemperatureGrid({-40.0, 100.0}), window);
  EXPECT_EQ(cold.enthalpy(200), 0.0);
  EXPECT_LT(cold.enthalpy(199), 0.0);
  auto hot = cold_concrete();
  hot.heat_capacity = Curve::table({300.0, 1200.0}, {2e6, 2e6}, temperature_axis());
  EXPECT_EQ(HeatTable(hot, "mortar", TemperatureGrid({400.0, 500.0}), window).enthalpy(3000), 0.0);
}

TEST(HeatTable, ACellThatReachesBeyondACurveTakesTheValueAtItsEnd) {
  const HeatMaterial material{Curve::table({20.05, 60.02}, {1.0, 2.0}, temperature_axis()),
                              Curve::table({20.05, 60.02}, {2e6, 3e6}, temperature_axis())};
  const HeatTable table(material, "mortar", TemperatureGrid({20.05, 60.02}), window);
  const double at_60 = material.heat_capacity(60.0), rounding = 1e-3;  // of 1e8 J/m³
  EXPECT_NEAR(table.enthalpy(600) - table.enthalpy(200), 0.05 * 2e6 + 39.95 * 0.5 * (2e6 + at_60), rounding);
  EXPECT_NEAR(table.enthalpy(601) - table.enthalpy(600), 0.02 * 0.5 * (at_60 + 3e6) + 0.08 * 3e6, rounding);
  EXPECT_DOUBLE_EQ(table.conductivity(60.02),
                   table.conductivity(60.0) + 0.2 * (2.0 - table.conductivity(60.0)));
}

TEST(HeatTable, RefusesCurvesThatDoNotCoverTheRange) {
  auto material = concrete();
  material.conductivity = Curve::table({20.0, 800.0}, {2.0, 1.0}, temperature_axis());
  const std::string text = message(material);
  EXPECT_NE(text.find("mortar"), std::string::npos) << text;
  EXPECT_NE(text.find("conductivity"), std::string::npos) << text;
  EXPECT_NE(text.find("20 to 1200"), std::string::npos) << text;
}

TEST(HeatTable, RefusesValuesThatAreNotPositive) {
  auto material = concrete();
  material.heat_capacity = Curve::table({20.0, 1200.0}, {2e6, 0.0}, temperature_axis());
  EXPECT_NE(message(material).find("heat capacity"), std::string::npos);
}

TEST(HeatTable, RefusesCurvesOfTime) {
  auto material = concrete();
  material.heat_capacity = Curve::table({0.0, 5000.0}, {2e6, 1e6}, time_axis());
  EXPECT_NE(message(material).find("function of t"), std::string::npos);
}

TEST(NodeEnthalpy, IsInvertedForNodesOfTwoMaterials) {
  const TemperatureGrid grid(range);
  std::vector<HeatTable> tables;
  tables.emplace_back(concrete(), "mortar", grid, window);
  tables.emplace_back(HeatMaterial{Curve::constant(2.0), Curve::constant(2e6)}, "aggregate", grid, window);
  const NodeEnthalpy store(grid, tables, {{{0, 1e-6}, {1, 3e-6}}, {{0, 2e-6}}});
  for (int node : {0, 1})
    for (double t = 20.0; t <= 1200.0; t += 0.37)
      for (double near : {20.0, 100.0, 1200.0})
        EXPECT_NEAR(store.temperature(node, store.enthalpy(node, t), near), t, 1e-9);  // rounding of 1e3 K
}

TEST(NodeEnthalpy, KeepsItsBitsWhenTheRangeWidens) {
  const TemperatureGrid narrow({20.0, 300.03}), wide({-40.0, 1200.0});
  std::vector<HeatTable> tables;
  tables.emplace_back(cold_concrete(), "mortar", narrow, window);
  NodeEnthalpy store(narrow, tables, {{{0, 1e-6}}});
  std::vector<double> enthalpy, temperature;
  for (double t = 20.01; t <= 300.0; t += 0.37) {
    enthalpy.push_back(store.enthalpy(0, t));
    temperature.push_back(store.temperature(0, enthalpy.back(), t));
  }
  tables[0].extend(wide);
  store.set_grid(wide);
  std::size_t i = 0;
  for (double t = 20.01; t <= 300.0; t += 0.37, ++i) {
    ASSERT_EQ(store.enthalpy(0, t), enthalpy[i]) << t;
    ASSERT_EQ(store.temperature(0, enthalpy[i], t), temperature[i]) << t;
  }
}

// Promise: every enthalpy has a temperature of the range, also where an end of the range is 0, the datum or
// the end of a curve, and the enthalpy next to what is there: rounding takes nobody out of the table.
TEST(NodeEnthalpy, IsSafeAtEveryEnd) {
  const double ends[] = {-40.0, -0.1, 0.0, 5.0, 10.0, 19.9, 20.0, 20.05, 300.03, 1200.0};
  const HeatMaterial even{Curve::constant(2.0), Curve::constant(2.2e6)};
  for (const HeatMaterial& material : {even, cold_concrete()})
    for (const double lower : ends)
      for (const double upper : ends) {
        if (lower >= upper) continue;
        const TemperatureGrid grid({lower, upper});
        std::vector<HeatTable> tables;
        tables.emplace_back(material, "mortar", grid, window);
        const NodeEnthalpy store(grid, tables, {{{0, 3.3e-6}, {0, 1.7e-7}}});
        for (const double at : {lower, upper, 0.5 * (lower + upper)})
          for (const double near : {lower, upper}) {
            double enthalpy = store.enthalpy(0, at);
            for (int i = 0; i < 8; ++i) enthalpy = std::nextafter(enthalpy, -1e300);
            for (int i = 0; i < 16; ++i, enthalpy = std::nextafter(enthalpy, 1e300)) {
              const double temperature = store.temperature(0, enthalpy, near);
              ASSERT_GE(temperature, lower);
              ASSERT_LE(temperature, upper);
              ASSERT_NEAR(temperature, at, 1e-9);
            }
          }
      }
}

TEST(NodeEnthalpy, HoldsTheEndsOfTheRangeAndSaysByHowMuch) {
  const TemperatureGrid grid(range);
  std::vector<HeatTable> tables;
  tables.emplace_back(HeatMaterial{Curve::constant(2.0), Curve::constant(2e6)}, "aggregate", grid, window);
  const NodeEnthalpy store(grid, tables, {{{0, 1e-6}}});
  const double full = store.enthalpy(0, 1200.0);
  EXPECT_EQ(store.temperature(0, -3.0 * 2.0, 20.0), 20.0);
  EXPECT_NEAR(store.excess(0, -3.0 * 2.0), -3.0, 1e-9);
  EXPECT_EQ(store.temperature(0, full + 2.0, 20.0), 1200.0);
  EXPECT_NEAR(store.excess(0, full + 2.0), 1.0, 1e-6);
  EXPECT_EQ(store.excess(0, 0.5 * full), 0.0);
}

}  // namespace
}  // namespace pyroclast
