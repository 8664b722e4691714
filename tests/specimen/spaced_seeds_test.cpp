// Promise: seeds of a solid keep their distance, are numbered along Morton's curve, and have the radii of the
// blocks there.
#include "pyroclast/specimen/spaced_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

/// Blocks of 4 mm near the side x = 0 of a body, and of 10 mm far from it.
BlockSizes finer_on_the_left() {
  return {8e-3, 10e-3, {{.pieces = {{{{0, 0, 0}}, {{0, 1, 0}}, {{0, 1, 1}}, {{0, 0, 1}}}}, .size = 4e-3}}};
}

double nearest(const Seeds<3>& seeds, const BlockSizes& sizes) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < seeds.position.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = seeds.position[i], &b = seeds.position[j];
      least = std::min(least, norm(a - b) / (0.5 * (sizes.at(a) + sizes.at(b))));
    }
  return least;
}

// Promise: the least distance is 0.62 of the mean size of both blocks, and is used.
TEST(SpacedSeeds, KeepTheirDistanceWhereBlocksAreAlikeAndWhereNot) {
  const Prism body = cuboid(0.06, 0.05, 0.04);
  Random random(1);
  const auto even = spaced_seeds(body, 800, 0.3, random);
  const BlockSizes alike(std::cbrt(body.extent() / 800));
  EXPECT_GE(nearest(even, alike), 0.62);
  EXPECT_LT(nearest(even, alike), 0.63);
  const auto finer = spaced_seeds(body, finer_on_the_left(), 300, 0.3, random);
  ASSERT_EQ(finer.position.size(), 300U);
  EXPECT_GE(nearest(finer, finer_on_the_left()), 0.62);
  EXPECT_LT(nearest(finer, finer_on_the_left()), 0.65);
  // more of them where blocks are finer
  EXPECT_GT(std::ranges::count_if(finer.position, [](const Vec<3>& p) { return p[0] < 0.02; }), 150);
}

// Promise: of eight octants of the body's box the first has the first seeds, and so on within each, x before
// y before z.
TEST(SpacedSeeds, AreNumberedOctantByOctant) {
  const Prism body = cuboid(0.06, 0.05, 0.04);
  Random random(2);
  const auto seeds = spaced_seeds(body, 500, 0.3, random);
  const auto octants = [&](const Vec<3>& p) {
    std::vector<int> all;
    for (int level = 2; level <= 16; level *= 2) {
      int octant = 0;
      for (int d = 0; d < 3; ++d) octant = 2 * octant + static_cast<int>(p[d] / body.high()[d] * level) % 2;
      all.push_back(octant);
    }
    return all;
  };
  EXPECT_TRUE(std::ranges::is_sorted(seeds.position, {}, octants));
  // a body that does not begin at the origin
  const Prism disc(Region::polygon(circle_corners({}, 0.06, 0.006), {"rim"}, true), Prism::Axis::z, 0.04);
  ASSERT_LT(disc.low()[0], -0.029);
  const auto of_disc = spaced_seeds(disc, 200, 0.3, random);
  const double middle = 0.5 * (disc.low()[0] + disc.high()[0]);
  EXPECT_TRUE(std::ranges::is_sorted(of_disc.position, {}, [&](const Vec<3>& p) { return p[0] > middle; }));
  for (const Vec<3>& place : of_disc.position) EXPECT_LT(disc.distance(place), 0.0);
}

TEST(SpacedSeeds, HaveRadiiWithinTheSpread) {
  const Prism body = cuboid(0.06, 0.05, 0.04);
  Random random(3);
  const double size = std::cbrt(body.extent() / 500);
  for (const double radius : spaced_seeds(body, 500, 0.0, random).radius) EXPECT_EQ(radius, 0.5 * size);
  const auto spread = spaced_seeds(body, 500, 0.3, random).radius;
  const auto [low, high] = std::ranges::minmax(spread);
  EXPECT_GE(low, 0.35 * size);
  EXPECT_LT(low, 0.352 * size);
  EXPECT_LE(high, 0.65 * size);
  EXPECT_GT(high, 0.648 * size);
  const auto finer = spaced_seeds(body, finer_on_the_left(), 200, 0.0, random);
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_EQ(finer.radius[i], 0.5 * finer_on_the_left().at(finer.position[i]));
}

TEST(SpacedSeeds, BlocksThatAreTooLargeAreRefused) {
  Random random(4);
  EXPECT_EQ(message([&] { spaced_seeds(cuboid(0.05, 0.05, 0.05), BlockSizes(0.2), 2, 0.3, random); }),
            "after 1 blocks there is no place for more: blocks of 200 mm are too large");
}

// Promise: seeds that are drawn anew keep their distance from those that stay, which stay as they are, and
// their radii over the size of the blocks.
TEST(SpacedSeeds, SomeAreDrawnAnew) {
  const Prism body = cuboid(0.06, 0.05, 0.04);
  const auto sizes = finer_on_the_left();
  Random random(5);
  const Seeds<3> before = spaced_seeds(body, sizes, 300, 0.3, random);
  Seeds<3> seeds = before;
  const std::vector<int> which{0, 7, 120, 299};
  redraw(seeds, which, body, sizes, random);
  int larger = 0;
  for (int i = 0; i < 300; ++i) {
    const bool is_drawn = std::ranges::find(which, i) != which.end();
    EXPECT_EQ(seeds.position[i] == before.position[i], !is_drawn) << i;
    if (!is_drawn) {
      EXPECT_EQ(seeds.radius[i], before.radius[i]);
    } else {
      const double size = sizes.at(seeds.position[i]), of_before = sizes.at(before.position[i]);
      EXPECT_NEAR(seeds.radius[i] / size, before.radius[i] / of_before, 1e-12);
      larger += size != of_before ? 1 : 0;
    }
  }
  EXPECT_GT(larger, 0);
  EXPECT_GE(nearest(seeds, sizes), 0.62);
}

}  // namespace
}  // namespace pyroclast::specimen
