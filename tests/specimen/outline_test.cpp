#include "pyroclast/specimen/outline.hpp"

#include <cmath>
#include <numbers>

#include "examples.hpp"

namespace pyroclast::specimen {
namespace {

TEST(Outline, ASquareIsMeasuredExactly) {
  const auto [square, centre] = outline_around({{{1, 1}}, {{1, 3}}, {{3, 3}}, {{3, 1}}});  // clockwise
  EXPECT_EQ(centre, (Vec<2>{{2, 2}}));
  EXPECT_DOUBLE_EQ(square->extent(), 4.0);
  EXPECT_DOUBLE_EQ(square->size(), 8.0);
  EXPECT_DOUBLE_EQ(square->width(), 2.0);
  EXPECT_DOUBLE_EQ(square->inner_radius(), 1.0);
  EXPECT_DOUBLE_EQ(square->bounding_radius(), std::sqrt(2.0));
  EXPECT_EQ(square->corner_count(), 4);
  const auto outside = square->nearest({{2.5, 0.25}});
  EXPECT_DOUBLE_EQ(outside.distance, 1.5);
  EXPECT_EQ(outside.point.at, (Vec<2>{{1, 0.25}}));
  EXPECT_EQ(outside.point.normal, (Vec<2>{{1, 0}}));
  const auto inside = square->nearest({{0.1, -0.75}});
  EXPECT_DOUBLE_EQ(inside.distance, -0.25);
  EXPECT_NEAR(norm(inside.point.normal - Vec<2>{{0, -1}}), 0.0, 1e-12);
}

TEST(Outline, ALastPointAtTheFirstClosesTheLine) {
  const std::vector<Vec<2>> open{{{1, 1}}, {{3, 1}}, {{3, 3}}, {{1, 3}}};
  for (const double off : {0.0, 1e-9}) {
    std::vector<Vec<2>> closed = open;
    closed.push_back({{1 + off, 1}});
    const auto [square, centre] = outline_around(closed);
    EXPECT_EQ(square->corners(), outline_around(open).first->corners());
    EXPECT_EQ(centre, (Vec<2>{{2, 2}}));
  }
}

TEST(Outline, APlaceWithinIsKnownThoughTheCentroidLiesOutside) {
  const auto horseshoe =
      outline_around({{{0, 0}}, {{6, 0}}, {{6, 6}}, {{5, 6}}, {{5, 1}}, {{1, 1}}, {{1, 6}}, {{0, 6}}}).first;
  EXPECT_GT(horseshoe->nearest({}).distance, 0.0);
  EXPECT_LT(horseshoe->nearest(horseshoe->place_within()).distance, -0.3);
}

TEST(Outline, PointsOfASurfaceStandBesideItsCorners) {
  const auto [square, centre] = outline_around({{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}});
  const auto points = square->points(1.0);
  ASSERT_EQ(points.size(), 8U);
  for (const auto& [at, normal] : points) {
    EXPECT_NEAR(std::max(std::abs(at[0]), std::abs(at[1])), 1.0, 1e-12);
    EXPECT_NEAR(std::min(std::abs(at[0]), std::abs(at[1])), 0.5, 1e-12);
    EXPECT_NEAR(dot(at, normal), 1.0, 1e-12);
  }
}

TEST(Outline, PointsFillTheRestBesideThoseThatAreTaken) {
  const Ball<2> circle(1.0);
  const double turn = 2.0 * std::numbers::pi;
  EXPECT_EQ(circle.points(turn / 12).size(), 12U);
  const std::vector<Vec<2>> taken{{{1, 0}}, {{0, 1}}};
  const auto points = circle.points(turn / 12, taken);
  ASSERT_EQ(points.size(), 10U);
  for (const auto& [at, normal] : points)
    for (const Vec<2>& point : taken) EXPECT_GT(norm(at - point), 0.9 * 2.0 * std::sin(turn / 24));
}

TEST(Outline, DrawnStonesHaveTheirWidthAndElongation) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const auto ellipse = draw_outline({.kind = StoneShape::ellipse, .elongation = {1.5, 1.5}}, random);
    EXPECT_NEAR(ellipse->width(), 1.0, 1e-12);
    EXPECT_NEAR(ellipse->bounding_radius(), 0.75, 1e-3);  // 72 straight pieces
    EXPECT_NEAR(ellipse->extent(), std::numbers::pi / 4 * 1.5, 2e-3);
    const auto polygon =
        draw_outline({.kind = StoneShape::polygon, .elongation = {1.0, 1.5}, .corners = {5, 8}}, random);
    EXPECT_NEAR(polygon->width(), 1.0, 1e-12);
    EXPECT_GE(polygon->corners().size(), 5U);
    EXPECT_LE(polygon->corners().size(), 8U);
  }
  EXPECT_EQ(draw_outline({}, random), nullptr);
}

TEST(Outline, OneThatIsNoneIsRefused) {
  EXPECT_TRUE(says(message([] {
                     outline_around({{{0, 0}}, {{1, 0}}});
                   }),
                   "2 corners; allowed are three or more"));
  EXPECT_TRUE(says(message([] {
                     outline_around({{{0, 0}}, {{1, 1}}, {{1, 0}}, {{0, 1}}});
                   }),
                   "crosses itself"));
  EXPECT_TRUE(says(message([] {
                     outline_around({{{0, 0}}, {{1, 0}}, {{1, 0}}, {{0, 1}}});
                   }),
                   "corner 2 of an outline of a stone \\(from 0\\) repeats the one before, at \\(1, 0\\) m"));
  EXPECT_TRUE(says(message([] {
                     outline_around({{{0, 0}}, {{1, 0}}, {{0, 1}}, {{0, 0}}, {{1, 0}}, {{0, 1}}});
                   }),
                   "runs around more than once"));
  EXPECT_TRUE(says(message([] { outline_around({{{0, 0}}, {{1, 0}}, {{2, 0}}}); }), "no area"));
}

}  // namespace
}  // namespace pyroclast::specimen
