// Promise: a measured grading is met as it is stated, by area or by volume.
#include "pyroclast/specimen/grading_curve.hpp"

#include <cmath>

#include "examples.hpp"
#include "pyroclast/specimen/gradation.hpp"

namespace pyroclast::specimen {
namespace {

TEST(GradingCurve, AboveASizeItIsRescaled) {
  const GradingCurve curve = above({{1e-3, 4e-3, 8e-3, 16e-3, 32e-3}, {0.1, 0.4, 0.4, 1.0, 1.0}}, 4e-3);
  EXPECT_EQ(curve.sizes, (std::vector<double>{8e-3, 16e-3})) << "without the ends where there are no stones";
  EXPECT_EQ(curve.shares, (std::vector<double>{0.0, 1.0}));
  const GradingCurve within = above({{1e-3, 3e-3, 5e-3}, {0.0, 0.5, 1.0}}, 2e-3);
  EXPECT_EQ(within.sizes, (std::vector<double>{2e-3, 3e-3, 5e-3}));
  EXPECT_NEAR(within.shares[1], 1.0 / 3.0, 1e-15);
  for (const double d_min : {0.5e-3, 32e-3})
    EXPECT_TRUE(says(message([&] { above({{1e-3, 32e-3}, {0.0, 1.0}}, d_min); }), "must lie from"));
  EXPECT_TRUE(says(message([&] {
                     above({{1e-3, 8e-3, 16e-3}, {0.0, 1.0, 1.0}}, 9e-3);
                   }),
                   "leaves no stones"));
}

// Spheres of one size: the share of the area that is of circles smaller than s is 1 - 3/2 u + 1/2 u^3. A
// class of sizes as wide as w differs from one size by some 10 w, and rounding by 1e-16 / w.
TEST(GradingCurve, SpheresOfOneSizeAreCutIntoSmallerCircles) {
  const GradingCurve section = of_section({{0.0, 1.0 - 1e-8, 1.0}, {0.0, 0.0, 1.0}});
  for (std::size_t i = 0; i + 2 < section.sizes.size(); ++i) {
    const double s = section.sizes[i], u = std::sqrt(std::max(0.0, 1.0 - s * s));
    if (s > 0.99) continue;  // spheres of 1 - 1e-8 to 1 are not one size there
    EXPECT_NEAR(section.shares[i], 1.0 - 1.5 * u + 0.5 * u * u * u, 2e-7) << s;
  }
}

/// sqrt(D / D_max), by many points.
GradingCurve fuller() {
  constexpr int kPoints = 2000;
  GradingCurve curve;
  for (int i = 0; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    curve.sizes.push_back(share * share);
    curve.shares.push_back(share);
  }
  return curve;
}

double share_below(const GradingCurve& curve, double size) {
  const auto next = std::ranges::upper_bound(curve.sizes, size) - curve.sizes.begin();
  return next == std::ssize(curve.sizes) ? 1.0 : curve.shares[next];  // points lie densely
}

// A point of the stones' volume, anywhere, lies in the circle that a plane through it cuts from its sphere.
TEST(GradingCurve, OfSpheresIsThatOfPlanesThroughAnyPoint) {
  constexpr int kDraws = 100000;
  Random random(11);
  std::vector<double> circles;
  for (int i = 0; i < kDraws; ++i) {
    const double volume = random.uniform(), diameter = volume * volume, radius = std::cbrt(random.uniform());
    const double height = radius * (2.0 * random.uniform() - 1.0);  // over half of the diameter
    circles.push_back(diameter * std::sqrt(1.0 - height * height));
  }
  const GradingCurve section = of_section(fuller());
  for (const double size : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto smaller = std::ranges::count_if(circles, [&](double circle) { return circle <= size; });
    // Four standard deviations of a share of 0.5 in so many draws are 0.0063.
    EXPECT_NEAR(share_below(section, size), static_cast<double>(smaller) / kDraws, 0.0063) << size;
  }
}

// Walraven's series (1980) is a fit of the same: up to 0.011 lower, and 0.998 where all passes.
TEST(GradingCurve, OfFullersSpheresIsNearWalravensSeries) {
  const GradingCurve section = of_section(fuller());
  for (const double x : {0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999}) {
    const double series = 1.065 * std::sqrt(x) - 0.053 * std::pow(x, 4) - 0.012 * std::pow(x, 6) -
                          0.0045 * std::pow(x, 8) + 0.0025 * std::pow(x, 10);
    EXPECT_NEAR(share_below(section, x), series, 0.012) << x;
  }
}

AggregateParameters graded(const GradingCurve& curve) {
  AggregateParameters p = paper_aggregates();
  p.sieves = curve.sizes;
  p.passing = curve.shares;
  p.d_min = curve.sizes.front();
  p.d_max = curve.sizes.back();
  p.fuller_exponent = 1.0;
  return p;
}

// As for Fuller's curve in gradation_test.cpp: about 100,000 circles, of which the largest sizes are few.
TEST(GradingCurve, DiametersFollowItAndLeaveItsGapsFree) {
  const AggregateParameters p = graded({{4e-3, 8e-3, 16e-3, 22e-3, 32e-3}, {0.0, 0.3, 0.3, 0.7, 1.0}});
  Random random(5);
  const std::vector<Stone<2>> circles = draw_stones<2>(p, 100.0, random);
  for (const Stone<2>& circle : circles)
    EXPECT_FALSE(circle.diameter > 8e-3 && circle.diameter < 16e-3) << circle.diameter;
  std::vector<double> sizes;
  for (double d = 4e-3; d <= 32e-3; d += 1e-3) sizes.push_back(d);
  for (const GradationPoint& point : gradation(p, circles, sizes))
    EXPECT_NEAR(point.passing_realised, point.passing_asked, 1.5) << point.size;
}

}  // namespace
}  // namespace pyroclast::specimen
