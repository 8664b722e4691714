#include "pyroclast/specimen/regularisation.hpp"

#include <algorithm>
#include <numbers>

#include "examples.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// A 2 x 2 square in four cells that meet at the ends of an edge of length `edge` in the middle.
Cells<2> four_cells(double edge) {
  const double h = edge / 2;
  return {{{{0, 0}},
           {{1, 0}},
           {{2, 0}},
           {{2, 1}},
           {{2, 2}},
           {{1, 2}},
           {{0, 2}},
           {{0, 1}},
           {{1 - h, 1}},
           {{1 + h, 1}}},
          {{0, 1, 9, 8, 7}, {1, 2, 3, 9}, {3, 4, 5, 9}, {5, 6, 7, 8, 9}}};
}

TEST(Edges, EachOnceWithBothItsCells) {
  const Cells<2> t = four_cells(0.1);
  const std::vector<Facet<2>> all = facets(t);
  int outline = 0;
  for (const Facet<2>& e : all) {
    const auto& left = t.cells[static_cast<std::size_t>(e.inner)];
    const auto v0 = std::find(left.begin(), left.end(), e.corners[0]);
    ASSERT_NE(v0, left.end());
    EXPECT_EQ(v0 + 1 == left.end() ? left.front() : *(v0 + 1), e.corners[1])
        << "left sees the edge from v0 to v1";
    if (e.outer < 0) {
      ++outline;
    } else {
      EXPECT_GT(e.outer, e.inner);
    }
  }
  EXPECT_EQ(outline, 8);
  EXPECT_EQ(all.size(), 13U);  // Euler: vertices - edges + cells = 1
}

TEST(Edges, RefusesCellsThatOverlap) {
  Cells<2> t = four_cells(0.1);
  t.cells.push_back({1, 2, 3, 9});
  EXPECT_TRUE(says(message([&] { facets(t); }), "overlaps"));
}

TEST(Regularisation, MergesTheEndsOfAShortEdgeInTheMiddle) {
  Cells<2> t = four_cells(0.1);
  const RegularisedCells done = regularise(t, Region::rectangle(2, 2), {0.2});
  EXPECT_EQ(done.vertices_merged, 1);
  EXPECT_EQ(done.edges_left_short, 0);
  EXPECT_TRUE(done.unfit.empty());
  EXPECT_EQ(t.vertices.size(), 9U);
  EXPECT_EQ(std::count(t.vertices.begin(), t.vertices.end(), Vec<2>{{1, 1}}), 1);
  for (const auto& cell : t.cells) EXPECT_EQ(cell.size(), 4U);
}

TEST(Regularisation, LeavesLongerEdgesAlone) {
  Cells<2> t = four_cells(0.4);
  EXPECT_EQ(regularise(t, Region::rectangle(2, 2), {0.2}).vertices_merged, 0);
  EXPECT_EQ(t.vertices, four_cells(0.4).vertices);
}

TEST(Regularisation, KeepsOutlineVerticesOnTheirSide) {
  Cells<2> t = four_cells(0.6);
  t.vertices[1] = {{0.05, 0}};  // a short edge from the corner along the bottom
  const RegularisedCells done = regularise(t, Region::rectangle(2, 2), {0.2});
  // The corner stays in place, the other end moves into it.
  EXPECT_TRUE(mismatched_cells(t, Region::rectangle(2, 2)).empty());
  EXPECT_EQ(done.vertices_merged, 1);
  EXPECT_EQ(std::count(t.vertices.begin(), t.vertices.end(), Vec<2>{{0, 0}}), 1);
}

TEST(Regularisation, DoesNotRemoveATriangleButNamesIt) {
  // The corner (0, 0) is cut off by a small triangle: its edges are short, and none can go.
  Cells<2> t{{{{0, 0}}, {{0.1, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}, {{0, 0.1}}}, {{0, 1, 5}, {1, 2, 3, 4, 5}}};
  const RegularisedCells done = regularise(t, Region::rectangle(2, 2), {0.14});  // shorter than 0.16 is short
  EXPECT_EQ(done.vertices_merged, 0);
  EXPECT_EQ(done.edges_left_short, 3);
  EXPECT_EQ(done.unfit, std::vector<int>{0});
  EXPECT_EQ(t.cells[0].size(), 3U);
}

TEST(Regularisation, NamesTheSmallerNeighbourOfAFlatCorner) {
  // Cell 0 has a corner of nearly 180 degrees where cells 1 and 2 meet.
  Cells<2> t{{{{0, 0}}, {{2, 0}}, {{2, 1}}, {{0, 1}}, {{2, 2}}, {{0.8, 2}}, {{0, 2}}, {{0.8, 1.001}}},
             {{0, 1, 2, 7, 3}, {2, 4, 5, 7}, {3, 7, 5, 6}}};
  EXPECT_EQ(regularise(t, Region::rectangle(2, 2), {0.1}).unfit, std::vector<int>{2});
}

TEST(Regularisation, NeverMakesAFlatCornerOrASliverThatWasNotThere) {
  Random random(3);
  Seeds<2> seeds;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform();
    seeds.position.push_back({{x, random.uniform()}});
    seeds.radius.push_back(0.01);
  }
  const Cells<2> before = laguerre_cells(seeds, Region::rectangle(1, 1)).cells;
  Cells<2> after = before;
  EXPECT_GT(regularise(after, Region::rectangle(1, 1), {0.3}).vertices_merged, 0);
  // The bound on slivers grows with the mean edge, so the one at the start holds throughout.
  const double thinnest = sliver_share * 0.3 * measure(before).mean_edge;
  const double flattest = largest_block_angle * std::numbers::pi / 180;
  std::vector<Vec<2>> a;
  std::vector<Vec<2>> b;
  for (std::size_t c = 0; c < before.cells.size(); ++c) {
    corners(before, c, a);
    corners(after, c, b);
    EXPECT_GE(thinnest_zone(b), std::min(thinnest, thinnest_zone(a)) * (1 - 1e-9)) << "cell " << c;
    EXPECT_LE(largest_angle(b), std::max(flattest, largest_angle(a)) * (1 + 1e-9)) << "cell " << c;
  }
}

}  // namespace
}  // namespace pyroclast::specimen
