#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "examples.hpp"
#include "pyroclast/specimen/gradation.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

std::vector<Stone<2>> place_paper_aggregates(const AggregateParameters& p, std::uint64_t seed) {
  Random random(seed);
  return place(draw_stones<2>(p, 0.15 * 0.3, random), room_in(Region::rectangle(0.15, 0.3)), p, {}, random);
}

TEST(Placement, KeepsTheGapBetweenAggregatesAndToTheOutline) {
  const AggregateParameters p = paper_aggregates();
  const double gap = p.minimum_gap * (1 - 1e-9);  // the comparison is one of squares
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Stone<2>> circles = place_paper_aggregates(p, seed);
    for (std::size_t i = 0; i < circles.size(); ++i) {
      const double radius = circles[i].diameter / 2;
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_GE(circles[i].centre[axis] - radius, gap);
        EXPECT_LE(circles[i].centre[axis] + radius, (axis == 0 ? 0.15 : 0.3) - gap);
      }
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE(norm(circles[i].centre - circles[j].centre) - radius - circles[j].diameter / 2, gap);
      }
    }
  }
}

TEST(Placement, PlacesThousandsOfSmallAggregatesBetweenLargeOnes) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.5;
  p.d_min = 1e-3;
  p.sieves.front() = 1e-3;
  p.minimum_gap = 0;
  Random random(1);
  const std::vector<Stone<2>> stones = draw_stones<2>(p, 0.15 * 0.3, random);
  ASSERT_GT(stones.size(), 1000U);
  EXPECT_EQ(place(stones, room_in(Region::rectangle(0.15, 0.3)), p, {}, random).size(), stones.size());
}

// Where stones cannot be placed one by one, they grow. 100 tries for each are too few for a fraction of 0.5.
TEST(Placement, GrownStonesKeepTheGapAndTheirSizes) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.6;
  p.attempts = 100;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    const std::vector<Stone<2>> stones = draw_stones<2>(p, 0.15 * 0.3, random);
    const auto placed = place(stones, room_in(Region::rectangle(0.15, 0.3)), p, {}, random);
    ASSERT_EQ(placed.size(), stones.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      EXPECT_EQ(placed[i].diameter, stones[i].diameter);
      const double radius = placed[i].diameter / 2, gap = p.minimum_gap - 1e-12;
      EXPECT_GE(placed[i].centre[0] - radius, gap);
      EXPECT_LE(placed[i].centre[0] + radius, 0.15 - gap);
      EXPECT_GE(placed[i].centre[1] - radius, gap);
      EXPECT_LE(placed[i].centre[1] + radius, 0.3 - gap);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE(norm(placed[i].centre - placed[j].centre) - radius - placed[j].diameter / 2, gap);
    }
  }
}

TEST(Placement, GrowsInADiscToo) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.55;
  p.attempts = 50;
  const Region disc = Region::polygon(circle_corners({}, 0.2, 2e-3), {"rim"}, true);
  Random random(1);
  const auto placed = place(draw_stones<2>(p, disc.extent(), random), room_in(disc), p, {}, random);
  for (const Stone<2>& stone : placed)
    EXPECT_LE(disc.distance(stone.centre), -stone.diameter / 2 - p.minimum_gap + 1e-12);
}

TEST(Placement, ShapesKeepTheGap) {
  AggregateParameters p = paper_aggregates();
  p.fraction = 0.45;
  for (const StoneShape kind : {StoneShape::ellipse, StoneShape::polygon, StoneShape::harmonics}) {
    p.shape = {.kind = kind, .elongation = {1.1, 1.8}, .corners = {4, 7}, .roughness = {0.02, 0.06}};
    Random random(2);
    const auto placed =
        place(draw_stones<2>(p, 0.15 * 0.3, random), room_in(Region::rectangle(0.15, 0.3)), p, {}, random);
    double share = 0.0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      share += extent(placed[i]) / (0.15 * 0.3);
      for (const Vec<2>& corner : corners_of(placed[i])) {
        EXPECT_GE(std::min(corner[0], 0.15 - corner[0]), p.minimum_gap - 1e-12);
        EXPECT_GE(std::min(corner[1], 0.3 - corner[1]), p.minimum_gap - 1e-12);
      }
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_FALSE(are_closer(placed[i], placed[j], p.minimum_gap - 1e-12));
    }
    EXPECT_NEAR(share, p.fraction, 0.5 * std::numbers::pi / 4 * p.d_min * p.d_min * 1.8 / (0.15 * 0.3));
  }
}

TEST(Placement, SaysWhatThoseThatFoundAPlaceTake) {
  AggregateParameters p = paper_aggregates();
  p.attempts = 100;
  p.place = "mine.toml:12: aggregates";
  Random random(1);
  const std::vector<Stone<2>> stones{
      {{}, 20e-3}, {{}, 10e-3}, {{}, 50e-3}};  // the last is wider than the specimen
  // pi/4 (20^2 + 10^2) / (40 x 300) = 0.0327
  EXPECT_TRUE(says(
      message([&] { place(stones, room_in(Region::rectangle(0.04, 0.3)), p, {}, random); }),
      "^mine.toml:12: aggregates: the aggregates do not fit: after 2 of 3, an area fraction of 0\\.033 of "
      "the 0\\.340 asked for, one of 50 mm found no place in 100 attempts"));
}

TEST(Placement, AnAggregateWiderThanTheSpecimenIsMissing) {
  AggregateParameters p = paper_aggregates();
  Random random(1);
  const std::vector<Stone<2>> stones{{{}, 30e-3}};
  EXPECT_TRUE(says(message([&] { place(stones, room_in(Region::rectangle(0.02, 0.3)), p, {}, random); }),
                   "after 0 of 1"));
}

}  // namespace
}  // namespace pyroclast::specimen
