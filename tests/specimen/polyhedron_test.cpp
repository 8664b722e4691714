#include "pyroclast/specimen/polyhedron.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

Cells<3> cells_of(const Prism& body, int count, double spread, std::uint64_t seed, Team* team = nullptr) {
  Random random(seed);
  const auto result = laguerre_cells(spaced_seeds(body, count, spread, random), body, team);
  EXPECT_TRUE(result.broken.empty());
  return result.cells;
}

// Promise: cells fill the body, and each is closed, to round-off.
TEST(Polyhedron, CellsFillTheBodyAndAreClosed) {
  for (const Prism& body : bodies())
    for (const double spread : {0.0, 0.3}) {
      const Cells<3> cells = cells_of(body, 700, spread, 3);
      require_valid(cells, body, "cells");
      double filled = 0.0;
      for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
        filled += extent(cells, cell);
        Vec<3> sum{};
        double area = 0.0;
        for (const int f : cells.cells[cell]) {
          const Facet<3>& face = cells.faces[f];
          const Vec<3> out = area_vector(cells, face) * (face.inner == static_cast<int>(cell) ? 1.0 : -1.0);
          sum += out;
          area += norm(out);
        }
        EXPECT_LT(norm(sum), 1e-12 * area);
      }
      EXPECT_NEAR(filled, body.extent(), 1e-12 * body.extent());
    }
}

// Voro++ crashed on a cylinder of 199,000 blocks, whose outline has 158 sides.
TEST(Polyhedron, OutlineMayHaveAnyNumberOfSides) {
  for (const int sides : {122, 123, 200, 400}) {
    const Prism body = cylinder(0.1, 0.2, sides);
    ASSERT_EQ(body.planes().size(), static_cast<std::size_t>(sides) + 2);
    require_valid(cells_of(body, 4000, 0.3, 3), body, "cells");
  }
}

// Promise: each face is of one cell on the surface, and else of two that walk it in opposite senses: so each
// edge of a cell is walked once each way.
TEST(Polyhedron, FacesWithinTheBodyAreOfTwoCells) {
  const Cells<3> cells = cells_of(cuboid(0.1, 0.1, 0.1), 300, 0.3, 1);
  std::vector<int> cells_at(cells.faces.size());
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell)
    for (const int f : cells.cells[cell]) {
      ++cells_at[f];
      EXPECT_TRUE(cells.faces[f].inner == static_cast<int>(cell) ||
                  cells.faces[f].outer == static_cast<int>(cell));
    }
  for (std::size_t f = 0; f < cells_at.size(); ++f) {
    EXPECT_EQ(cells_at[f], cells.faces[f].outer < 0 ? 1 : 2);
    EXPECT_EQ(cells.faces[f].outer < 0, cells.faces[f].side >= 0);
  }
}

// Promise: the faces on each side of a body make up the side, exactly.
TEST(Polyhedron, FacesOnASideHaveItsArea) {
  const Prism box = cuboid(0.1, 0.2, 0.05), round = cylinder(0.1, 0.2);
  const auto areas = [](const Prism& body) {
    const Cells<3> cells = cells_of(body, 500, 0.3, 2);
    std::vector<double> area(body.sides().size());
    for (const Facet<3>& face : cells.faces)
      if (face.side >= 0) area[face.side] += norm(area_vector(cells, face));
    return area;
  };
  ASSERT_EQ(names_of(box.sides()),
            (std::vector<std::string>{"bottom", "right", "top", "left", "front", "back"}));
  const auto of_box = areas(box);
  const double expected[] = {0.1 * 0.05, 0.2 * 0.05, 0.1 * 0.05, 0.2 * 0.05, 0.1 * 0.2, 0.1 * 0.2};
  for (int side = 0; side < 6; ++side) EXPECT_NEAR(of_box[side], expected[side], 1e-12 * expected[side]);
  ASSERT_EQ(names_of(round.sides()), (std::vector<std::string>{"rim", "bottom", "top"}));
  const double circle = 0.25 * std::numbers::pi * 0.1 * 0.1;
  const auto of_round = areas(round);
  for (const int end : {1, 2}) EXPECT_NEAR(of_round[end], circle, 1e-12 * circle);
  EXPECT_NEAR(round.extent(), circle * 0.2, 1e-12 * circle);
}

TEST(Polyhedron, VerticesOnFlatSidesLieExactlyThere) {
  const Prism box = cuboid(0.1, 0.2, 0.05);
  const Cells<3> cells = cells_of(box, 200, 0.3, 2);
  for (const Facet<3>& face : cells.faces) {
    if (face.side < 0) continue;
    const int axis = std::array{1, 0, 1, 0, 2, 2}[face.side];
    const double at = std::array{0.0, 0.1, 0.2, 0.0, 0.0, 0.05}[face.side];
    for (const int v : face.corners) EXPECT_EQ(cells.vertices[v][axis], at);
  }
}

TEST(Polyhedron, IsTheSameForAnyNumberOfThreads) {
  const Prism body = cylinder(0.1, 0.2);
  const Cells<3> one = cells_of(body, 400, 0.3, 5);
  for (const int threads : {2, 3}) {
    Team team(threads);
    const Cells<3> other = cells_of(body, 400, 0.3, 5, &team);
    EXPECT_TRUE(other.vertices == one.vertices);
    EXPECT_TRUE(other.cells == one.cells);
  }
}

TEST(Polyhedron, ZonesFillTheirCell) {
  const Cells<3> cells = cells_of(cuboid(0.1, 0.1, 0.1), 100, 0.3, 4);
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    const ZonedCell<3> zoned = zone_cell(cells, cell);
    double filled = 0.0;
    for (const auto& zone : zoned.zones) {
      const Vec<3>& x = zoned.gridpoints[zone[0]];
      const double six = dot(cross(zoned.gridpoints[zone[1]] - x, zoned.gridpoints[zone[2]] - x),
                             zoned.gridpoints[zone[3]] - x);
      EXPECT_GT(six, 0.0);
      EXPECT_EQ(zone[3], static_cast<int>(zoned.vertices.size()));
      filled += six / 6.0;
    }
    EXPECT_NEAR(filled, extent(cells, cell), 1e-12 * filled);
  }
}

TEST(Seeds, KeepTheirDistanceAndAreNearTheirNeighboursInNumber) {
  const Prism body = cylinder(0.1, 0.1);
  Random random(1);
  const Seeds<3> seeds = spaced_seeds(body, 1000, 0.3, random);
  const double spacing = std::cbrt(body.extent() / 1000);
  double nearest = 1.0, next = 0.0;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LT(body.distance(seeds.position[i]), 0.0);
    for (int j = 0; j < i; ++j) nearest = std::min(nearest, norm(seeds.position[i] - seeds.position[j]));
    if (i > 0) next += norm(seeds.position[i] - seeds.position[i - 1]) / 999;
  }
  EXPECT_GE(nearest, 0.62 * spacing);
  EXPECT_LT(next, 2.5 * spacing);  // at random it would be some 5
}

TEST(Prism, ASectionThatIsNotConvexIsRefusedWithItsCorner) {
  const auto angle =
      Region::polygon({{{0.0, 0.0}}, {{0.2, 0.0}}, {{0.2, 0.1}}, {{0.1, 0.1}}, {{0.1, 0.2}}, {{0.0, 0.2}}},
                      {"a", "b", "c", "d", "e", "f"});
  expect_in("(0.1, 0.1) m", message([&] { Prism(angle, Prism::Axis::z, 0.1); }));
}

}  // namespace
}  // namespace pyroclast::specimen
