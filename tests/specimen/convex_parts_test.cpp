#include "pyroclast/specimen/convex_parts.hpp"

#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "pyroclast/base/random.hpp"

namespace pyroclast::specimen {
namespace {

std::vector<Vec<2>> corners_of(const std::vector<Vec<2>>& polygon, const std::vector<int>& part) {
  std::vector<Vec<2>> corners;
  for (const int i : part) corners.push_back(polygon[i]);
  return corners;
}

/// All parts convex, and together as large as the polygon.
void expect_parts_of(const std::vector<Vec<2>>& polygon, const std::vector<std::vector<int>>& parts) {
  double total = 0.0;
  for (const auto& part : parts) {
    const auto corners = corners_of(polygon, part);
    EXPECT_GT(area(corners), 0.0);
    EXPECT_LE(largest_angle(corners), std::numbers::pi + kInwards);
    total += area(corners);
  }
  EXPECT_NEAR(total, area(polygon), 1e-12 * area(polygon));
}

TEST(ConvexParts, AConvexCellIsOnePart) {
  const std::vector<Vec<2>> square{{{0, 0}}, {{0.5, 1e-13}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  EXPECT_EQ(convex_parts(square), (std::vector<std::vector<int>>{{0, 1, 2, 3, 4}}));
}

// Promise: one dent takes one cut, and the cut leaves no needle.
TEST(ConvexParts, ADentTakesOneCut) {
  const std::vector<Vec<2>> dart{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{2, 2}}, {{1, 0.2}}, {{0, 2}}};
  const auto parts = convex_parts(dart);
  ASSERT_EQ(parts.size(), 2U);
  expect_parts_of(dart, parts);
}

// Promise: whatever simple polygon; stars of random radii have dents at half of their corners.
TEST(ConvexParts, OfStarsAreConvexAndCoverThem) {
  Random random(1);
  for (int star = 0; star < 200; ++star) {
    std::vector<Vec<2>> polygon;
    const int corners = 4 + star % 20;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners, radius = random.uniform(0.3, 1.0);
      polygon.push_back({{radius * std::cos(angle), radius * std::sin(angle)}});
    }
    expect_parts_of(polygon, convex_parts(polygon));
  }
}

TEST(ConvexParts, APolygonThatCrossesItselfIsLeftToWhoChecksIt) {
  const std::vector<Vec<2>> bow{{{0, 0}}, {{1, 1}}, {{1, 0}}, {{0, 1}}};
  std::size_t corners = 0;
  for (const auto& part : convex_parts(bow)) corners += part.size();
  EXPECT_GE(corners, 4U);
}

}  // namespace
}  // namespace pyroclast::specimen
