#include "pyroclast/specimen/regularisation.hpp"

#include <algorithm>

#include "examples.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// A 2 x 2 square in four cells that meet at the ends of an edge of length `edge` in the middle.
Tessellation four_cells(double edge) {
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
  const Tessellation t = four_cells(0.1);
  const std::vector<Edge> all = edges(t);
  int outline = 0;
  for (const Edge& e : all) {
    const auto& left = t.cells[static_cast<std::size_t>(e.left)];
    const auto v0 = std::find(left.begin(), left.end(), e.v0);
    ASSERT_NE(v0, left.end());
    EXPECT_EQ(v0 + 1 == left.end() ? left.front() : *(v0 + 1), e.v1) << "left sees the edge from v0 to v1";
    if (e.right < 0) {
      ++outline;
    } else {
      EXPECT_GT(e.right, e.left);
    }
  }
  EXPECT_EQ(outline, 8);
  EXPECT_EQ(all.size(), 13U);  // Euler: vertices - edges + cells = 1
}

TEST(Edges, RefusesCellsThatOverlap) {
  Tessellation t = four_cells(0.1);
  t.cells.push_back({1, 2, 3, 9});
  EXPECT_TRUE(says(error_of([&] { edges(t); }), "overlaps"));
}

TEST(Regularisation, MergesTheEndsOfAShortEdgeInTheMiddle) {
  Tessellation t = four_cells(0.1);
  const Regularisation done = regularise(t, 2, 2, 0.2);
  EXPECT_EQ(done.edges_removed, 1);
  EXPECT_EQ(done.edges_left_short, 0);
  EXPECT_TRUE(done.unfit.empty());
  EXPECT_EQ(t.vertices.size(), 9U);
  EXPECT_EQ(std::count(t.vertices.begin(), t.vertices.end(), Vec<2>{{1, 1}}), 1);
  for (const auto& cell : t.cells) EXPECT_EQ(cell.size(), 4U);
}

TEST(Regularisation, LeavesLongerEdgesAlone) {
  Tessellation t = four_cells(0.4);
  EXPECT_EQ(regularise(t, 2, 2, 0.2).edges_removed, 0);
  EXPECT_EQ(t.vertices, four_cells(0.4).vertices);
}

TEST(Regularisation, KeepsOutlineVerticesOnTheirSide) {
  Tessellation t = four_cells(0.6);
  t.vertices[1] = {{0.05, 0}};  // a short edge from the corner along the bottom
  const Regularisation done = regularise(t, 2, 2, 0.2);
  // The corner stays; merging the other end into it would leave a cell whose first corner is gone from the
  // bottom.
  EXPECT_TRUE(mismatched_cells(t, 2, 2).empty());
  EXPECT_EQ(done.edges_removed, 1);
  EXPECT_EQ(std::count(t.vertices.begin(), t.vertices.end(), Vec<2>{{0, 0}}), 1);
}

TEST(Regularisation, DoesNotRemoveATriangleButNamesIt) {
  // The corner (0, 0) is cut off by a small triangle: its edges are short, and none can go.
  Tessellation t{{{{0, 0}}, {{0.1, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}, {{0, 0.1}}},
                 {{0, 1, 5}, {1, 2, 3, 4, 5}}};
  const Regularisation done = regularise(t, 2, 2, 0.14);  // shorter than 0.16 is short
  EXPECT_EQ(done.edges_removed, 0);
  EXPECT_EQ(done.edges_left_short, 3);
  EXPECT_EQ(done.unfit, std::vector<int>{0});
  EXPECT_EQ(t.cells[0].size(), 3U);
}

TEST(Regularisation, NamesTheSmallerNeighbourOfAFlatCorner) {
  // Cell 0 has a corner of nearly 180 degrees where cells 1 and 2 meet.
  Tessellation t{{{{0, 0}}, {{2, 0}}, {{2, 1}}, {{0, 1}}, {{2, 2}}, {{0.8, 2}}, {{0, 2}}, {{0.8, 1.001}}},
                 {{0, 1, 2, 7, 3}, {2, 4, 5, 7}, {3, 7, 5, 6}}};
  EXPECT_EQ(regularise(t, 2, 2, 0.1).unfit, std::vector<int>{2});
}

}  // namespace
}  // namespace pyroclast::specimen
