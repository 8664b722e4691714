#include "pyroclast/stages/compression_response.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "known.hpp"
#include "result_of.hpp"

namespace pyroclast {
namespace {

/// A test that follows the parabola with modulus E and peak f at 2 f / E, to `last` of the peak strain.
CompressionCurve parabola(double modulus, double strength, double last) {
  CompressionCurve rows;
  const double peak = 2.0 * strength / modulus;
  for (int i = 1; i <= 1000; ++i) {
    const double strain = last * peak * i / 1000.0;
    rows.strain.push_back(strain);
    rows.stress.push_back(modulus * strain * (1.0 - 0.5 * strain / peak));
    rows.platen_difference.push_back(0.0);
    rows.kinetic_over_strain.push_back(0.0);
    rows.time.push_back(1e-3 * i);
  }
  return rows;
}

TEST(ResponseVerification, FindsModulusStrengthAndInelasticStrainOfAParabola) {
  const auto r = compression_response(parabola(21.5e9, 35e6, 1.3));
  ASSERT_TRUE(r.strength);
  expect_known({"f_c read from a curve", "a parabola", "Pa"}, *r.strength, 35e6, 1e3);
  const double strain_at_peak = parabola(21.5e9, 35e6, 1.3).strain[r.peak];
  EXPECT_NEAR(strain_at_peak, 70e6 / 21.5e9, 5e-6);
  // the chord through 5 % and 1/3 of the strength lies below the tangent by 9 to 12 % on this parabola
  ASSERT_TRUE(r.modulus && r.inelastic_strain);
  EXPECT_LT(*r.modulus, 0.91 * 21.5e9);
  EXPECT_GT(*r.modulus, 0.88 * 21.5e9);
  EXPECT_DOUBLE_EQ(*r.inelastic_strain, strain_at_peak - *r.strength / *r.modulus);
}

/// Adds a straight stretch to a curve, in even steps of 1e-5 of strain.
void go_on(CompressionCurve& curve, double to_stress, double over_strain) {
  const double from_stress = curve.count() > 0 ? curve.stress.back() : 0.0;
  const double from_strain = curve.count() > 0 ? curve.strain.back() : 0.0;
  const int points = static_cast<int>(std::lround(over_strain / 1e-5));
  for (int i = 1; i <= points; ++i) {
    const double share = static_cast<double>(i) / points;
    curve.strain.push_back(from_strain + share * over_strain);
    curve.stress.push_back(from_stress + share * (to_stress - from_stress));
    curve.platen_difference.push_back(0.0);
    curve.kinetic_over_strain.push_back(0.0);
    curve.time.push_back(curve.strain.back());
  }
}

// Promise: f_c is the strength, not the hardening of a specimen that has failed. It is in doubt then, and so
// is all that belongs to its peak; E is not.
TEST(Response, WhatHardensBehindAFailureIsNoStrength) {
  CompressionCurve curve;
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 24e6, 5e-4);
  go_on(curve, 45e6, 8e-3);
  const auto report = compression_report(curve);
  EXPECT_DOUBLE_EQ(number(report, "f_c_MPa"), 30.0);
  EXPECT_DOUBLE_EQ(number(report, "strain_at_peak"), 2e-3);
  EXPECT_DOUBLE_EQ(number(report, "stress_max_MPa"), 45.0);
  EXPECT_DOUBLE_EQ(number(report, "strain_at_stress_max"), 0.0105);
  EXPECT_EQ(report.lines[1], "rises again behind f_c, to 45.00 MPa (+50 %) at strain 0.01050");
  // every fall tells the same
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("the specimen hardens behind its peak: from f_c, 30.00 MPa, the stress "
                                    "falls by more than 10 % and rises to 45.00 MPa at strain 0.01050"),
            std::string::npos);
  for (const char* name : {"f_c", "strain_at_peak", "strain_ic"})
    EXPECT_EQ(value_of(report, std::string(name) + "_doubtful_because"), Result::Value(report.warnings[0]))
        << name;
}

// Promise: a stress that comes back up to 5 % above f_c behind a failure leaves no doubt; a curve that falls
// has none either.
TEST(Response, ARiseWithinFivePercentLeavesNoDoubt) {
  const auto back_to = [](double stress) {
    CompressionCurve curve;
    go_on(curve, 30e6, 2e-3);
    go_on(curve, 24e6, 5e-4);
    go_on(curve, stress, 2e-3);
    go_on(curve, 10e6, 2e-3);
    return value_of(compression_report(curve), "f_c_doubtful_because");
  };
  EXPECT_EQ(back_to(20e6), Result::Value());
  EXPECT_EQ(back_to(31.4e6), Result::Value());
  EXPECT_TRUE(std::holds_alternative<std::string>(back_to(31.6e6)));
}

// Promise: a dip that the curve makes good at once is no failure; where falls of 2 % and of 10 % tell
// strengths more than 5 % apart, both are there and a warning.
TEST(Response, AFallMustLast) {
  CompressionCurve curve;
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 29e6, 1e-4);
  go_on(curve, 36e6, 1e-3);  // back above 30 MPa within 2.5e-4 of strain
  go_on(curve, 20e6, 1e-3);
  const auto report = compression_report(curve);
  EXPECT_DOUBLE_EQ(number(report, "f_c_MPa"), 36.0);
  EXPECT_DOUBLE_EQ(number(report, "f_c_by_fall_of_2_percent_MPa"), 30.0);
  EXPECT_DOUBLE_EQ(number(report, "f_c_by_fall_of_10_percent_MPa"), 36.0);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("30.00 MPa by the first fall of 2 %, 36.00 MPa by one of 10 %"),
            std::string::npos);
  EXPECT_EQ(value_of(report, "f_c_doubtful_because"), Result::Value(report.warnings[0]));
}

// Promise: what a heated body bears less than the precision with which it rests is no strength, even where it
// loses all of that again.
TEST(Response, AFallWithinThePrecisionOfRestIsNone) {
  CompressionCurve curve;
  go_on(curve, 0.08e6, 5e-5);
  go_on(curve, 0.02e6, 5e-5);
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 20e6, 5e-4);
  EXPECT_DOUBLE_EQ(number(compression_report(curve, {.rest = 0.2e6}), "f_c_MPa"), 30.0);
  EXPECT_DOUBLE_EQ(number(compression_report(curve, {.rest = 0.01e6}), "f_c_MPa"), 0.08);
}

/// Adds points that swing about a straight stretch, as where a wave runs to and fro.
void swing(CompressionCurve& curve, double to_stress, double over_strain, double size) {
  const std::size_t first = curve.count();
  go_on(curve, to_stress, over_strain);
  for (std::size_t i = first; i < curve.count(); ++i) curve.stress[i] += (i / 3 % 2 == 0 ? size : -size);
}

// Promise: the first wave, which shakes the curve for longer than it runs, tells no strength; where coarse
// blocks fail one by one behind it, the run says that f_c depends on the rule.
TEST(Response, TheFirstWaveTellsNoStrengthByAnyFall) {
  CompressionCurve curve;  // a strain rate of 1/s, 15 GPa: the platen adds 0.75 MPa while a wave passes once
  const double waves = 1e-4;
  swing(curve, 15e6, 1e-3, 0.35e6);
  EXPECT_LT(curve.stress[15], 0.9 * curve.stress[14]);  // a fall by 10 %, behind the wave
  EXPECT_GT(curve.time[14] - curve.time[0], waves);
  go_on(curve, 30e6, 1e-3);
  go_on(curve, 29e6, 1e-4);
  go_on(curve, 36e6, 1e-3);
  go_on(curve, 20e6, 1e-3);
  const auto report = compression_report(curve, {.waves_until = waves});
  EXPECT_DOUBLE_EQ(number(report, "f_c_MPa"), 36.0);
  EXPECT_DOUBLE_EQ(number(report, "f_c_by_fall_of_2_percent_MPa"), 30.0);
  EXPECT_DOUBLE_EQ(number(report, "f_c_by_fall_of_10_percent_MPa"), 36.0);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("f_c depends on how a peak is told: 30.00 MPa by the first fall of 2 %, "
                                    "36.00 MPa by one of 10 %"),
            std::string::npos);
}

// Promise: a fall at the foot of the curve, where the ends of a specimen are pressed flat, tells no strength.
TEST(Response, AFallAtTheFootTellsNoStrength) {
  for (const double toe : {0.05e6, 1e6, 4e6, 9e6}) {
    CompressionCurve curve;
    go_on(curve, toe, 2e-4);
    go_on(curve, 0.8 * toe, 1e-4);  // by 20 %, good again within 3e-4 of strain
    go_on(curve, 30e6, 2e-3);
    go_on(curve, 20e6, 1e-3);
    const auto report = compression_report(curve);
    for (const char* name : {"f_c_MPa", "f_c_by_fall_of_2_percent_MPa", "f_c_by_fall_of_10_percent_MPa"})
      EXPECT_DOUBLE_EQ(number(report, name), 30.0) << toe << name;
    EXPECT_TRUE(report.warnings.empty()) << toe;
  }
}

// Promise: the summary says why a strength by a fall is missing.
TEST(Response, AMissingFallIsExplained) {
  CompressionCurve curve;
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 28e6, 5e-4);
  go_on(curve, 60e6, 8e-3);
  const auto report = compression_report(curve);
  EXPECT_EQ(std::get<std::string>(value_of(report, "f_c_by_fall_of_10_percent_none_because")),
            "the stress never fell by 10 % from above a third of f_c before the stage ended");
}

// Promise: a fall of 2 % and one of 10 % that tell the same still leave a doubt where f_c, by a lasting fall,
// is another.
TEST(Response, FallsThatAgreeAreComparedWithTheStrengthToo) {
  CompressionCurve curve;
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 26e6, 5e-5);
  go_on(curve, 36e6, 4e-4);  // back above 30 MPa within 3e-4 of strain
  go_on(curve, 20e6, 1e-3);
  const auto report = compression_report(curve);
  EXPECT_DOUBLE_EQ(number(report, "f_c_MPa"), 36.0);
  EXPECT_DOUBLE_EQ(number(report, "f_c_by_fall_of_10_percent_MPa"), 30.0);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(
      report.warnings[0].find("30.00 MPa by the first fall of 2 %, 36.00 MPa by one that lasts, 30.00 MPa "
                              "by one of 10 %"),
      std::string::npos)
      << report.warnings[0];
}

// Promise: who ends a stage right behind the largest stress is told how far to go on.
TEST(Response, APeakNeedsWhatComesBehindIt) {
  CompressionCurve curve;
  go_on(curve, 30e6, 2e-3);
  go_on(curve, 20e6, 2.9e-4);
  const auto too_soon = compression_report(curve);
  EXPECT_NE(too_soon.lines.front().find("the stage ended too soon behind the largest stress, 30.00 MPa"),
            std::string::npos);
  EXPECT_NE(too_soon.lines.front().find("0.0003 of strain; drive the platen farther"), std::string::npos)
      << too_soon.lines.front();
  go_on(curve, 20e6, 2e-5);
  EXPECT_DOUBLE_EQ(number(compression_report(curve), "f_c_MPa"), 30.0);
}

bool says(const Finding& finding, const char* words) {
  return !finding && finding.none_because.find(words) != std::string::npos;
}

TEST(Response, SaysWhyThereIsNone) {
  EXPECT_TRUE(says(compression_response({}).strength, "before it loaded the specimen"));
  const auto few = compression_response({{0.0, 1e-5}, {0.0, 1e6}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}});
  EXPECT_TRUE(says(few.strength, "did not fall by 2 % from the largest, 1.00 MPa"));
  EXPECT_TRUE(says(few.modulus, "fewer than three points"));
  EXPECT_TRUE(says(few.inelastic_strain, "no f_c"));
  const auto pulled = compression_response({{0.0, 1e-5}, {-1e6, -2e6}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}});
  EXPECT_TRUE(says(pulled.strength, "bore no compression"));
  EXPECT_FALSE(pulled.modulus || pulled.inelastic_strain);
}

// Promise: a largest stress that came while the first wave ran is no strength; of one that still rises
// nothing is said yet, and a later one counts.
TEST(Response, AStressWaveIsNoPeak) {
  auto rows = parabola(21.5e9, 35e6, 1.3);
  const double peak_time = rows.time[769] - rows.time[0];
  EXPECT_TRUE(says(compression_response(rows, 1.01 * peak_time).strength, "stress wave"));
  EXPECT_TRUE(compression_response(rows, 0.99 * peak_time).strength);
  EXPECT_TRUE(says(compression_response(parabola(21.5e9, 35e6, 0.9), 1.0).strength, "ended before a peak"));
}

// Promise: ends that are pressed flat first do not lower E: it is that of the curve behind the toe, and
// inelastic strain counts from where that line begins.
TEST(Response, AToeIsTakenOff) {
  const auto without = compression_response(parabola(21.5e9, 35e6, 1.3));
  auto rows = parabola(21.5e9, 35e6, 1.3);
  // the ends give way by the strain 1e-3 (1 - exp(-stress / 1 MPa))
  for (std::size_t i = 0; i < rows.count(); ++i)
    rows.strain[i] += 1e-3 * (1.0 - std::exp(-rows.stress[i] / 1e6));
  const auto r = compression_response(rows);
  EXPECT_EQ(without.toe, 0.0);
  EXPECT_NEAR(r.toe, 1e-3, 2e-4);  // the curve bends, so its steepest line begins somewhat before
  ASSERT_TRUE(r.modulus && r.inelastic_strain);
  EXPECT_GT(*r.modulus, 0.93 * *without.modulus);
  EXPECT_LT(*r.modulus, *without.modulus);
  EXPECT_NEAR(*r.inelastic_strain, *without.inelastic_strain, 3e-4);
}

TEST(Response, InelasticStrainHasAMeaningOrThereIsNone) {
  auto rows = parabola(21.5e9, 35e6, 1.3);
  rows.platen_difference[700] = 2e6;
  const auto shaken = compression_response(rows);
  EXPECT_TRUE(shaken.modulus);
  EXPECT_TRUE(says(shaken.inelastic_strain, "not quasi-static up to the peak"));
  rows.platen_difference[60] = 2e6;
  EXPECT_TRUE(says(compression_response(rows).modulus, "differ by more than 2 %"));
  rows = parabola(21.5e9, 35e6, 1.3);
  for (double& stress : rows.stress) stress += 5e6;
  EXPECT_TRUE(says(compression_response(rows).inelastic_strain, "began under load"));
}

// Promise: a report always has the same results, and lines for people say why one is missing.
TEST(Response, AReportSaysWhatIsMissing) {
  const auto pulled = compression_report({{0.0, 1e-5}, {-1e6, -2e6}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}});
  const auto sound = compression_report(parabola(21.5e9, 35e6, 1.3));
  ASSERT_EQ(pulled.results.size(), sound.results.size());
  for (std::size_t i = 0; i < sound.results.size(); ++i)
    EXPECT_EQ(pulled.results[i].name, sound.results[i].name);
  EXPECT_EQ(pulled.lines.front().rfind("f_c: none, because ", 0), 0u);
  ASSERT_FALSE(pulled.warnings.empty());
  EXPECT_TRUE(sound.warnings.empty());
}

// Promise: a stage that ends below the peak has E but no f_c. It warns of that unless it was to end there.
TEST(Response, AStageThatPassesNoPeakHasNoStrength) {
  const auto report = compression_report(parabola(21.5e9, 35e6, 0.5), {.to_a_value = true});
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(report.lines.front().rfind(
                "f_c: none, because the stage ended before a peak: the stress did not fall by 2 % "
                "from the largest, 26.25 MPa",
                0),
            0u);
  for (const Result& result : report.results) {
    const bool is_none = std::holds_alternative<std::monostate>(result.value);
    if (result.name == "f_c_MPa" || result.name == "strain_at_peak" || result.name == "strain_ic") {
      EXPECT_TRUE(is_none) << result.name;
    }
    if (result.name == "E_GPa") {
      EXPECT_FALSE(is_none);
    }
  }
  const auto broken_off = compression_report(parabola(21.5e9, 35e6, 0.5));
  ASSERT_EQ(broken_off.warnings.size(), 1u);
  EXPECT_EQ(broken_off.warnings.front().rfind("no f_c: the stage ended before a peak", 0), 0u);
  for (std::size_t i = 0; i < report.results.size(); ++i)
    EXPECT_EQ(broken_off.results[i].value, report.results[i].value) << report.results[i].name;
}

TEST(QuasiStatic, FlagsInertiaBeforeAndAfterThePeakSeparately) {
  auto rows = parabola(21.5e9, 35e6, 1.3);
  const std::size_t peak = compression_response(rows).peak;
  EXPECT_TRUE(quasi_static_report(rows, peak).to_peak);
  rows.kinetic_over_strain.back() = 0.5;
  auto report = quasi_static_report(rows, peak);
  EXPECT_TRUE(report.to_peak);
  EXPECT_FALSE(report.after_peak);
  rows.platen_difference[500] = 2e6;
  report = quasi_static_report(rows, peak);
  EXPECT_FALSE(report.to_peak);
  EXPECT_NEAR(report.difference_to_peak, 2e6 / 35e6, 1e-6);
}

}  // namespace
}  // namespace pyroclast
