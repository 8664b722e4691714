#include "pyroclast/specimen/block_order.hpp"

#include <algorithm>
#include <cstdlib>

#include "examples.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// n x n unit squares, row by row.
Tessellation squares(int n) {
  Tessellation t;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) t.vertices.push_back({{1.0 * x, 1.0 * y}});
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const int v = y * (n + 1) + x;
      t.cells.push_back({v, v + 1, v + n + 2, v + n + 1});
    }
  }
  return t;
}

/// The corners of every cell, in the order of their coordinates.
std::vector<std::vector<Vec<2>>> sorted_polygons(const Tessellation& t) {
  std::vector<std::vector<Vec<2>>> polygons(t.cells.size());
  for (std::size_t c = 0; c < t.cells.size(); ++c) corners(t, c, polygons[c]);
  std::sort(polygons.begin(), polygons.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](const Vec<2>& p, const Vec<2>& q) { return p.c < q.c; });
  });
  return polygons;
}

Tessellation random_cells(int count) {
  Random random(3);
  Seeds seeds;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform();
    seeds.position.push_back({{x, 2.0 * random.uniform()}});
    seeds.radius.push_back(1.0);
  }
  return laguerre_tessellation(seeds, Region::rectangle(1.0, 2.0)).tessellation;
}

TEST(BlockOrder, GoesFromSquareToSquareAcrossAnEdge) {
  Tessellation t = squares(16);
  number_along_curve(t, {{}, {{16.0, 16.0}}});
  std::vector<int> steps(t.cells.size(), 0);  // joined to the next one by an edge
  for (const Edge& e : edges(t)) {
    if (e.right >= 0 && std::abs(e.right - e.left) == 1) ++steps[static_cast<std::size_t>(e.left)];
  }
  EXPECT_EQ(std::count(steps.begin(), steps.end(), 1), 255);
}

TEST(BlockOrder, ChangesNumbersAndNothingElse) {
  const Tessellation before = random_cells(500);
  Tessellation after = before;
  number_along_curve(after, {{}, {{1.0, 2.0}}});
  EXPECT_NE(after.cells, before.cells);
  EXPECT_EQ(sorted_polygons(after), sorted_polygons(before));
  EXPECT_TRUE(mismatched_cells(after, Region::rectangle(1.0, 2.0)).empty());
}

TEST(BlockOrder, DoesNotDependOnTheOrderBefore) {
  Tessellation t = random_cells(500);
  Tessellation other = t;
  std::reverse(other.cells.begin(), other.cells.end());
  number_along_curve(t, {{}, {{1.0, 2.0}}});
  number_along_curve(other, {{}, {{1.0, 2.0}}});
  EXPECT_EQ(other.cells, t.cells);
  EXPECT_EQ(other.vertices, t.vertices);
}

}  // namespace
}  // namespace pyroclast::specimen
