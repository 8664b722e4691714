// Promise: seeds stand in pairs on both sides of a stone's surface, and all have the same power there, so
// that the edge between two of them is a tangent. Lengths are in spacings.
#include "pyroclast/specimen/stone_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "examples.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kRounding = 1e-9;
/// Distance of a seed from the surface, and power of the surface.
constexpr double kOffset = 0.4, kPower = 0.25 - kOffset * kOffset;

/// Seeds around stones in a square of 20, unless a test says another body.
struct Made {
  explicit Made(std::vector<Stone<2>> all, const BlockSizes& block_sizes = BlockSizes(1.0),
                std::vector<WayToFollow> ways = {}, Region body = Region::rectangle(20.0, 20.0))
      : stones(std::move(all)),
        sizes(block_sizes),
        region(std::move(body)),
        outline(region, sizes),
        seeds(stones, ways.empty() ? std::vector<WayToFollow>(stones.size()) : ways, region, &outline,
              sizes) {}

  /// Seeds of a stone; -1: those between stones.
  std::vector<std::size_t> of(int stone) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < seeds.owners().size(); ++i)
      if (seeds.owners()[i] == stone) found.push_back(i);
    return found;
  }
  double from(const Vec<2>& centre, std::size_t seed) const { return norm(seeds.positions()[seed] - centre); }
  double radius(std::size_t seed) const { return seeds.radii()[seed]; }

  std::vector<Stone<2>> stones;
  BlockSizes sizes;
  Region region;
  OutlineSeeds outline;
  StoneSeeds<2> seeds;
};

const Vec<2> kMiddle{{10.0, 10.0}};

Stone<2> circle(double radius, const Vec<2>& centre = kMiddle) {
  return {centre, 2.0 * radius, 0, 0, nullptr};
}

/// A rectangle around the middle.
Stone<2> rectangle(double width, double height) {
  const double a = 0.5 * width, b = 0.5 * height;
  return stone_of({{{10 - a, 10 - b}}, {{10 + a, 10 - b}}, {{10 + a, 10 + b}}, {{10 - a, 10 + b}}});
}

/// Returns the radius of the circle whose tangents at so many even points enclose the area of a circle.
double drawn(double radius, std::size_t tangents) {
  const auto n = static_cast<double>(tangents);
  return radius / std::sqrt(n * std::tan(std::numbers::pi / n) / std::numbers::pi);
}

/// How many points, some 0.9 apart, go around a circle.
std::size_t count_around(double radius, double apart = 0.9) {
  return static_cast<std::size_t>(std::lround(2.0 * std::numbers::pi * radius / apart));
}

TEST(StoneSeeds, OfALargeStoneStandInPairsAcrossItsSurface) {
  const Made made({circle(4.0)});
  EXPECT_FALSE(made.seeds.is_one_cell(0));
  const auto within = made.of(0), around = made.of(-1);
  const std::size_t count = count_around(4.0);
  ASSERT_EQ(within.size(), count);
  ASSERT_EQ(around.size(), count);
  const double surface = drawn(4.0, count);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_NEAR(made.from(kMiddle, within[i]), surface - kOffset, kRounding);
    EXPECT_NEAR(made.from(kMiddle, around[i]), surface + kOffset, kRounding);
    EXPECT_NEAR(made.radius(within[i]), 0.5, kRounding);
    EXPECT_NEAR(made.radius(around[i]), 0.5, kRounding);
    EXPECT_NEAR(norm(made.seeds.positions()[around[i]] - made.seeds.positions()[within[i]]), 2.0 * kOffset,
                kRounding);
  }
}

// Promise: a stone is followed as much larger as its way says.
TEST(StoneSeeds, AStoneIsFollowedLargerByItsWay) {
  const Made made({circle(4.0)}, BlockSizes(1.0), {{.size = 1.1}});
  EXPECT_NEAR(made.from(kMiddle, made.of(-1)[0]), 1.1 * drawn(4.0, count_around(4.0)) + kOffset, kRounding);
}

// Promise: the tangents of a small stone enclose at most a quarter more than 1 times its size, whatever they
// are.
TEST(StoneSeeds, ATriangleIsDrawnSmallerByAQuarterAtMost) {
  const Stone<2> triangle = stone_of({{{9, 9.5}}, {{11, 9.5}}, {{10, 11}}});
  const Made made({triangle});
  EXPECT_GE(made.seeds.stone_at(triangle.centre + Vec<2>{{0.0, 0.79}}), 0);  // the top stands 1 above
}

TEST(StoneSeeds, ASmallStoneIsOneCellWithTangentsAroundIt) {
  for (const double radius : {0.3, 1.0, 1.45}) {
    const Made made({circle(radius)});
    EXPECT_TRUE(made.seeds.is_one_cell(0));
    const double size = 2.0 * std::numbers::pi * radius;
    const std::size_t count = count_around(radius, std::min(0.9 * radius / (radius + kOffset), size / 7.0));
    EXPECT_GE(count, 7U);
    const auto within = made.of(0), around = made.of(-1);
    ASSERT_EQ(within.size(), 1U);
    ASSERT_EQ(around.size(), count);
    const double surface = drawn(radius, count);
    EXPECT_NEAR(made.from(kMiddle, within[0]), 0.0, kRounding);
    EXPECT_NEAR(made.radius(within[0]), std::sqrt(surface * surface + kPower), kRounding);
    for (const std::size_t i : around) {
      EXPECT_NEAR(made.from(kMiddle, i), surface + kOffset, kRounding);
      EXPECT_NEAR(made.radius(i), 0.5, kRounding);
    }
  }
  EXPECT_FALSE(Made({circle(1.55)}).seeds.is_one_cell(0));
}

// Promise: a stone in which a free seed would seldom find a place has one in its middle, by its inner radius.
TEST(StoneSeeds, AStoneOfMiddleSizeHasASeedInItsMiddle) {
  const auto in_middle = [](const Stone<2>& stone) {
    const Made made({stone});
    const auto own = made.of(0);
    return std::ranges::any_of(own, [&](std::size_t i) {
      return made.from(kMiddle, i) < kRounding && std::abs(made.radius(i) - 0.5) < kRounding;
    });
  };
  EXPECT_TRUE(in_middle(circle(1.6)));
  EXPECT_TRUE(in_middle(circle(1.95)));
  EXPECT_FALSE(in_middle(circle(2.1)));
  EXPECT_FALSE(in_middle(rectangle(2.4, 8.0)));
  EXPECT_TRUE(in_middle(rectangle(2.8, 8.0)));
  EXPECT_FALSE(in_middle(circle(1.45))) << "the one seed has the power of its surface";
}

// Promise: the four sides of a small square have a tangent each, in pairs of seeds as they are, with one seed
// where it must be one.
TEST(StoneSeeds, ASmallSquareHasATangentForEachSide) {
  const double half = 0.5;
  const Made pairs({rectangle(2 * half, 2 * half)});
  const double within = std::min(kOffset, 0.5 * half);
  ASSERT_EQ(pairs.of(0).size(), 4U);
  ASSERT_EQ(pairs.of(-1).size(), 4U);
  for (const std::size_t i : pairs.of(0)) {
    EXPECT_NEAR(pairs.from(kMiddle, i), half - within, kRounding);
    EXPECT_NEAR(pairs.radius(i), std::sqrt(within * within + kPower), kRounding);
  }
  for (const std::size_t i : pairs.of(-1)) {
    EXPECT_NEAR(pairs.from(kMiddle, i), half + kOffset, kRounding);
    EXPECT_NEAR(pairs.radius(i), 0.5, kRounding);
  }
  const Made one({rectangle(2 * half, 2 * half)}, BlockSizes(1.0), {{.is_of_one_seed = true}});
  ASSERT_EQ(one.of(0).size(), 1U);
  const double power = half * half * std::numbers::sqrt2 + kPower;  // inner and outer radius
  EXPECT_NEAR(one.radius(one.of(0)[0]), std::sqrt(power), kRounding);
  for (const std::size_t i : one.of(-1)) {
    EXPECT_NEAR(one.from(kMiddle, i), half + kOffset, kRounding);
    EXPECT_NEAR(one.radius(i), std::sqrt(power - half * half + kOffset * kOffset), kRounding);
  }
  EXPECT_TRUE(Made({rectangle(8.0, 1.0)}, BlockSizes(1.0), {{.is_of_one_seed = true}}).of(0).size() > 1)
      << "a large stone has many";
}

// Promise: the sides of a large rectangle have their seeds beside them, however many: tangents in a line
// enclose it.
TEST(StoneSeeds, StraightSidesAreTheirTangents) {
  const Made made({rectangle(8.0, 5.0)});
  ASSERT_GT(made.of(-1).size(), 20U);
  for (const std::size_t i : made.of(-1)) {
    const Vec<2> from_middle = made.seeds.positions()[i] - kMiddle;
    const double x = std::abs(from_middle[0]) - 4.0, y = std::abs(from_middle[1]) - 2.5;
    EXPECT_NEAR(std::max(x, y), kOffset, kRounding);
    EXPECT_LT(std::min(x, y), 0.0);
  }
}

// Promise: an octagon is as round as a circle and has one seed, a hexagon is not.
TEST(StoneSeeds, ARoundStoneOfCornersHasOneSeed) {
  const auto count = [](int corners) {
    std::vector<Vec<2>> all;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      all.push_back(kMiddle + Vec<2>{{std::cos(angle), std::sin(angle)}});
    }
    return Made({stone_of(all)}).of(0).size();
  };
  EXPECT_EQ(count(8), 1U);  // 1 / cos(pi / 8) = 1.08
  EXPECT_GE(count(6), 6U);  // 1 / cos(pi / 6) = 1.155
}

/// Two circles beside each other around the middle, as far apart as drawn.
struct Pair {
  explicit Pair(double gap, double radius = 4.0)
      : surface(drawn(radius, count_around(radius))),
        left(kMiddle - Vec<2>{{surface + 0.5 * gap, 0.0}}),
        right(kMiddle + Vec<2>{{surface + 0.5 * gap, 0.0}}),
        made({circle(radius, left), circle(radius, right)}, BlockSizes(1.0), {},
             Region::rectangle(20.0, 20.0)) {}

  /// Distances of a seed from the two surfaces.
  std::array<double, 2> away(std::size_t seed) const {
    return {made.from(left, seed) - surface, made.from(right, seed) - surface};
  }

  double surface;
  Vec<2> left, right;
  Made made;
};

// Promise: seeds between stones stand as far from one surface as from the other where the gap has room for
// one row alone, and all seeds have the power of the nearest surface.
TEST(StoneSeeds, ANarrowGapHasOneRowInItsMiddle) {
  for (const double gap : {0.5, 1.3}) {
    const Pair pair(gap);
    int shared = 0;
    for (const std::size_t i : pair.made.of(-1)) {
      const auto [a, b] = pair.away(i);
      const double nearest = std::min(a, b);
      EXPECT_NEAR(pair.made.radius(i) * pair.made.radius(i), nearest * nearest + kPower, kRounding);
      if (std::abs(a - b) < kRounding)
        ++shared;
      else
        EXPECT_NEAR(nearest, kOffset, kRounding);
      // the seeds across the gap, in both stones
      if (std::abs(a - b) > kRounding) continue;
      for (const int stone : {0, 1}) {
        const auto own = pair.made.of(stone);
        EXPECT_TRUE(std::ranges::any_of(own, [&](std::size_t j) {
          return norm(pair.made.seeds.positions()[j] - pair.made.seeds.positions()[i]) <
                 nearest + kOffset + 0.1;
        })) << stone;
      }
    }
    EXPECT_GE(shared, 1) << gap;
  }
}

TEST(StoneSeeds, AWideGapHasTwoRows) {
  const Pair pair(1.5);
  for (const std::size_t i : pair.made.of(-1)) {
    const auto [a, b] = pair.away(i);
    EXPECT_NEAR(std::min(a, b), kOffset, kRounding);
  }
}

// Promise: seeds outside of stones keep 0.45 from each other, and none stands in a stone.
TEST(StoneSeeds, SeedsBetweenStonesKeepTheirDistance) {
  double nearest = std::numeric_limits<double>::infinity(), sum = 0.0;
  std::size_t count = 0;
  for (int turn = 0; turn < 30; ++turn) {
    const double angle = 0.1 * turn;
    const Vec<2> beside{{std::cos(angle), std::sin(angle)}}, across{{-beside[1], beside[0]}};
    const Made made({circle(1.8), circle(1.0, kMiddle + 3.2 * beside), circle(0.8, kMiddle + 3.0 * across),
                     circle(0.5, kMiddle + 1.9 * (beside + across))});
    for (std::size_t i = 0; i < made.seeds.radii().size(); ++i)
      sum += made.radius(i) * norm(made.seeds.positions()[i] - made.stones[1].centre);
    count += made.seeds.radii().size();
    const auto between = made.of(-1);
    for (std::size_t i = 0; i < between.size(); ++i) {
      const Vec<2>& place = made.seeds.positions()[between[i]];
      EXPECT_EQ(made.seeds.stone_at(place), -1);
      for (std::size_t j = 0; j < i; ++j)
        nearest = std::min(nearest, norm(place - made.seeds.positions()[between[j]]));
    }
  }
  EXPECT_GE(nearest, 0.45);
  EXPECT_LT(nearest, 0.46);
  // a deck of years ago makes the blocks that it made: these numbers change only where the rule is meant to
  EXPECT_EQ(count, 1308U);
  EXPECT_NEAR(sum, 2106.443354836, 1e-8);
}

// Promise: beside a side of the body the seeds stand midway between the side and the stone; where the side
// cuts the stone, its own seeds end there and none stands beyond.
TEST(StoneSeeds, BesideASideSeedsStandMidway) {
  const std::size_t count = count_around(4.0);
  const double surface = drawn(4.0, count);
  const Made made({circle(4.0, {{surface + 0.5, 10.0}})});
  bool is_midway = false;
  for (const std::size_t i : made.of(-1)) {
    const Vec<2>& place = made.seeds.positions()[i];
    const double away = made.from({{surface + 0.5, 10.0}}, i) - surface;
    EXPECT_GE(place[0], away - kRounding);
    EXPECT_NEAR(made.radius(i) * made.radius(i), away * away + kPower, kRounding);
    is_midway = is_midway || (std::abs(away - 0.25) < kRounding && std::abs(place[0] - 0.25) < kRounding);
  }
  EXPECT_TRUE(is_midway);
  EXPECT_EQ(made.of(0).size(), count);
}

TEST(StoneSeeds, AStoneThatASideCutsEndsThere) {
  const Made made({stone_of({{{0, 7}}, {{4, 7}}, {{4, 13}}, {{0, 13}}})});
  for (std::size_t i = 0; i < made.seeds.owners().size(); ++i) {
    const Vec<2>& place = made.seeds.positions()[i];
    EXPECT_GT(place[0], 0.0);
    EXPECT_EQ(made.seeds.owners()[i] == 0, place[0] < 4.0 && place[1] > 7.0 && place[1] < 13.0);
  }
  // sides of 6 at the cut and across, of 4 along the cut's ends
  const auto along = [&](auto is_there) {
    const auto own = made.of(0);
    return std::ranges::count_if(own, [&](std::size_t i) { return is_there(made.seeds.positions()[i]); });
  };
  EXPECT_EQ(along([](const Vec<2>& p) { return p[0] < 0.7; }),
            along([](const Vec<2>& p) { return p[0] > 3.3; }));
}

// Promise: where blocks become larger along a surface, each seed has the offset and the radius of the blocks
// there.
TEST(StoneSeeds, FollowTheSizesOfBlocksAlongASurface) {
  const BlockSizes sizes(1.0, 1.5, {{.pieces = {{{{0, 0}}, {{0, 20}}}}, .size = 0.6, .distance = 5.0}});
  const Made made({circle(5.0)}, sizes);
  double least = 2.0, most = 0.0, surface = 0.0;
  for (const std::size_t i : made.of(-1)) {
    const Vec<2> way = (made.seeds.positions()[i] - kMiddle) * (1.0 / made.from(kMiddle, i));
    const double size = 2.0 * made.radius(i);  // r² = (0.4² + 0.09) size²
    const double its_surface = made.from(kMiddle, i) - kOffset * size;
    surface = its_surface;
    EXPECT_NEAR(sizes.at(kMiddle + its_surface * way), size, kRounding);
    least = std::min(least, size);
    most = std::max(most, size);
  }
  EXPECT_NEAR(least, 0.6, 0.01);
  EXPECT_GT(most, 1.4);
  for (const std::size_t i : made.of(0))
    EXPECT_NEAR(made.from(kMiddle, i), surface - 2.0 * kOffset * made.radius(i), kRounding);
  // as many as blocks of these sizes along the surface ask for, so far apart as these are large
  double steps = 0.0;
  for (int i = 0; i < 3600; ++i) {
    const double angle = std::numbers::pi * i / 1800;
    steps += 2.0 * std::numbers::pi * 5.0 / 3600 /
             sizes.at(kMiddle + 5.0 * Vec<2>{{std::cos(angle), std::sin(angle)}});
  }
  EXPECT_NEAR(static_cast<double>(made.of(0).size()), steps / 0.9, 1.0);
}

// Promise: another seed keeps clear of both sides of a surface, and out of a stone of one cell.
TEST(StoneSeeds, LeaveRoomAwayFromSurfaces) {
  const Made made({circle(4.0), circle(1.0, {{3.0, 3.0}})});
  const double surface = drawn(4.0, count_around(4.0));
  const auto at = [&](double from_middle) { return kMiddle + Vec<2>{{0.0, from_middle}}; };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_FALSE(made.seeds.leave_room_at(at(surface + 0.29 * sign), 0.3));
    EXPECT_TRUE(made.seeds.leave_room_at(at(surface + 0.31 * sign), 0.3));
  }
  EXPECT_TRUE(made.seeds.leave_room_at(at(0.0), 0.3));
  EXPECT_FALSE(made.seeds.leave_room_at({{3.0, 3.0}}, 0.3));
  EXPECT_EQ(made.seeds.stone_at({{3.0, 3.0}}), 1);
  EXPECT_EQ(made.seeds.stone_at(at(surface - 0.01)), 0);
  EXPECT_EQ(made.seeds.stone_at(at(surface + 0.01)), -1);
  const Made fine({circle(4.0)}, BlockSizes(0.5));
  EXPECT_FALSE(fine.seeds.leave_room_at(at(drawn(4.0, count_around(4.0, 0.45)) + 0.14), 0.3));
  EXPECT_TRUE(fine.seeds.leave_room_at(at(drawn(4.0, count_around(4.0, 0.45)) + 0.16), 0.3));
}

}  // namespace
}  // namespace pyroclast::specimen
