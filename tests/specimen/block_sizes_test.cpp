#include "pyroclast/specimen/block_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "examples.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kFine = 2e-3, kReach = 10e-3;
/// With which blocks grow by a fifth from middle to middle.
constexpr double kSlopeOfSize = 0.4 / 2.2;

/// Makes blocks finer near a line.
BlockParameters finer_near(const Vec<2>& from, const Vec<2>& to, double largest, const Region& region) {
  BlockParameters p;
  p.shortest_edge = 0.2;
  p.finer.push_back({.pieces = {{resized<3>(from), resized<3>(to)}}, .size = kFine, .distance = kReach});
  p.largest_size = largest;
  p.count = static_cast<int>(std::lround(SizedExtent(room_of_blocks(region), p.finer).blocks(largest)));
  return p;
}

/// Root of the mean area of the blocks in each band of distance.
/// \param band_of  band of a place; below 0: of none
template <class Band>
std::map<int, double> size_in_bands(const Cells<2>& t, Band band_of) {
  std::map<int, std::array<double, 2>> sums;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < t.cells.size(); ++c) {
    corners(t, c, polygon);
    const int band = band_of(centroid(polygon));
    if (band < 0) continue;
    sums[band][0] += area(polygon);
    ++sums[band][1];
  }
  std::map<int, double> sizes;
  for (const auto& [band, sum] : sums) sizes[band] = std::sqrt(sum[0] / sum[1]);
  return sizes;
}

// Promise: blocks are finer near a point too, such as the tip of a notch.
TEST(BlockSizes, AreFineAroundAPoint) {
  const FinerPart at_tip{.pieces = {{{{0.1, 0.05}}}}, .size = 2e-3, .distance = 5e-3};
  const BlockSizes sizes(4e-3, 8e-3, {at_tip});
  EXPECT_EQ(sizes.at(Vec<2>{{0.1, 0.05}}), 2e-3);
  EXPECT_EQ(sizes.at(Vec<2>{{0.1, 0.0549}}), 2e-3);
  EXPECT_EQ(sizes.at(Vec<2>{{0.1, 0.2}}), 8e-3);
  EXPECT_EQ(sizes.at(Vec<3>{{0.1, 0.05, 0.0049}}), 2e-3);
  EXPECT_DOUBLE_EQ(sizes.at(Vec<3>{{0.1, 0.05, 0.016}}), 4e-3);  // 11 mm beyond, a fifth more in 1.1 sizes
  const Region region = Region::rectangle(0.2, 0.1);
  const SizedExtent area(room_of_blocks(region), {at_tip});
  const double even = region.extent() / 64e-6;
  EXPECT_GT(area.blocks(8e-3), even + 15.0);  // a circle of 5 mm has 20 blocks of 2 mm, and 1 of 8 mm
  ASSERT_TRUE(area.largest_for(600));
  EXPECT_NEAR(area.blocks(*area.largest_for(600)), 600.0, 1e-6);
}

TEST(BlockSizes, GrowByAFifthFromBlockToBlockUpToTheLargest) {
  const BlockSizes sizes(4e-3, 8e-3, {{.pieces = {{{{0, 0}}, {{0, 1}}}}, .size = 2e-3, .distance = 5e-3}});
  const auto at = [&](double x) { return sizes.at(Vec<2>{{x, 0.5}}); };
  EXPECT_EQ(at(5e-3), 2e-3);
  double place = 5e-3, here = 2e-3;
  for (int blocks = 0; here < 8e-3; ++blocks) {
    ASSERT_LT(blocks, 9);
    const double next = std::min(1.2 * here, 8e-3);
    place += 0.5 * (here + next);
    EXPECT_NEAR(at(place), next, 1e-12);
    here = next;
  }
  EXPECT_EQ(at(0.5), 8e-3);
  EXPECT_EQ(sizes.relative(Vec<2>{{0.5, 0.5}}), 2.0);
  const BlockSizes half = sizes.scaled_to(2e-3);
  for (const double x : {0.0, 0.01, 0.02, 0.5}) EXPECT_DOUBLE_EQ(half.at(Vec<2>{{x, 0.5}}), 0.5 * at(x));
}

// Promise: the distance from a face is that from its plane over it, and that from its edge or corner beside
// it, whichever way its corners go; z does not count for a part along all z.
TEST(BlockSizes, AreFineNearAFaceABoxAndAlongZ) {
  constexpr double kSize = 1e-3, kLargest = 1.0, kDistance = 1e-2;
  const auto distance = [&](FinerPart part, const Vec<3>& place) {
    part.size = kSize;
    part.distance = kDistance;
    return (BlockSizes(0.5, kLargest, {part}).at(place) - kSize) / kSlopeOfSize + kDistance;
  };
  FinerPiece face{{{0, 0, 1}}, {{2, 0, 1}}, {{2, 1, 1}}, {{0, 1, 1}}};
  for (int sense = 0; sense < 2; ++sense) {
    EXPECT_NEAR(distance({.pieces = {face}}, {{1.9, 0.1, 0.7}}), 0.3, 1e-12);
    EXPECT_NEAR(distance({.pieces = {face}}, {{1.0, 1.3, 1.4}}), 0.5, 1e-12);
    EXPECT_NEAR(distance({.pieces = {face}}, {{2.1, 1.2, 1.2}}), 0.3, 1e-12);
    // the nearest of several
    FinerPiece other = face;
    for (Vec<3>& corner : other) corner[2] = 0.6;
    EXPECT_NEAR(distance({.pieces = {face, other}}, {{1.0, 0.5, 0.7}}), 0.1, 1e-12);
    EXPECT_NEAR(distance({.pieces = {other, face}}, {{1.0, 0.5, 0.9}}), 0.1, 1e-12);
    std::ranges::reverse(face);
  }
  const std::array<Vec<3>, 2> box{{{{0, 0, 0}}, {{1, 1, 1}}}};
  EXPECT_NEAR(distance({.box = box}, {{0.5, 1.3, 1.4}}), 0.5, 1e-12);
  EXPECT_NEAR(distance({.box = box, .is_along_z = true}, {{0.5, 1.3, 9.0}}), 0.3, 1e-12);
  EXPECT_NEAR(distance({.pieces = {{{{0, 0}}}}, .is_along_z = true}, {{0.3, 0.4, 7.0}}), 0.5, 1e-12);
}

// Promise: a face may have three corners or more, some in a line, be far away or tiny.
TEST(BlockSizes, AreFineNearFacesOfAnyCorners) {
  const auto distance = [](const FinerPiece& face, const Vec<3>& place) {
    return BlockSizes(0.5, 100.0, {{.pieces = {face}, .size = 1e-3}}).at(place) / kSlopeOfSize -
           1e-3 / kSlopeOfSize;
  };
  for (const double scale : {0.01, 1.0, 20.0}) {
    const auto at = [&](double x, double y, double z) { return scale * Vec<3>{{x, y, z}}; };
    const FinerPiece triangle{at(0, 0, 0), at(1, 0, 0), at(0, 1, 0)};
    const FinerPiece in_line{at(0, 0, 0), at(1, 0, 0), at(2, 0, 0), at(2, 1, 0), at(0, 1, 0)};
    for (const FinerPiece& face : {triangle, in_line}) {
      EXPECT_NEAR(distance(face, at(0.2, 0.2, 3.0)), 3.0 * scale, 1e-9 * scale);
      EXPECT_NEAR(distance(face, at(0.2, -3.0, 4.0)), 5.0 * scale, 1e-9 * scale);
    }
    EXPECT_NEAR(distance(triangle, at(1, 1, 0)), std::sqrt(0.5) * scale, 1e-9 * scale);
    EXPECT_NEAR(distance(in_line, at(1.9, 0.9, 0.01)), 0.01 * scale, 1e-9 * scale);
  }
  // the nearest of several, farther than 1 m
  const auto both = [](double first, double second) {
    const auto at = [](double z) { return FinerPiece{{{0, 0, z}}, {{1, 0, z}}, {{1, 1, z}}, {{0, 1, z}}}; };
    return BlockSizes(0.5, 100.0, {{.pieces = {at(first), at(second)}, .size = 1e-3}})
        .at(Vec<3>{{0.5, 0.5, 0.0}});
  };
  EXPECT_NEAR(both(3.0, 2.0), 1e-3 + 2.0 * kSlopeOfSize, 1e-12);
  EXPECT_NEAR(both(2.0, 3.0), 1e-3 + 2.0 * kSlopeOfSize, 1e-12);
  EXPECT_NEAR(both(3.0, 0.5), 1e-3 + 0.5 * kSlopeOfSize, 1e-12);
}

// Promise: of several parts, the one that asks for the finest blocks counts; sizes in proportion have all of
// their numbers in proportion.
TEST(BlockSizes, HaveASmallestALargestAndAMean) {
  const BlockSizes even(3e-3), scaled = even.scaled_to(2e-3);
  for (const auto& [sizes, size] : {std::pair(even, 3e-3), std::pair(scaled, 2e-3)}) {
    EXPECT_EQ(sizes.mean(), size);
    EXPECT_EQ(sizes.smallest(), size);
    EXPECT_EQ(sizes.largest(), size);
    EXPECT_EQ(sizes.at(Vec<2>{{0.1, 0.1}}), size);
    EXPECT_EQ(sizes.relative(Vec<2>{{0.1, 0.1}}), 1.0);
  }
  const BlockSizes finer(4e-3, 8e-3,
                         {{.pieces = {{{{0, 0}}}}, .size = 2e-3},
                          {.pieces = {{{{1, 0}}}}, .size = 3e-3},
                          {.pieces = {{{{2, 0}}}}, .size = 9e-3}});
  EXPECT_EQ(finer.smallest(), 2e-3);
  EXPECT_EQ(finer.at(Vec<2>{{1, 0}}), 3e-3);
  EXPECT_EQ(finer.at(Vec<2>{{2, 0}}), 8e-3);
  const BlockSizes twice = finer.scaled_to(8e-3).scaled_to(16e-3).scaled_to(8e-3);
  EXPECT_EQ(twice.mean(), 8e-3);
  EXPECT_EQ(twice.smallest(), 4e-3);
  EXPECT_EQ(twice.largest(), 16e-3);
  EXPECT_EQ(twice.at(Vec<2>{{1, 0}}), 6e-3);
}

// The integral of 1 / size² over a strip beside a side, in closed form.
TEST(SizedExtent, CountsBlocksAsTheIntegralDoes) {
  const Region region = Region::rectangle(0.2, 0.1);
  const std::vector<FinerPart> finer{{.pieces = {{{{0, 0}}, {{0, 0.1}}}}, .size = kFine, .distance = kReach}};
  const double largest = 6e-3, growing = (largest - kFine) / kSlopeOfSize;
  const double expected = 0.1 * (kReach / (kFine * kFine) + (1 / kFine - 1 / largest) / kSlopeOfSize +
                                 (0.2 - kReach - growing) / (largest * largest));
  const SizedExtent sized(room_of_blocks(region), finer);
  EXPECT_NEAR(sized.blocks(largest) / expected, 1.0, 0.01);  // pieces are as wide as a block
  EXPECT_NEAR(sized.largest_for(sized.blocks(largest)).value(), largest, 1e-9);
  EXPECT_FALSE(sized.largest_for(200.0).has_value());
}

// Promise: a body that is not its whole box has the blocks of its own part alone.
TEST(SizedExtent, CountsBlocksOfTheBodyAlone) {
  const FinerPart left{.pieces = {{{{0, 0}}, {{0, 0.1}}}}, .size = kFine, .distance = kReach};
  const double largest = 6e-3, growing = (largest - kFine) / kSlopeOfSize;
  const double of_growth = (1 / kFine - 1 / largest) / kSlopeOfSize;
  const auto expected = [&](double width) {
    return 0.1 * (kReach / (kFine * kFine) + of_growth + (width - kReach - growing) / (largest * largest));
  };
  const Room<2> half{{}, {{0.2, 0.1}}, 0.01, [](const Vec<2>& p) { return p[0] - 0.1; }};
  const Room<2> whole{{}, {{0.2, 0.1}}, 0.02, {}};
  EXPECT_NEAR(SizedExtent(half, {left}).blocks(largest) / expected(0.1), 1.0, 2e-3);
  EXPECT_NEAR(SizedExtent(whole, {left}).blocks(largest) / expected(0.2), 1.0, 2e-3);
}

// Promise: a body is cut into 64 pieces along its longest side at least, and sizes that no memory would hold
// are cut to the 2048th part of it.
TEST(SizedExtent, CutsABodyFinelyEnoughAndNotTooFine) {
  const Room<2> body{{}, {{1.0, 0.5}}, 0.5, {}};
  const FinerPart coarse{.pieces = {{{{0, 0}}, {{0, 1}}}}, .size = 0.2, .distance = 0.0};
  const double expected = 0.5 * (1 / 0.2 - 1 / (0.2 + kSlopeOfSize)) / kSlopeOfSize;
  EXPECT_NEAR(SizedExtent(body, {coarse}).blocks(1.0) / expected, 1.0, 1e-4);  // the middle rule over 64
  // one column of pieces, 1 / 2048 wide, has its size in its middle
  const FinerPart tiny{.pieces = {{{{0, 0}}, {{0, 1}}}}, .size = 1e-6, .distance = 0.0};
  const double first = 1e-6 + kSlopeOfSize / 4096;
  EXPECT_NEAR(SizedExtent(body, {tiny}).blocks(1.0) / (0.5 / 2048 / (first * first)), 1.35, 0.15);
}

// Promise: a number of blocks that needs no larger ones than the body has is met by the largest of them, one
// more is met by smaller blocks, one less by none.
TEST(SizedExtent, TellsTheLargestSizeUpToItsBounds) {
  const Room<2> body{{}, {{0.2, 0.1}}, 0.02, {}};
  const SizedExtent sized(body, {{.pieces = {{{{0, 0}}, {{0, 0.1}}}}, .size = kFine, .distance = kReach}});
  const double farthest = kFine + kSlopeOfSize * (0.2 - kReach), fewest = sized.blocks(1.0);
  ASSERT_TRUE(sized.largest_for(fewest));
  EXPECT_LE(*sized.largest_for(fewest), farthest);
  EXPECT_GT(*sized.largest_for(fewest), 0.95 * farthest);
  EXPECT_FALSE(sized.largest_for(fewest - 1e-6));
  for (const double count : {fewest + 1.0, 1e5, 1e8})
    EXPECT_NEAR(sized.blocks(*sized.largest_for(count)) / count, 1.0, 1e-9);
}

// The integral of 1 / size³ over a box beside one of its faces, and around its middle, in closed form.
TEST(SizedExtent, CountsBlocksOfSpaceAsTheIntegralDoes) {
  const Room<3> body{{}, {{0.2, 0.1, 0.1}}, 0.2 * 0.1 * 0.1, {}};
  const FinerPart left{.pieces = {{{{0, 0, 0}}, {{0, 0.1, 0}}, {{0, 0.1, 0.1}}, {{0, 0, 0.1}}}},
                       .size = kFine,
                       .distance = kReach};
  const double largest = 6e-3, growing = (largest - kFine) / kSlopeOfSize, cube = std::pow(largest, 3);
  const double expected = 0.01 * (kReach / std::pow(kFine, 3) +
                                  (1 / (kFine * kFine) - 1 / (largest * largest)) / (2.0 * kSlopeOfSize) +
                                  (0.2 - kReach - growing) / cube);
  const SizedExtent sized(body, {left});
  EXPECT_NEAR(sized.blocks(largest) / expected, 1.0, 0.02);  // boxes are as wide as a block
  EXPECT_NEAR(sized.largest_for(sized.blocks(largest)).value(), largest, 1e-9);
  const FinerPart middle{.pieces = {{{{0.1, 0.05, 0.05}}}}, .size = kFine, .distance = kReach};
  constexpr int kShells = 10'000;
  double around = body.extent / cube;
  for (int i = 0; i < kShells; ++i) {
    const double width = (kReach + growing) / kShells, r = (i + 0.5) * width;
    const double size = kFine + kSlopeOfSize * std::max(0.0, r - kReach);
    around += 4.0 * std::numbers::pi * r * r * width * (1.0 / std::pow(size, 3) - 1.0 / cube);
  }
  EXPECT_NEAR(SizedExtent(body, {middle}).blocks(largest) / around, 1.0, 0.03);
}

// Promise: places are drawn as often as there are blocks, in space too.
TEST(PlaceDraw, DrawsPlacesAsOftenAsThereAreBlocks) {
  const Room<3> body{{}, {{0.2, 0.1, 0.1}}, 0.2 * 0.1 * 0.1, {}};
  const FinerPart left{.pieces = {{{{0, 0, 0}}, {{0, 0.1, 0}}, {{0, 0.1, 0.1}}, {{0, 0, 0.1}}}},
                       .size = kFine,
                       .distance = kReach};
  const BlockSizes sizes(4e-3, 6e-3, {left});
  const PlaceDraw draw(body, sizes);
  Random random(1);
  constexpr int kDraws = 20'000;
  int fine = 0;
  for (int i = 0; i < kDraws; ++i) fine += draw.draw(random)[0] < kReach ? 1 : 0;
  const double share = 0.01 * kReach / std::pow(kFine, 3) / SizedExtent(body, {left}).blocks(6e-3);
  EXPECT_NEAR(fine / double(kDraws), share, 4.0 * std::sqrt(share / kDraws) + 0.02 * share);
}

// Promise: of places drawn where blocks grow, each band has its share; none lies outside of the body by more
// than its part's half diagonal.
TEST(PlaceDraw, HasTheSharesOfBandsOverTheGrowth) {
  const Room<2> body{{}, {{0.1, 0.05}}, 0.1 * 0.05, [](const Vec<2>& p) { return p[0] - 0.05; }};
  const BlockSizes sizes(4e-3, 20e-3,
                         {{.pieces = {{{{0, 0}}, {{0, 0.05}}}}, .size = kFine, .distance = 0.0}});
  const PlaceDraw draw(body, sizes);
  Random random(1);
  constexpr int kDraws = 40'000, kBands = 5;
  std::array<int, kBands> drawn{};
  int within = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Vec<2> place = draw.draw(random);
    EXPECT_LT(place[0], 0.05 + 0.1 / 64);
    EXPECT_TRUE(place[0] > 0.0 && place[1] > 0.0 && place[1] < 0.05);
    if (place[0] >= 0.05) continue;
    ++drawn[static_cast<std::size_t>(kBands * place[0] / 0.05)];
    ++within;
  }
  const auto up_to = [](double x) { return (1 / kFine - 1 / (kFine + kSlopeOfSize * x)) / kSlopeOfSize; };
  for (int band = 0; band < kBands; ++band) {
    const double share = (up_to(0.01 * (band + 1)) - up_to(0.01 * band)) / up_to(0.05);
    EXPECT_NEAR(drawn[static_cast<std::size_t>(band)], share * within, 4.0 * std::sqrt(share * within))
        << band;
  }
}

// Promise: a deck of years ago makes the blocks that it made: the same seed draws the same places.
TEST(PlaceDraw, DrawsThePlacesThatItDrew) {
  const FinerPart part{.pieces = {{{{0, 0, 0}}, {{0, 0.05, 0}}}}, .size = kFine, .distance = kReach};
  const BlockSizes sizes(4e-3, 20e-3, {part});
  const auto sum = [&](const auto& draw) {
    Random random(1);
    double result = 0.0;
    for (int i = 0; i < 200; ++i) result += norm(draw.draw(random));
    return result;
  };
  const Room<2> half{{}, {{0.1, 0.05}}, 0.0025, [](const Vec<2>& p) { return p[0] + p[1] - 0.07; }};
  const Room<3> ball{{}, {{0.1, 0.1, 0.1}}, 5e-4, [](const Vec<3>& p) { return norm(p) - 0.1; }};
  EXPECT_NEAR(sum(PlaceDraw<2>(half, sizes)), 5.87635532998745, 1e-9);
  EXPECT_NEAR(sum(PlaceDraw<3>(ball, sizes)), 9.31488622486042, 1e-9);
}

TEST(FinerBlocks, HaveTheirSizesNearAndFarAndTileTheBody) {
  const Region region = Region::rectangle(0.2, 0.15);
  const BlockParameters p = finer_near({{0, 0}}, {{0, 0.15}}, 6e-3, region);
  std::map<int, double> sum;
  constexpr int kSeeds = 12;
  const double growing = (6e-3 - kFine) / kSlopeOfSize;  // 22 mm
  // bands of 5 mm: up to the distance, over the growth, and beyond
  const auto band = [](const Vec<2>& place) { return static_cast<int>(place[0] / 5e-3); };
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const Blocks<2> blocks = make_blocks(p, region, random);
    EXPECT_EQ(std::ssize(blocks.cells.cells), p.count);
    EXPECT_EQ(std::ssize(blocks.size), p.count);
    EXPECT_EQ(blocks.done.edges_left_short, 0);
    require_valid(blocks.cells, region, "finer blocks");
    for (const auto& [number, size] : size_in_bands(blocks.cells, band)) sum[number] += size / kSeeds;
  }
  EXPECT_NEAR(0.5 * (sum[0] + sum[1]), kFine, 0.1 * kFine);
  for (int number = 2; number * 5e-3 < kReach + growing; ++number) {
    const double middle = (number + 0.5) * 5e-3, size = kFine + kSlopeOfSize * (middle - kReach);
    EXPECT_NEAR(sum[number], size, 0.1 * size) << number;
  }
  // from the first of the bands that grow to the last, by the blocks between them
  const int first = 2, last = static_cast<int>((kReach + growing) / 5e-3) - 1;
  double blocks = 0.0;
  for (int number = first; number < last; ++number) blocks += 5e-3 / (0.5 * (sum[number] + sum[number + 1]));
  EXPECT_LT(std::pow(sum[last] / sum[first], 1.0 / blocks), 1.21);  // 1.2, and the scatter of 12 seeds
  const auto far = [&](const Vec<2>& place) { return place[0] > kReach + growing ? 0 : -1; };
  Random random(9);
  EXPECT_NEAR(size_in_bands(make_blocks(p, region, random).cells, far)[0], 6e-3, 0.05 * 6e-3);
}

TEST(FinerBlocks, KeepTheirSizesUnderRelaxationAndShortEdgesInProportion) {
  const Region region = Region::rectangle(0.2, 0.15);
  BlockParameters p = finer_near({{0, 0}}, {{0, 0.15}}, 6e-3, region);
  p.relaxation = 20;
  Random random(1);
  const Cells<2> t = make_blocks(p, region, random).cells;
  const auto near = size_in_bands(t, [](const Vec<2>& place) { return place[0] < kReach ? 0 : -1; });
  EXPECT_NEAR(near.at(0), kFine, 0.1 * kFine);
  // edges of fine blocks are as short against their mean as those of coarse ones
  double sum = 0.0, shortest = 1.0;
  int count = 0;
  for (const Facet<2>& e : facets(t)) {
    const Vec<2>&a = t.vertices[e.corners[0]], &b = t.vertices[e.corners[1]];
    if (0.5 * (a + b)[0] > kReach) continue;
    sum += norm(b - a);
    shortest = std::min(shortest, norm(b - a));
    ++count;
  }
  EXPECT_LT(shortest, 0.3 * sum / count);
}

TEST(FinerBlocks, FollowNotchesHolesAndArcs) {
  const Region disc = Region::polygon(
      circle_corners({{0, 0}}, 0.15, [](const Vec<2>& at) { return at[1] > 0.0 ? 2e-3 : 4e-3; }), {"rim"},
      true);
  EXPECT_NEAR(disc.extent(), std::numbers::pi * 0.075 * 0.075, 1e-9);
  const double size = 2e-3;
  for (const double opening : {0.0, 3e-3}) {
    const Region whole = Region::rectangle(0.2, 0.1);
    const Region region = whole
                              .with_holes(std::array{Hole{
                                  "hole",
                                  circle_corners({{0.15, 0.06}}, 0.03,
                                                 [](const Vec<2>& at) { return at[0] < 0.15 ? 4e-3 : 5e-3; }),
                                  true}})
                              .with_notches(std::array{Notch{.name = "notch",
                                                             .mouth = {{0.1, 0}},
                                                             .tip = {{0.1, 0.05}},
                                                             .width = opening,
                                                             .point = slot_point(0.05, opening, size)}});
    BlockParameters p = finer_near({{0.1, 0.05}}, {{0.1, 0.1}}, 6e-3, region);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Random random(seed);
      const Cells<2> t = make_blocks(p, region, random).cells;
      require_valid(t, region, "blocks");
      for (const Piece& piece : region.pieces())
        EXPECT_NE(std::ranges::find(t.vertices, piece.from), t.vertices.end());
      double slit = 0.0;
      for (const Facet<2>& e : facets(t))
        if (region.slit_of(t.vertices[e.corners[0]], t.vertices[e.corners[1]]))
          slit += norm(t.vertices[e.corners[1]] - t.vertices[e.corners[0]]);
      EXPECT_NEAR(slit, opening > 0.0 ? 0.0 : 0.05, 1e-9);
    }
  }
}

TEST(FinerBlocks, FollowStones) {
  SpecimenParameters p = paper_specimen(1);
  p.superposition = Superposition::follow;
  p.blocks.finer.push_back({.pieces = {{{{0, 0}}, {{0, 0.3}}}}, .size = 2.5e-3, .distance = 20e-3});
  p.blocks.largest_size = 5e-3;
  p.blocks.count =
      static_cast<int>(std::lround(SizedExtent(room_of_blocks(*p.region()), p.blocks.finer).blocks(5e-3)));
  const Specimen<2> s = make_specimen(p);
  EXPECT_EQ(std::ssize(s.cells.cells), p.blocks.count);
  EXPECT_NEAR(s.fraction_superposed, s.fraction_placed, 0.02 * s.fraction_placed);
  const auto sizes = size_in_bands(s.cells, [](const Vec<2>& place) {
    return place[0] < 20e-3 ? 0 : place[0] > 35e-3 ? 1 : -1;
  });
  EXPECT_NEAR(sizes.at(0), 2.5e-3, 0.25e-3);
  EXPECT_NEAR(sizes.at(1), 5e-3, 0.5e-3);
}

}  // namespace
}  // namespace pyroclast::specimen
