#include "pyroclast/specimen/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "examples.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double width = 0.15;
constexpr double height = 0.3;
const Region region = Region::rectangle(width, height);

BlockParameters block_parameters(int count, double shortest_edge, double radius_spread) {
  BlockParameters p;
  p.count = count;
  p.shortest_edge = shortest_edge;
  p.radius_spread = radius_spread;
  return p;
}

std::vector<Vec<2>> polygon_of(const Cells<2>& t, std::size_t cell) {
  std::vector<Vec<2>> polygon;
  corners(t, cell, polygon);
  return polygon;
}

void expect_exact_tiling(const Cells<2>& t) {
  double total = 0;
  for (std::size_t c = 0; c < t.cells.size(); ++c) total += area(polygon_of(t, c));
  EXPECT_NEAR(total / (width * height), 1, 1e-12);  // rounding of up to a hundred thousand terms

  double outline = 0;
  for (const Facet<2>& e : facets(t)) {
    const Vec<2>& a = t.vertices[static_cast<std::size_t>(e.corners[0])];
    const Vec<2>& b = t.vertices[static_cast<std::size_t>(e.corners[1])];
    const bool on_outline = region.side_of(a, b).has_value();
    EXPECT_EQ(e.outer < 0, on_outline);
    if (e.outer < 0) outline += norm(b - a);
  }
  EXPECT_NEAR(outline, 2 * (width + height), 1e-12);
  for (const double x : {0.0, width}) {
    for (const double y : {0.0, height}) {
      EXPECT_EQ(std::count(t.vertices.begin(), t.vertices.end(), Vec<2>{{x, y}}), 1);
    }
  }
}

void expect_fit_blocks(const Cells<2>& t, double shortest_edge) {
  const double limit = shortest_edge * measure(t).mean_edge;
  for (const Facet<2>& e : facets(t)) {
    EXPECT_GE(norm(t.vertices[static_cast<std::size_t>(e.corners[1])] -
                   t.vertices[static_cast<std::size_t>(e.corners[0])]),
              limit * (1 - 1e-12));  // the mean is summed in another order
  }
  for (std::size_t c = 0; c < t.cells.size(); ++c) {
    const std::vector<Vec<2>> polygon = polygon_of(t, c);
    EXPECT_GE(polygon.size(), 3U);
    EXPECT_LE(largest_angle(polygon), largest_block_angle * std::numbers::pi / 180);
    EXPECT_GT(thinnest_zone(polygon), sliver_share * limit * (1 - 1e-12));
  }
}

class AnyBlocks : public testing::TestWithParam<std::tuple<int, double, double>> {};

TEST_P(AnyBlocks, TileExactlyAndAreFit) {
  const auto [count, shortest_edge, radius_spread] = GetParam();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Blocks<2> blocks =
        make_blocks(block_parameters(count, shortest_edge, radius_spread), region, random);
    EXPECT_EQ(blocks.cells.cells.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(blocks.done.edges_left_short, 0);
    expect_exact_tiling(blocks.cells);
    expect_fit_blocks(blocks.cells, shortest_edge);
  }
}

INSTANTIATE_TEST_SUITE_P(Specimen, AnyBlocks,
                         testing::Combine(testing::Values(100, 700, 5000),
                                          testing::Values(0.0, 0.1, 0.2, 0.3), testing::Values(0.0, 0.3)));

TEST(Blocks, AHundredThousandTileExactlyAndAreFit) {
  Random random(1);
  const Blocks<2> blocks = make_blocks(block_parameters(100000, 0.2, 0.0), region, random);
  EXPECT_EQ(blocks.done.edges_left_short, 0);
  expect_exact_tiling(blocks.cells);
  expect_fit_blocks(blocks.cells, 0.2);
}

TEST(Blocks, VeryFewBlocksWork) {
  for (int count = 1; count <= 12; ++count) {
    Random random(static_cast<std::uint64_t>(count));
    expect_exact_tiling(make_blocks(block_parameters(count, 0.2, 0.0), region, random).cells);
  }
}

TEST(Blocks, RedrawingTouchesFewSeeds) {
  Random random(1);
  // Redrawn seeds make the tessellation less random than asked for; the promise is that they stay few.
  EXPECT_LT(make_blocks(block_parameters(5000, 0.2, 0.0), region, random).done.seeds_redrawn, 50);
}

TEST(Blocks, RelaxationEvensOutTheAreas) {
  const auto scatter = [](int relaxation) {
    BlockParameters p = block_parameters(1000, 0.1, 0.0);
    p.relaxation = relaxation;
    Random random(1);
    const Cells<2> t = make_blocks(p, region, random).cells;
    double sum = 0;
    const double mean = width * height / 1000;
    for (std::size_t c = 0; c < t.cells.size(); ++c) sum += std::pow(area(polygon_of(t, c)) / mean - 1, 2);
    return std::sqrt(sum / 1000);
  };
  // Areas of Poisson-Voronoi cells scatter by 0.53 of their mean (Okabe et al., Spatial Tessellations, 2000).
  EXPECT_NEAR(scatter(0), 0.53, 0.06);
  EXPECT_LT(scatter(5), 0.3);
}

/// Seeds all over the rectangle, with radii of half the mean distance, more or less by a share of up to
/// `spread`.
Seeds<2> random_seeds(std::uint64_t seed, int count, double spread) {
  Random random(seed);
  Seeds<2> seeds;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, width);
    seeds.position.push_back({{x, random.uniform(0, height)}});
    seeds.radius.push_back(random.uniform(1 - spread, 1 + spread) * 0.5 * std::sqrt(width * height / count));
  }
  return seeds;
}

TEST(Laguerre, EveryPointOfACellBelongsToItsSeed) {
  const Seeds<2> seeds = random_seeds(5, 300, 0.5);
  const Laguerre<2> result = laguerre_cells(seeds, region);
  const auto power = [&](const Vec<2>& p, std::size_t i) {
    const Vec<2> d = p - seeds.position[i];
    return dot(d, d) - seeds.radius[i] * seeds.radius[i];
  };
  for (std::size_t c = 0; c < 300; ++c) {
    if (result.cells.cells[c].empty()) {
      EXPECT_TRUE(std::binary_search(result.broken.begin(), result.broken.end(), static_cast<int>(c)));
      continue;
    }
    for (const Vec<2>& p : polygon_of(result.cells, c)) {
      for (std::size_t other = 0; other < 300; ++other) {
        // A vertex is as near, in the power sense, to the seeds around it: equal up to the merging of
        // vertices.
        EXPECT_LE(power(p, c), power(p, other) + 1e-9 * width * height);
      }
    }
  }
}

/// Relaxed seeds and their cells, made by a number of threads.
std::pair<Seeds<2>, Cells<2>> relaxed_cells(int threads) {
  Seeds<2> seeds = random_seeds(7, 2000, 0.3);
  Team team(threads, WhenCrowded::stay);
  for (int i = 0; i < 3; ++i) relax(seeds, region, 0, &team);
  Cells<2> cells = laguerre_cells(seeds, region, &team).cells;
  return {seeds, cells};
}

TEST(Laguerre, IsBitwiseTheSameForAnyNumberOfThreads) {
  const auto [seeds, cells] = relaxed_cells(1);
  for (const int threads : {2, 5}) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    const auto [other_seeds, other_cells] = relaxed_cells(threads);
    EXPECT_EQ(other_seeds.position, seeds.position);
    EXPECT_EQ(other_cells.vertices, cells.vertices);
    EXPECT_EQ(other_cells.cells, cells.cells);
  }
}

TEST(Laguerre, LargerRadiiGiveLargerCells) {
  Seeds<2> seeds{{{{0.05, 0.15}}, {{0.1, 0.15}}}, {0.04, 0.02}};
  const Laguerre<2> result = laguerre_cells(seeds, region);
  ASSERT_TRUE(result.broken.empty());
  // Power line: (x - 0.05)^2 - 0.04^2 = (x - 0.1)^2 - 0.02^2.
  const double line = 0.075 + (0.04 * 0.04 - 0.02 * 0.02) / (2 * 0.05);
  EXPECT_NEAR(area(polygon_of(result.cells, 0)), line * height, 1e-12);
}

TEST(Laguerre, NamesTheSeedsOfEmptyCells) {
  Seeds<2> seeds{{{{0.05, 0.15}}, {{0.051, 0.15}}, {{0.1, 0.1}}}, {0.03, 0.001, 0.03}};
  EXPECT_EQ(laguerre_cells(seeds, region).broken, std::vector<int>{1});
}

}  // namespace
}  // namespace pyroclast::specimen
