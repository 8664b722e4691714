#include "pyroclast/specimen/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/base/random.hpp"

namespace pyroclast::specimen {
namespace {

using std::numbers::pi;

// Rounding of a handful of operations on numbers of order one.
constexpr double rounding = 1e-13;

const std::vector<Vec<2>> square{{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}};

TEST(CommonAreaVerification, IsTheCircleInsideAPolygon) {
  EXPECT_NEAR(common_area(square, {{1, 1}}, 0.5), pi / 4, rounding);
}

TEST(CommonAreaVerification, IsThePolygonInsideACircle) {
  EXPECT_NEAR(common_area(square, {{1.2, 0.9}}, 3), 4, rounding);
}

TEST(CommonAreaVerification, IsZeroOutside) {
  EXPECT_NEAR(common_area(square, {{5, 5}}, 1), 0, rounding);
}

TEST(CommonAreaVerification, IsZeroWhereTheCircleOnlyTouches) {
  EXPECT_NEAR(common_area(square, {{-1, 1}}, 1), 0, rounding);
}

TEST(CommonAreaVerification, IsHalfTheCircleAtAnEdgeAndAQuarterAtACorner) {
  EXPECT_NEAR(common_area(square, {{0, 1}}, 0.5), pi / 8, rounding);
  EXPECT_NEAR(common_area(square, {{0, 0}}, 0.5), pi / 16, rounding);
}

TEST(CommonAreaVerification, IsTheSegmentBeyondAChord) {
  const double distance = 0.3;
  const double segment = std::acos(distance) - distance * std::sqrt(1 - distance * distance);
  const std::vector<Vec<2>> half_plane{{{distance, -9}}, {{9, -9}}, {{9, 9}}, {{distance, 9}}};
  expect_known({"Area of a circle beyond a chord", "circular segment", "m2"},
               common_area(half_plane, {{0, 0}}, 1), segment, 1e-12);  // corners at 9: products of order 100
}

/// The length that a vertical line has in common with a convex polygon and a circle.
double common_chord(const std::vector<Vec<2>>& polygon, const Vec<2>& centre, double radius, double x) {
  const double half_squared = radius * radius - (x - centre[0]) * (x - centre[0]);
  if (half_squared <= 0) return 0;
  double low = INFINITY;
  double high = -INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<2>& a = polygon[i];
    const Vec<2>& b = polygon[(i + 1) % polygon.size()];
    if ((a[0] - x) * (b[0] - x) > 0) continue;
    const double y = a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  const double half = std::sqrt(half_squared);
  return std::max(0.0, std::min(high, centre[1] + half) - std::max(low, centre[1] - half));
}

TEST(CommonAreaVerification, AgreesWithQuadratureForAnyTriangle) {
  Random random(7);
  constexpr int strips = 20000;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec<2>> triangle(3);
    for (Vec<2>& p : triangle) {
      p[0] = random.uniform();
      p[1] = random.uniform();
    }
    if (area(triangle) < 0) std::swap(triangle[0], triangle[1]);
    const Vec<2> centre{{0.5, 0.4}};
    const double radius = random.uniform(0.05, 0.6);
    double sum = 0;
    for (int i = 0; i < strips; ++i)
      sum += common_chord(triangle, centre, radius, (i + 0.5) / strips) / strips;
    // The midpoint rule on strips of 5e-5 misses at most about that squared times the root-like ends' slope.
    expect_known({"Area that circles and triangles share", "midpoint rule of 20,000 strips", "m2"},
                 common_area(triangle, centre, radius), sum, 2e-6);
  }
}

TEST(Polygon, AreaAndCentroidDoNotSufferFromADistantOrigin) {
  const std::vector<Vec<2>> far{{{1e6, 1e6}}, {{1e6 + 2, 1e6}}, {{1e6 + 2, 1e6 + 1}}, {{1e6, 1e6 + 1}}};
  EXPECT_DOUBLE_EQ(area(far), 2);
  EXPECT_DOUBLE_EQ(centroid(far)[0], 1e6 + 1);
  EXPECT_DOUBLE_EQ(centroid(far)[1], 1e6 + 0.5);
}

TEST(Polygon, LargestAngleTellsConvexFromNot) {
  EXPECT_NEAR(largest_angle(square), pi / 2, rounding);
  const std::vector<Vec<2>> dented{{{0, 0}}, {{2, 0}}, {{1, 0.5}}, {{0, 2}}};
  EXPECT_GT(largest_angle(dented), pi);
}

TEST(Polygon, ThinnestZoneIsTheSmallestAltitudeOfItsFan) {
  // Around the centre of a 2 x 2 square each zone has base 2 and height 1; the altitude on its short sides is
  // larger.
  EXPECT_NEAR(thinnest_zone(square), 1, rounding);
}

TEST(Polygon, SmallestAngleOfATriangle) {
  EXPECT_NEAR(smallest_angle({{{{0, 0}}, {{1, 0}}, {{0, 1}}}}), pi / 4, rounding);
}

}  // namespace
}  // namespace pyroclast::specimen
