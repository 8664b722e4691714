#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr RegularCells kAsked{.shortest_edge = 0.35, .largest_bend = 20.0 * kDegree};

struct RawAndMerged {
  Cells<3> raw, merged;
  RegularisedCells done;
};

RawAndMerged raw_and_merged(const Prism& body, int count, const RegularCells& asked,
                            const BlockSizes& sizes) {
  Random random(3);
  const Laguerre<3> made = laguerre_cells(spaced_seeds(body, sizes, count, 0.3, random), body);
  RawAndMerged cells{made.cells, made.cells, {}};
  cells.done = regularise(cells.merged, body, made.plane, asked, sizes);
  return cells;
}

RawAndMerged raw_and_merged(const Prism& body, int count, const RegularCells& asked = kAsked) {
  return raw_and_merged(body, count, asked, BlockSizes(std::cbrt(body.extent() / count)));
}

double mean_flatness(const Cells<3>& cells, const Prism& body) {
  const auto count = static_cast<double>(cells.cells.size());
  double sum = 0.0;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell)
    sum += flatness(cells, cell, std::cbrt(body.extent() / count));
  return sum / count;
}

// Promise: hardly an edge stays short, the lowest zone becomes much higher, faces bend by no more than asked,
// and what is told is so.
TEST(Regularisation, RemovesShortEdgesAndFlatZones) {
  for (const Prism& body : bodies()) {
    const RawAndMerged cells = raw_and_merged(body, 300);
    const Metrics<3> before = measure(cells.raw, body), after = measure(cells.merged, body);
    EXPECT_EQ(cells.raw.vertices.size() - cells.merged.vertices.size(),
              static_cast<std::size_t>(cells.done.vertices_merged));
    EXPECT_LE(cells.done.edges_left_short, 15);  // of some 2,000
    EXPECT_GT(after.shortest_edge, 20.0 * before.shortest_edge);
    EXPECT_GT(after.lowest_zone, 20.0 * before.lowest_zone);
    EXPECT_LT(after.zones_per_block, 0.75 * before.zones_per_block);
    EXPECT_LE(after.most_corners, before.most_corners);  // a merge never adds a corner to a face
    EXPECT_LT(mean_flatness(cells.merged, body), 1e-3 * mean_flatness(cells.raw, body));
    EXPECT_LE(after.largest_bend, 20.0 + 1e-9);
    EXPECT_GT(after.largest_bend, 15.0);  // the bound is used
  }
}

// Promise: merged cells fill the body, are closed, and keep the area of each of its sides, to round-off.
TEST(Regularisation, KeepsTheBodyAndItsSides) {
  for (const Prism& body : bodies()) {
    const RawAndMerged cells = raw_and_merged(body, 300);
    require_valid(cells.merged, body, "merged cells");
    double filled = 0.0;
    for (std::size_t cell = 0; cell < cells.merged.cells.size(); ++cell) {
      filled += extent(cells.merged, cell);
      Vec<3> sum{};
      double area = 0.0;
      for (const int f : cells.merged.cells[cell]) {
        const Facet<3>& face = cells.merged.faces[f];
        sum += area_vector(cells.merged, face) * (face.inner == static_cast<int>(cell) ? 1.0 : -1.0);
        area += norm(area_vector(cells.merged, face));
      }
      EXPECT_LT(norm(sum), 1e-12 * area);
      const ZonedCell<3> zoned = zone_cell(cells.merged, cell);
      const auto& x = zoned.gridpoints;
      for (const auto& [a, b, c, d] : zoned.zones)
        EXPECT_GT(dot(cross(x[b] - x[a], x[c] - x[a]), x[d] - x[a]), 0.0);
    }
    EXPECT_NEAR(filled, body.extent(), 1e-12 * body.extent());
    std::vector<Vec<3>> before(body.sides().size()), after = before;
    for (const Facet<3>& face : cells.raw.faces)
      if (face.side >= 0) before[face.side] += area_vector(cells.raw, face);
    for (const Facet<3>& face : cells.merged.faces) {
      if (face.side < 0) continue;
      after[face.side] += area_vector(cells.merged, face);
      EXPECT_LT(bend(cells.merged.vertices, face.corners), 1e-6);
      for (const int v : face.corners)
        EXPECT_NEAR(body.distance(cells.merged.vertices[v]), 0.0, 1e-12 * body.high()[1]);
    }
    for (std::size_t side = 0; side < before.size(); ++side)
      EXPECT_LT(norm(after[side] - before[side]), 1e-12 * body.high()[1] * body.high()[1]);
  }
}

// Promise: a stretch of a side, such as the rim under a seat, keeps its ends.
TEST(Regularisation, KeepsStretchesOfSides) {
  const double radius = 0.05;
  const std::vector<double> ends{-0.6 * std::numbers::pi, -0.4 * std::numbers::pi};
  auto corners = circle_corners({{radius, radius}}, 2.0 * radius, 0.01, ends);
  std::vector<std::string> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<2> middle = 0.5 * (corners[i] + corners[(i + 1) % corners.size()]);
    sides.push_back(middle[1] < 0.01 * radius ? "seat" : "rim");
  }
  const Prism body(Region::polygon(corners, sides), Prism::Axis::z, 0.04);
  const RawAndMerged cells = raw_and_merged(body, 250);
  std::vector<double> before(body.sides().size()), after = before;
  for (const Facet<3>& face : cells.raw.faces)
    if (face.side >= 0) before[face.side] += norm(area_vector(cells.raw, face));
  for (const Facet<3>& face : cells.merged.faces)
    if (face.side >= 0) after[face.side] += norm(area_vector(cells.merged, face));
  for (std::size_t side = 0; side < before.size(); ++side)
    EXPECT_NEAR(after[side], before[side], 1e-12 * before[side]) << body.sides()[side].name;
}

// Promise: a smaller bound of the bend is kept too, and leaves more edges short.
TEST(Regularisation, BendsNoFaceByMoreThanAsked) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  int left = -1;
  for (const double degrees : {20.0, 10.0, 5.0, 0.0}) {
    const RawAndMerged cells = raw_and_merged(body, 200, {0.35, degrees * kDegree});
    require_valid(cells.merged, body, "merged cells");
    EXPECT_LE(measure(cells.merged, body).largest_bend, degrees + 1e-5);
    EXPECT_GT(cells.done.edges_left_short, left);
    left = cells.done.edges_left_short;
  }
}

// Promise: vertices on the surface of a stone that are one but for rounding merge, however little faces may
// bend. A body of 30,000 blocks kept such a pair, whose zones took nearly all of its moving mass.
TEST(Regularisation, MergesCoincidingVerticesWhateverTheBend) {
  constexpr int kCount = 200;
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const double size = std::cbrt(body.extent() / kCount), tiny = 1e-7 * size;
  const BlockSizes sizes(size);
  Random random(3);
  Laguerre<3> made = laguerre_cells(spaced_seeds(body, sizes, kCount, 0.3, random), body);
  Cells<3>& cells = made.cells;
  std::vector<int> stone;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell)
    stone.push_back(centroid(cells, cell)[0] < 0.05 ? 0 : -1);
  double shortest = 1.0;
  std::array<int, 2> ends{};
  for (const Facet<3>& face : cells.faces)
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int a = face.corners[i], b = face.corners[(i + 1) % face.corners.size()];
      const bool is_inner = face.outer >= 0 && stone[face.inner] != stone[face.outer] &&
                            body.distance(cells.vertices[a]) < -0.01 &&
                            body.distance(cells.vertices[b]) < -0.01;
      if (const double length = norm(cells.vertices[b] - cells.vertices[a]); is_inner && length < shortest) {
        shortest = length;
        ends = {a, b};
      }
    }
  const auto [a, b] = ends;
  cells.vertices[b] = cells.vertices[a] + (cells.vertices[b] - cells.vertices[a]) * (tiny / shortest);
  EXPECT_NEAR(measure(cells, body).shortest_edge, tiny, 1e-3 * tiny);
  EXPECT_GT(regularise(cells, body, made.plane, {0.35, 0.0}, sizes, stone).vertices_merged, 0);
  EXPECT_GT(measure(cells, body).shortest_edge, 100.0 * tiny);
}

TEST(Regularisation, IsTheSameForAnyNumberOfThreads) {
  SpecimenParameters p;
  p.seed = 2;
  p.blocks.count = 200;
  p.blocks.radius_spread = 0.3;
  p.blocks.shortest_edge = 0.35;
  p.blocks.largest_bend = 0.3;
  p.aggregates.phase = p.matrix;
  const Prism body = cylinder(0.1, 0.2);
  const Specimen<3> alone = made_in(p, body);
  EXPECT_GT(alone.metrics.vertices_merged, 0);
  Team team(3);
  const Specimen<3> shared = made_in(p, body, &team);
  EXPECT_TRUE(shared.cells.vertices == alone.cells.vertices);
  EXPECT_TRUE(shared.cells.cells == alone.cells.cells);
}

/// What regularised cells are, in numbers that hardly any other cells have.
struct Told {
  std::size_t vertices, faces;
  int edges_left_short;
  double flatness;  ///< mean
};

void expect_told(const Prism& body, const RawAndMerged& cells, const Told& told) {
  EXPECT_EQ(cells.merged.vertices.size(), told.vertices);
  EXPECT_EQ(cells.merged.faces.size(), told.faces);
  EXPECT_EQ(cells.done.edges_left_short, told.edges_left_short);
  // the twelfth digit may be another one with another library of mathematics
  EXPECT_NEAR(mean_flatness(cells.merged, body) / told.flatness, 1.0, 1e-9)
      << fmt::format("{:.13g}", mean_flatness(cells.merged, body));
}

// Promise: a deck of years ago makes the blocks that it made: the same seeds give the same cells. Their
// numbers change only where the way of regularisation is meant to.
TEST(Regularisation, MakesTheCellsThatItMade) {
  const Prism box = cuboid(0.1, 0.06, 0.05), round = cylinder(0.1, 0.1, 9);
  expect_told(box, raw_and_merged(box, 60), {196, 321, 1, 5012.72952763});
  expect_told(round, raw_and_merged(round, 60, {0.5, 10.0 * kDegree}), {236, 373, 64, 7156.320683});
  const BlockSizes finer(
      0.02, 0.03,
      {{.pieces = {{{{0, 0, 0}}, {{0, 0.06, 0}}, {{0, 0.06, 0.05}}, {{0, 0, 0.05}}}}, .size = 0.01}});
  expect_told(box, raw_and_merged(box, 60, kAsked, finer), {200, 318, 0, 5257.414058173});
}

// Promise: the bend of a square with a corner lifted is the angle between its triangles and its mean plane.
TEST(Bend, IsTheLargestAngleToTheMeanPlane) {
  const double lift = 0.3;
  const std::vector<Vec<3>> at{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, lift}}, {{0, 1, 0}}};
  // the diagonal from the lifted corner: normals (0, -lift, 1) and (-lift, 0, 1), mean (-lift/2, -lift/2, 1)
  const double cosine = (lift * lift / 2 + 1) / std::sqrt((lift * lift + 1) * (lift * lift / 2 + 1));
  EXPECT_NEAR(bend(at, {0, 1, 2, 3}), std::acos(cosine), 1e-12);
  EXPECT_EQ(bend(at, {0, 1, 2}), 0.0);
  std::vector<int> corners{0, 1, 2, 3};
  EXPECT_FALSE(turn_to_best_fan(at, corners, 0.5 * std::acos(cosine)));
  EXPECT_TRUE(turn_to_best_fan(at, corners, 1.0));
}

// Promise: a cube's zones have r = 3 V / S, each 1/12 of the cube under half of a face.
TEST(Flatness, OfACubeIsThatOfItsZones) {
  const Prism body = cuboid(1.0, 1.0, 1.0);
  const Cells<3> cube = laguerre_cells({{{{0.5, 0.5, 0.5}}}, {0.5}}, body).cells;
  const double surface = 0.5 + 3.0 * std::sqrt(2.0) / 4.0, radius = 3.0 / 12.0 / surface;
  EXPECT_NEAR(flatness(cube, 0, 1.0), std::pow(radius, -4.0), 1e-9);
  EXPECT_NEAR(flatness(cube, 0, 2.0), 2.0 * std::pow(radius, -4.0), 1e-9);
}

}  // namespace
}  // namespace pyroclast::specimen
