#include "pyroclast/material/builtin_curves.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/lasting.hpp"

namespace pyroclast {
namespace {

using Points = std::vector<std::pair<double, double>>;

PYROCLAST_LASTING const Curve& builtin(const std::string& name) {
  return builtin_curves().at(name).curve;
}

/// For values that the source prints: the curve must give the same double.
void expect_exactly(const std::string& name, const Points& points) {
  for (const auto& [T, value] : points)
    expect_known({"Curve " + name, "EN 1992-1-2, as printed", builtin_curves().at(name).unit},
                 builtin(name)(T), value, 0.0);
}

TEST(BuiltinCurvesVerification, StrengthsAreThoseOfTable3_1) {
  expect_exactly("en1992_siliceous_strength", {{20, 1.00},
                                               {100, 1.00},
                                               {200, 0.95},
                                               {300, 0.85},
                                               {400, 0.75},
                                               {500, 0.60},
                                               {600, 0.45},
                                               {700, 0.30},
                                               {800, 0.15},
                                               {900, 0.08},
                                               {1000, 0.04},
                                               {1100, 0.01},
                                               {1200, 0.00}});
  expect_exactly("en1992_calcareous_strength", {{20, 1.00},
                                                {100, 1.00},
                                                {200, 0.97},
                                                {300, 0.91},
                                                {400, 0.85},
                                                {500, 0.74},
                                                {600, 0.60},
                                                {700, 0.43},
                                                {800, 0.27},
                                                {900, 0.15},
                                                {1000, 0.06},
                                                {1100, 0.02},
                                                {1200, 0.00}});
}

TEST(BuiltinCurvesVerification, StrainsAreThoseOfTable3_1) {
  for (const double T : {600.0, 700.0, 800.0, 900.0, 1000.0, 1100.0}) {
    EXPECT_EQ(builtin("en1992_peak_strain")(T), 0.025) << T;
  }
  expect_exactly("en1992_peak_strain",
                 {{20, 0.0025}, {100, 0.004}, {200, 0.0055}, {300, 0.007}, {400, 0.01}, {500, 0.015}});
  expect_exactly("en1992_ultimate_strain", {{20, 0.02},
                                            {100, 0.0225},
                                            {200, 0.025},
                                            {300, 0.0275},
                                            {400, 0.03},
                                            {500, 0.0325},
                                            {600, 0.035},
                                            {700, 0.0375},
                                            {800, 0.04},
                                            {900, 0.0425},
                                            {1000, 0.045},
                                            {1100, 0.0475}});
}

TEST(BuiltinCurves, TensileStrengthFallsLinearlyFrom100To600) {
  EXPECT_EQ(builtin("en1992_tensile_strength")(100), 1.0);
  for (double T = 100.0; T <= 600.0; T += 12.5) {
    EXPECT_NEAR(builtin("en1992_tensile_strength")(T), 1.0 - (T - 100.0) / 500.0, 1e-15) << T;
  }
  EXPECT_THROW(builtin("en1992_tensile_strength")(601), Error);
}

TEST(BuiltinCurves, ElongationReachesThePlateauOfTheStandardWithoutAJump) {
  // The polynomials pass the plateau by 9e-6 and 1.4e-5 where the standard switches.
  EXPECT_EQ(builtin("en1992_siliceous_elongation")(700), 14e-3);
  EXPECT_EQ(builtin("en1992_siliceous_elongation")(1200), 14e-3);
  EXPECT_EQ(builtin("en1992_calcareous_elongation")(805), 12e-3);
  EXPECT_EQ(builtin("en1992_calcareous_elongation")(1200), 12e-3);
  // -1.8e-4 + 9e-6 * 500 + 2.3e-11 * 500^3 and -1.2e-4 + 6e-6 * 500 + 1.4e-11 * 500^3, by hand.
  EXPECT_NEAR(builtin("en1992_siliceous_elongation")(500), 7.195e-3, 1e-15);
  EXPECT_NEAR(builtin("en1992_calcareous_elongation")(500), 4.63e-3, 1e-15);
}

TEST(BuiltinCurves, SecantExpansionTimesTemperatureRiseIsTheElongationSince20) {
  for (const std::string kind : {"siliceous", "calcareous"}) {
    const Curve& elongation = builtin("en1992_" + kind + "_elongation");
    const Curve& expansion = builtin("en1992_" + kind + "_expansion");
    for (double T = 20.0; T <= 1200.0; T += 7.0) {
      EXPECT_NEAR(expansion(T) * (T - 20.0), elongation(T) - elongation(20.0), 1e-16) << kind << " at " << T;
    }
    // The limit at 20 degC is the slope there; the difference quotient over 1e-3 K is good to 1e-12.
    EXPECT_NEAR(expansion(20.0), (elongation(20.001) - elongation(20.0)) / 1e-3, 1e-11) << kind;
  }
}

TEST(BuiltinCurves, AirConductsAsTablesOfAirSay) {
  // Rounded values of common tables at 27, 127, 327, 527, 727 and 927 degC: within the 3 % of law and tables.
  for (const auto& [T, k] : {std::pair{27.0, 0.0263},
                             {127.0, 0.0338},
                             {327.0, 0.0469},
                             {527.0, 0.0573},
                             {727.0, 0.0667},
                             {927.0, 0.0763}})
    EXPECT_NEAR(builtin("air_conductivity")(T), k, 0.03 * k) << T;
}

TEST(BuiltinCurves, ConductivityLimitsFollowTheirPolynomials) {
  // 2 - 0.2451 + 0.0107 and 1.36 - 0.136 + 0.0057 at 100 degC, by hand.
  EXPECT_NEAR(builtin("en1992_conductivity_upper")(100), 1.7656, 1e-14);
  EXPECT_NEAR(builtin("en1992_conductivity_lower")(100), 1.2297, 1e-14);
  for (double T = 20.0; T <= 1200.0; T += 10.0) {
    EXPECT_LT(builtin("en1992_conductivity_lower")(T), builtin("en1992_conductivity_upper")(T)) << T;
  }
}

TEST(BuiltinCurvesVerification, SpecificHeatHasTheMoisturePeaksOfTheStandard) {
  expect_exactly("en1992_specific_heat_u0", {{20, 900}, {100, 900}, {200, 1000}, {400, 1100}, {1200, 1100}});
  expect_exactly("en1992_specific_heat_u1_5", {{99.9, 900}, {100, 1470}, {115, 1470}, {200, 1000}});
  expect_exactly("en1992_specific_heat_u3",
                 {{99.9, 900}, {100, 2020}, {115, 2020}, {200, 1000}, {400, 1100}});
  EXPECT_EQ(builtin("en1992_specific_heat_u3").maximum(20, 1200), 2020.0);
}

TEST(BuiltinCurves, SpecificHeatPeakIsLinearInMoistureBetweenTheTabulatedOnes) {
  EXPECT_DOUBLE_EQ(en1992_specific_heat(0.75)(110), 0.5 * (900 + 1470));
  EXPECT_DOUBLE_EQ(en1992_specific_heat(2.25)(110), 0.5 * (1470 + 2020));
  for (double T = 20.0; T <= 1200.0; T += 2.5) {
    EXPECT_GE(en1992_specific_heat(0.1)(T), en1992_specific_heat(0.0)(T)) << T;
  }
  for (const double moisture : {-0.1, 3.1, std::nan("")}) EXPECT_THROW(en1992_specific_heat(moisture), Error);
}

TEST(BuiltinCurvesVerification, DensityFollowsItsFourBranches) {
  expect_exactly("en1992_density", {{20, 1.0}, {115, 1.0}, {200, 0.98}, {400, 0.95}, {1200, 0.88}});
  EXPECT_NEAR(builtin("en1992_density")(150), 1.0 - 0.02 * 35.0 / 85.0, 1e-15);
  EXPECT_NEAR(builtin("en1992_density")(800), 0.95 - 0.035, 1e-15);
}

TEST(BuiltinCurves, ModulusRatiosStartAtOneFallAndStayPositiveOverTheirRange) {
  for (const std::string name : {"glasgow_modulus", "li_purkiss_modulus", "en1992_apparent_modulus"}) {
    const Curve& curve = builtin(name);
    const Interval range = curve.range();
    EXPECT_EQ(curve(20.0), 1.0) << name;
    EXPECT_GT(curve.minimum(range.lower, range.upper), 0.0) << name;
    for (double T = range.lower; T + 1.0 <= range.upper; T += 1.0)
      EXPECT_LE(curve(T + 1.0), curve(T)) << name;
  }
}

TEST(BuiltinCurves, ModulusRatiosFollowTheirSources) {
  // theta = 5: (1 - 0.5)^2.
  EXPECT_DOUBLE_EQ(builtin("glasgow_modulus")(520), 0.25);
  for (double T = 60.0; T <= 780.0; T += 15.0) {
    EXPECT_NEAR(builtin("li_purkiss_modulus")(T), (800.0 - T) / 740.0, 1e-15) << T;
  }
  // (0.60 / 0.015) / (1 / 0.0025) from the table at 500 degC.
  EXPECT_DOUBLE_EQ(builtin("en1992_apparent_modulus")(500), 0.1);
}

TEST(BuiltinCurves, TheReportedTransientDataOfOtherGroupsFollowTheirFormulas) {
  // theta = 5 at 520 degC, by hand.
  EXPECT_DOUBLE_EQ(builtin("glasgow_tensile_strength")(520), 0.6);
  EXPECT_DOUBLE_EQ(builtin("glasgow_fracture_energy")(520), 1.2);
  EXPECT_DOUBLE_EQ(builtin("glasgow_fracture_energy")(700), 0.4152);
  EXPECT_NEAR(builtin("glasgow_fracture_energy")(720), 0.4152 - 0.2 * 0.562, 1e-12);
  EXPECT_DOUBLE_EQ(builtin("glasgow_fracture_energy")(800), 0.2);
  EXPECT_DOUBLE_EQ(builtin("glasgow_free_thermal_strain")(520), 0.006 * std::log(3.5));
  EXPECT_DOUBLE_EQ(builtin("glasgow_free_thermal_strain")(800), 0.006 * std::log(7.0));
  EXPECT_NEAR(builtin("li_purkiss_strength")(500), 1.002 + 0.125 - 0.75 + 0.20625, 1e-15);
  EXPECT_NEAR(builtin("asce_siliceous_conductivity")(400), 1.25, 1e-15);
  for (const auto& [T, value] :
       Points{{100, 2.2e6}, {300, 2.7e6}, {450, 3.35e6}, {550, 3.35e6}, {700, 2.7e6}}) {
    EXPECT_NEAR(builtin("asce_siliceous_heat_capacity")(T), value, 1e-8) << T;
  }
}

// Per mille at 100, 200, ... degC, as worked out apart from the published formulas.
TEST(BuiltinCurves, OfCreepAreWhatTheirFormulasGive) {
  const auto expect = [](const char* name, std::vector<double> per_mille, double tolerance) {
    const Curve curve = builtin(name);
    EXPECT_EQ(curve(20), 0.0) << name;
    EXPECT_FALSE(curve.first_fall(20, 800)) << name;
    for (std::size_t i = 0; i < per_mille.size(); ++i)
      EXPECT_NEAR(1e3 * curve(100.0 * (static_cast<double>(i) + 1.0)), per_mille[i], tolerance) << name << i;
  };
  expect("glasgow_creep", {1.32, 3.87, 7.42, 11.97, 18.24, 37.59}, 0.0051);
  // above the published integral from 20 degC by what its polynomial falls to 32.3 degC, 0.054
  expect("torelli_creep", {1.016 + 0.054, 3.655 + 0.054, 5.324 + 0.054, 7.338 + 0.054, 13.611 + 0.054},
         0.001);
  expect("etc_creep", {1.0, 1.75, 2.35, 4.89, 10.56, 26.67, 42.78, 58.89}, 1e-9);
  const auto slope = [](const char* name, double T) { return (builtin(name)(T + 1) - builtin(name)(T)); };
  EXPECT_NEAR(slope("torelli_creep", 501), 1.00257e-4, 1e-9);
  EXPECT_NEAR(slope("torelli_creep", 780), 1.00257e-4, 1e-9);
  EXPECT_NEAR(slope("glasgow_creep", 469), 5.745e-5, 1e-10);  // no jump of the slope
  EXPECT_NEAR(slope("glasgow_creep", 470), 5.835e-5, 1e-10);
}

TEST(BuiltinCurves, TheExpansionOfThePaperIsAsPrinted) {
  EXPECT_DOUBLE_EQ(builtin("paper_aggregate_expansion")(500), 4.4e-5);
  EXPECT_DOUBLE_EQ(builtin("paper_mortar_expansion")(500), -1.41e-5);
  EXPECT_DOUBLE_EQ(builtin("paper_aggregate_expansion")(20), 1.04e-5);
}

TEST(BuiltinCurves, OnlyTheMoisturePeakJumps) {
  const std::set<std::string> jumping = {"en1992_specific_heat_u1_5", "en1992_specific_heat_u3"};
  for (const NamedCurve& entry : builtin_curves().entries()) {
    const Interval range = entry.curve.range();
    const double scale =
        entry.curve.maximum(range.lower, range.upper) - entry.curve.minimum(range.lower, range.upper);
    // No slope is steeper than the whole height over 5 K, so a millikelvin moves less than 1e-3 of the
    // height; every break of the sources lies on a multiple of 5 degC.
    double largest = 0.0;
    for (double T = range.lower + 5.0; T < range.upper; T += 5.0) {
      largest = std::max(largest, std::abs(entry.curve(T + 5e-4) - entry.curve(T - 5e-4)));
    }
    EXPECT_EQ(largest > 1e-3 * scale, jumping.contains(entry.name)) << entry.name;
  }
}

TEST(BuiltinCurves, NoneIsReadOutsideItsRange) {
  for (const NamedCurve& entry : builtin_curves().entries()) {
    const Interval range = entry.curve.range();
    EXPECT_LE(range.lower, 20.0) << entry.name;
    EXPECT_NO_THROW(entry.curve(range.lower)) << entry.name;
    EXPECT_NO_THROW(entry.curve(range.upper)) << entry.name;
    EXPECT_THROW(entry.curve(range.lower - 0.01), Error) << entry.name;
    EXPECT_THROW(entry.curve(range.upper + 0.01), Error) << entry.name;
  }
}

TEST(BuiltinCurves, EveryEntrySaysWhatItIs) {
  std::set<std::string> names;
  for (const NamedCurve& entry : builtin_curves().entries()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " stands twice";
    EXPECT_FALSE(entry.description.empty() || entry.source.empty() || entry.unit.empty()) << entry.name;
    EXPECT_EQ(entry.curve.axis(), temperature_axis()) << entry.name;
    EXPECT_NE(entry.curve.describe().find(entry.name), std::string::npos);
    EXPECT_NE(entry.curve.describe().find(entry.source), std::string::npos);
  }
}

TEST(BuiltinCurves, AnUnknownNameIsAnsweredWithTheNearestAndAll) {
  try {
    builtin_curves().at("en1992_silicious_strength");
    FAIL() << "no Error was thrown";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("nearest is \"en1992_siliceous_strength\""), std::string::npos) << message;
    EXPECT_NE(message.find("paper_mortar_expansion"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace pyroclast
