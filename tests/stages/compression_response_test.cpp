#include "pyroclast/stages/compression_response.hpp"

#include <gtest/gtest.h>

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
  }
  return rows;
}

TEST(Response, FindsModulusStrengthAndInelasticStrainOfAParabola) {
  const auto r = compression_response(parabola(21.5e9, 35e6, 1.3));
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->strength, 35e6, 1e3);
  EXPECT_NEAR(r->strain_at_peak, 70e6 / 21.5e9, 5e-6);
  // the chord through 5 % and 1/3 of the strength lies below the tangent by 9 to 12 % on this parabola
  ASSERT_TRUE(r->modulus && r->inelastic_strain);
  EXPECT_LT(*r->modulus, 0.91 * 21.5e9);
  EXPECT_GT(*r->modulus, 0.88 * 21.5e9);
  EXPECT_DOUBLE_EQ(*r->inelastic_strain, r->strain_at_peak - r->strength / *r->modulus);
  EXPECT_TRUE(r->peak_passed);
}

TEST(Response, SaysWhenThePeakWasNotPassed) {
  EXPECT_FALSE(compression_response(parabola(21.5e9, 35e6, 0.9))->peak_passed);
}

TEST(Response, HasNoModulusWithTooFewRows) {
  EXPECT_FALSE(compression_response({}));
  const auto r = compression_response({{0.0, 1e-5}, {0.0, 1e6}, {0.0, 0.0}, {0.0, 0.0}});
  ASSERT_TRUE(r);
  EXPECT_EQ(r->strength, 1e6);
  EXPECT_FALSE(r->modulus || r->inelastic_strain);
}

TEST(Response, IsReadFromTheColumnsOfItsOwnRows) {
  History history;
  for (const auto* name : {"stage_strain", "kinetic_over_strain"}) history.add_column({name, "1"});
  for (const auto* name : {"stress_MPa", "stress_top_MPa", "stress_bottom_MPa"})
    history.add_column({name, "MPa"});
  for (int i = 0; i < 4; ++i) {
    history.add_row();
    history.set("stage_strain", 1e-4 * i);
    history.set("kinetic_over_strain", 0.5 * i);
    history.set("stress_MPa", 2.0 * i);
    history.set("stress_top_MPa", 2.5 * i);
    history.set("stress_bottom_MPa", 1.5 * i);
  }
  const CompressionRows rows = compression_rows(history, {1, 3});
  EXPECT_EQ(rows.strain, (std::vector<double>{1e-4, 2e-4}));
  EXPECT_EQ(rows.stress, (std::vector<double>{2e6, 4e6}));
  EXPECT_EQ(rows.platen_difference, (std::vector<double>{1e6, 2e6}));
  EXPECT_EQ(rows.kinetic_over_strain, (std::vector<double>{0.5, 1.0}));
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
