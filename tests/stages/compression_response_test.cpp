#include "pyroclast/stages/compression_response.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "known.hpp"

namespace pyroclast {
namespace {

/// A test that follows the parabola with modulus E and peak f at 2 f / E, to `last` of the peak strain.
CompressionRows parabola(double modulus, double strength, double last) {
  CompressionRows rows;
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
  EXPECT_NEAR(r.strain_at_peak, 70e6 / 21.5e9, 5e-6);
  // the chord through 5 % and 1/3 of the strength lies below the tangent by 9 to 12 % on this parabola
  ASSERT_TRUE(r.modulus && r.inelastic_strain);
  EXPECT_LT(*r.modulus, 0.91 * 21.5e9);
  EXPECT_GT(*r.modulus, 0.88 * 21.5e9);
  EXPECT_DOUBLE_EQ(*r.inelastic_strain, r.strain_at_peak - *r.strength / *r.modulus);
  EXPECT_TRUE(r.peak_passed);
}

TEST(Response, SaysWhenThePeakWasNotPassed) {
  EXPECT_FALSE(compression_response(parabola(21.5e9, 35e6, 0.9)).peak_passed);
}

bool says(const Finding& finding, const char* words) {
  return !finding && finding.none_because.find(words) != std::string::npos;
}

TEST(Response, SaysWhyThereIsNone) {
  EXPECT_TRUE(says(compression_response({}).strength, "before its first row"));
  const auto few = compression_response({{0.0, 1e-5}, {0.0, 1e6}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}});
  ASSERT_TRUE(few.strength);
  EXPECT_EQ(*few.strength, 1e6);
  EXPECT_TRUE(says(few.modulus, "fewer than three rows"));
  EXPECT_TRUE(says(few.inelastic_strain, "no E"));
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
  EXPECT_TRUE(compression_response(parabola(21.5e9, 35e6, 0.9), 1.0).strength);
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
  EXPECT_EQ(report.lines.front().rfind("f_c: none, because the stage ended before a peak, at 26.25 MPa", 0),
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

TEST(Response, IsReadFromTheColumnsOfItsOwnRows) {
  History history;
  for (const auto* name : {"stage_strain", "kinetic_over_strain"}) history.add_column({name, "1"});
  history.add_column({"time_s", "s"});
  for (const auto* name : {"stress_MPa", "stress_top_MPa", "stress_bottom_MPa"})
    history.add_column({name, "MPa"});
  for (int i = 0; i < 4; ++i) {
    history.add_row();
    history.set("stage_strain", 1e-4 * i);
    history.set("kinetic_over_strain", 0.5 * i);
    history.set("time_s", 0.25 * i);
    history.set("stress_MPa", 2.0 * i);
    history.set("stress_top_MPa", 2.5 * i);
    history.set("stress_bottom_MPa", 1.5 * i);
  }
  const CompressionRows rows = compression_rows(history, {1, 3});
  EXPECT_EQ(rows.strain, (std::vector<double>{1e-4, 2e-4}));
  EXPECT_EQ(rows.stress, (std::vector<double>{2e6, 4e6}));
  EXPECT_EQ(rows.platen_difference, (std::vector<double>{1e6, 2e6}));
  EXPECT_EQ(rows.kinetic_over_strain, (std::vector<double>{0.5, 1.0}));
  EXPECT_EQ(rows.time, (std::vector<double>{0.25, 0.5}));
}

TEST(QuasiStatic, FlagsInertiaBeforeAndAfterThePeakSeparately) {
  auto rows = parabola(21.5e9, 35e6, 1.3);
  EXPECT_TRUE(quasi_static_report(rows).to_peak);
  rows.kinetic_over_strain.back() = 0.5;
  auto report = quasi_static_report(rows);
  EXPECT_TRUE(report.to_peak);
  EXPECT_FALSE(report.after_peak);
  rows.platen_difference[500] = 2e6;
  report = quasi_static_report(rows);
  EXPECT_FALSE(report.to_peak);
  EXPECT_NEAR(report.difference_to_peak, 2e6 / 35e6, 1e-6);
}

}  // namespace
}  // namespace pyroclast
