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
Cells<2> squares(int n) {
  Cells<2> t;
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
std::vector<std::vector<Vec<2>>> sorted_polygons(const Cells<2>& t) {
  std::vector<std::vector<Vec<2>>> polygons(t.cells.size());
  for (std::size_t c = 0; c < t.cells.size(); ++c) corners(t, c, polygons[c]);
  std::sort(polygons.begin(), polygons.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](const Vec<2>& p, const Vec<2>& q) { return p.c < q.c; });
  });
  return polygons;
}

Cells<2> random_cells(int count) {
  Random random(3);
  Seeds<2> seeds;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform();
    seeds.position.push_back({{x, 2.0 * random.uniform()}});
    seeds.radius.push_back(1.0);
  }
  return laguerre_cells(seeds, Region::rectangle(1.0, 2.0)).cells;
}

TEST(BlockOrder, GoesFromSquareToSquareAcrossAnEdge) {
  Cells<2> t = squares(16);
  number_along_curve(t, {{}, {{16.0, 16.0}}});
  std::vector<int> steps(t.cells.size(), 0);  // joined to the next one by an edge
  for (const Facet<2>& e : facets(t)) {
    if (e.outer >= 0 && std::abs(e.outer - e.inner) == 1) ++steps[static_cast<std::size_t>(e.inner)];
  }
  EXPECT_EQ(std::count(steps.begin(), steps.end(), 1), 255);
}

TEST(BlockOrder, ChangesNumbersAndNothingElse) {
  const Cells<2> before = random_cells(500);
  Cells<2> after = before;
  number_along_curve(after, {{}, {{1.0, 2.0}}});
  EXPECT_NE(after.cells, before.cells);
  EXPECT_EQ(sorted_polygons(after), sorted_polygons(before));
  EXPECT_TRUE(mismatched_cells(after, Region::rectangle(1.0, 2.0)).empty());
}

TEST(BlockOrder, DoesNotDependOnTheOrderBefore) {
  Cells<2> t = random_cells(500);
  Cells<2> other = t;
  std::reverse(other.cells.begin(), other.cells.end());
  number_along_curve(t, {{}, {{1.0, 2.0}}});
  number_along_curve(other, {{}, {{1.0, 2.0}}});
  EXPECT_EQ(other.cells, t.cells);
  EXPECT_EQ(other.vertices, t.vertices);
}

}  // namespace
}  // namespace pyroclast::specimen
