#include "pyroclast/material/thermal_strain.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/material/builtin_curves.hpp"

// of its own, as tests of a module are one unit
namespace pyroclast::thermal_strain_test {
namespace {

constexpr Interval kFire{20.0, 800.0};
constexpr double T0 = 20.0;

Curve strain(const char* builtin, ExpansionReading reading) {
  return free_thermal_strain(builtin_curves().at(builtin).curve, reading, kFire);
}

// Relative 1e-12: rounding of a few operations.
void expect_close(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-12 * std::abs(expected) + 1e-18);
}
void expect_close(const Known& known, double value, double expected) {
  expect_known(known, value, expected, 1e-12 * std::abs(expected) + 1e-18);
}

TEST(ThermalStrainVerification, SecantIsEquation18TimesTheTemperatureRise) {
  const Curve aggregate = strain("paper_aggregate_expansion", ExpansionReading::secant);
  const Curve mortar = strain("paper_mortar_expansion", ExpansionReading::secant);
  for (const double T : {20.0, 20.5, 122.5, 433.3, 800.0}) {
    expect_close({"Thermal strain of aggregate, secant reading", "the paper, Eq. (18)", "1"}, aggregate(T),
                 (9e-6 + 7e-8 * T) * (T - T0));
    expect_close({"Thermal strain of mortar, secant reading", "the paper, Eq. (18)", "1"}, mortar(T),
                 (9e-7 - 6e-11 * T * T) * (T - T0));
  }
}

TEST(ThermalStrainVerification, TangentIsTheIntegralOfEquation18) {
  const Curve aggregate = strain("paper_aggregate_expansion", ExpansionReading::tangent);
  const Curve mortar = strain("paper_mortar_expansion", ExpansionReading::tangent);
  for (const double T : {20.0, 20.5, 122.5, 433.3, 800.0}) {
    expect_close({"Thermal strain of aggregate, tangent reading", "integral of Eq. (18)", "1"}, aggregate(T),
                 9e-6 * (T - T0) + 3.5e-8 * (T * T - T0 * T0));
    expect_close({"Thermal strain of mortar, tangent reading", "integral of Eq. (18)", "1"}, mortar(T),
                 9e-7 * (T - T0) - 2e-11 * (T * T * T - T0 * T0 * T0));
  }
}

// Promise: below its range the step changes no bit, above it is all there, and in between it comes without
// kinks.
TEST(QuartzStep, ComesSmoothlyInItsRange) {
  const Curve plain = strain("paper_aggregate_expansion", ExpansionReading::tangent);
  const Curve stepped = with_quartz_step(plain, {.strain = 3.5e-3}, kFire);
  for (const double T : {20.0, 300.0, 549.9, 550.0}) EXPECT_EQ(stepped(T), plain(T)) << T;
  for (const double T : {600.0, 600.1, 800.0}) EXPECT_EQ(stepped(T), plain(T) + 3.5e-3) << T;
  const auto added = [&](double T) { return stepped(T) - plain(T); };
  EXPECT_NEAR(added(575.0), 0.5 * 3.5e-3, 1e-15);
  EXPECT_NEAR(added(562.5), 3.5e-3 * (3.0 / 16.0 - 2.0 / 64.0), 1e-15);
  for (const double T : {550.0, 600.0}) EXPECT_NEAR((added(T + 0.01) - added(T - 0.01)) / 0.02, 0.0, 1e-7);
  const Curve elsewhere = with_quartz_step(Curve::constant(0.0), {2e-3, {500.0, 520.0}}, kFire);
  EXPECT_EQ(elsewhere(510.0), 1e-3);
  EXPECT_EQ(elsewhere.range(), kFire);
  EXPECT_EQ(elsewhere.maximum(20.0, 800.0), 2e-3);
}

TEST(ThermalStrain, OfAConstantIsTheSameInBothReadings) {
  const Curve expansion = Curve::constant(-1e-5);
  for (const ExpansionReading reading : {ExpansionReading::secant, ExpansionReading::tangent}) {
    const Curve contraction = free_thermal_strain(expansion, reading, {-50.0, 800.0});
    expect_close(contraction(520.0), -5e-3);
    expect_close(contraction(-30.0), 5e-4);
    EXPECT_NEAR(contraction(20.0), 0.0, 1e-17);
  }
}

// A kink of a table, a jump of an expression: neither lies at a knot.
TEST(ThermalStrain, TangentSeesKinksAndJumps) {
  const Curve kinked = Curve::table({20.0, 100.3, 800.0}, {1e-5, 3e-5, 0.0}, temperature_axis());
  const Curve strain_of_kinked = free_thermal_strain(kinked, ExpansionReading::tangent, kFire);
  const double first = 0.5 * 80.3 * 4e-5;
  const double slope = 3e-5 / 699.7;
  for (const double T : {100.3, 100.4, 500.0, 800.0}) {
    const double since = T - 100.3;
    // The promise of the header of Curve's integral, over 800 cells.
    EXPECT_NEAR(strain_of_kinked(T), first + 3e-5 * since - 0.5 * slope * since * since, 1e-9 * first) << T;
  }
  const Curve jump = Curve::expression("T < 400.7 ? 1e-5 : -2e-5", kFire, temperature_axis());
  const Curve strain_of_jump = free_thermal_strain(jump, ExpansionReading::tangent, kFire);
  EXPECT_NEAR(strain_of_jump(800.0), 380.7e-5 - 2e-5 * 399.3, 1e-9 * 380.7e-5);
  EXPECT_NEAR(strain_of_jump(400.9), 380.7e-5 - 2e-5 * 0.2, 1e-9 * 380.7e-5);
}

TEST(ThermalStrain, EndsWhereTheCoefficientEnds) {
  const Curve short_one = Curve::table({0.0, 400.0}, {1e-5, 1e-5}, temperature_axis());
  for (const ExpansionReading reading : {ExpansionReading::secant, ExpansionReading::tangent}) {
    const Curve limited = free_thermal_strain(short_one, reading, kFire);
    EXPECT_EQ(limited.range(), (Interval{20.0, 400.0}));
    EXPECT_THROW(limited(401.0), Error);
    EXPECT_THROW(free_thermal_strain(short_one, reading, {500.0, 800.0}), Error);
  }
}

TEST(ThermalStrain, TangentNeedsTheReferenceTemperature) {
  const Curve hot = Curve::table({100.0, 800.0}, {1e-5, 1e-5}, temperature_axis());
  EXPECT_THROW(free_thermal_strain(hot, ExpansionReading::tangent, kFire), Error);
  expect_close(free_thermal_strain(hot, ExpansionReading::secant, kFire)(120.0), 1e-3);
}

TEST(ThermalStrain, SaysWhereItComesFrom) {
  const Curve aggregate = strain("paper_aggregate_expansion", ExpansionReading::tangent);
  EXPECT_NE(aggregate.describe().find(
                "integral of alpha from 20 degC, alpha built-in curve paper_aggregate_expansion"),
            std::string::npos)
      << aggregate.describe();
}

}  // namespace
}  // namespace pyroclast::thermal_strain_test
