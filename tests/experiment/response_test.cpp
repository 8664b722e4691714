#include "pyroclast/experiment/response.hpp"

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

const std::vector<Stage> kStages{SettleStage{}, CompressStage{}};

/// A test that follows the parabola with modulus E and peak f at 2 f / E, to `last` of the peak strain.
std::vector<Sample> parabola(double modulus, double strength, double last) {
  std::vector<Sample> rows(3);  // settling
  const double peak = 2.0 * strength / modulus;
  for (int i = 1; i <= 1000; ++i) {
    Sample s;
    s.stage = 1;
    s.strain = s.stage_strain = last * peak * i / 1000.0;
    s.stress_top = s.stress_bottom = modulus * s.strain * (1.0 - 0.5 * s.strain / peak);
    rows.push_back(s);
  }
  return rows;
}

TEST(Response, FindsModulusStrengthAndInelasticStrainOfAParabola) {
  const auto r = compression_response(parabola(21.5e9, 35e6, 1.3), kStages);
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->strength, 35e6, 1e3);
  EXPECT_NEAR(r->strain_at_peak, 70e6 / 21.5e9, 5e-6);
  // the chord through 5 % and 1/3 of the strength lies below the tangent by 9 to 12 % on this parabola
  EXPECT_LT(r->modulus, 0.91 * 21.5e9);
  EXPECT_GT(r->modulus, 0.88 * 21.5e9);
  EXPECT_DOUBLE_EQ(r->inelastic_strain, r->strain_at_peak - r->strength / r->modulus);
  EXPECT_TRUE(r->peak_passed);
}

TEST(Response, SaysWhenThePeakWasNotPassed) {
  EXPECT_FALSE(compression_response(parabola(21.5e9, 35e6, 0.9), kStages)->peak_passed);
}

TEST(Response, IsEmptyWithoutACompressionStage) {
  EXPECT_FALSE(compression_response(std::vector<Sample>(5), kStages));
  EXPECT_FALSE(compression_response({}, kStages));
}

TEST(QuasiStatic, FlagsInertiaBeforeAndAfterThePeakSeparately) {
  auto rows = parabola(21.5e9, 35e6, 1.3);
  EXPECT_TRUE(quasi_static_report(rows, kStages).to_peak);
  rows.back().kinetic_over_strain = 0.5;
  auto report = quasi_static_report(rows, kStages);
  EXPECT_TRUE(report.to_peak);
  EXPECT_FALSE(report.after_peak);
  rows[500].stress_top += 2e6;
  report = quasi_static_report(rows, kStages);
  EXPECT_FALSE(report.to_peak);
  EXPECT_NEAR(report.difference_to_peak, 2e6 / 35e6, 1e-6);
}

}  // namespace
}  // namespace pyroclast
