// Promise: shells in space have the volume, surface and distances of their shapes, points that are spread
// over them, and a width of 1 as drawn; blocks of a solid that follow stones have their volume and surface.
#include "pyroclast/specimen/shell.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "own_folder.hpp"
#include "pyroclast/specimen/blocks.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stone_fit.hpp"
#include "pyroclast/specimen/stones_file.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kPi = std::numbers::pi;

/// A cube of edge 2 around a place.
Shell cube_shell(const Vec<3>& at = {}) {
  std::vector<Vec<3>> vertices;
  for (int i = 0; i < 8; ++i)
    vertices.push_back(at + Vec<3>{{(i & 1) ? 1.0 : -1.0, (i & 2) ? 1.0 : -1.0, (i & 4) ? 1.0 : -1.0}});
  return {std::move(vertices),
          {{0, 2, 1},
           {1, 2, 3},
           {4, 5, 6},
           {5, 7, 6},
           {0, 1, 4},
           {1, 5, 4},
           {2, 6, 3},
           {3, 6, 7},
           {0, 4, 2},
           {2, 4, 6},
           {1, 3, 5},
           {3, 7, 5}}};
}

ShapeParameters shape_of(StoneShape kind, double elongation = 1.5, double flatness = 1.2) {
  ShapeParameters p;
  p.kind = kind;
  p.elongation = {elongation, elongation};
  p.flatness = {flatness, flatness};
  p.corners = {8.0, 16.0};
  p.roughness = {0.05, 0.05};
  return p;
}

const std::vector<StoneShape> kShapes{StoneShape::ellipse, StoneShape::polygon, StoneShape::harmonics};

TEST(Shell, ACubeHasItsVolumeSurfaceAndDistances) {
  const Shell cube = cube_shell({{5.0, 1.0, 2.0}});
  EXPECT_NEAR(cube.extent(), 8.0, 1e-12);
  EXPECT_NEAR(cube.size(), 24.0, 1e-12);
  EXPECT_NEAR(cube.inner_radius(), 1.0, 1e-12);
  EXPECT_NEAR(cube.bounding_radius(), std::sqrt(3.0), 1e-12);
  EXPECT_EQ(cube.corner_count(), 6);
  EXPECT_NEAR(cube.nearest({{0.5, 0.1, 0.2}}).distance, -0.5, 1e-12);
  EXPECT_NEAR(cube.nearest({{3.0, 0.1, 0.2}}).distance, 2.0, 1e-12);
  EXPECT_NEAR(cube.nearest({{2.0, 2.0, 2.0}}).distance, std::sqrt(3.0), 1e-12);  // at a corner
  EXPECT_NEAR(cube.nearest({{2.0, 0.0, 2.0}}).point.normal[0], std::sqrt(0.5), 1e-12);
  const auto larger = cube.scaled(3.0);
  EXPECT_NEAR(larger->extent(), 216.0, 1e-10);
  EXPECT_NEAR(larger->nearest({{4.0, 0.0, 0.0}}).distance, 1.0, 1e-12);
  EXPECT_NEAR(cube.width_across({{1.0, 0.0, 0.0}}), 2.0 * std::sqrt(2.0), 1e-9);
}

TEST(Shell, SaysWhatIsNoSurface) {
  const Shell cube = cube_shell();
  auto triangles = cube.triangles();
  triangles.pop_back();
  expect_in("not closed", message([&] { Shell(cube.vertices(), triangles); }));
  triangles.push_back(triangles.front());
  expect_in("the same way", message([&] { Shell(cube.vertices(), triangles); }));
  triangles = cube.triangles();
  for (auto& t : triangles) std::swap(t[0], t[1]);
  expect_in("inside out", message([&] { Shell(cube.vertices(), triangles); }));
}

// An ellipsoid of 1,280 triangles is less than 1 % smaller than a true one.
TEST(Shell, DrawnShapesHaveAWidthOfOneAndTheirOwnForm) {
  for (const StoneShape kind : kShapes)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Random random(seed);
      const auto shell = draw_shell(shape_of(kind), random);
      // no stone is wider than 1 across its length, none much thinner than 1 / 1.2
      EXPECT_LT(shell->inner_radius(), 0.5);
      EXPECT_GT(shell->inner_radius(), 0.2);
      EXPECT_GT(shell->bounding_radius(), 0.6);
      EXPECT_LT(shell->bounding_radius(), 1.0);
      EXPECT_EQ(shell->corner_count() > 0, kind == StoneShape::polygon);
      if (kind == StoneShape::ellipse) {
        EXPECT_NEAR(shell->extent(), kPi / 6.0 * 1.5 / 1.2, 0.01 * shell->extent());
        EXPECT_NEAR(shell->bounding_radius(), 0.75, 1e-3);
      }
    }
  Random random(1);
  EXPECT_EQ(draw_shell(shape_of(StoneShape::circle), random), nullptr);
}

TEST(Shell, PointsAreSpreadOverAShapeAndABall) {
  Random random(3);
  std::vector<std::shared_ptr<const Surface<3>>> shapes{std::make_shared<Ball<3>>(1.0)};
  for (const StoneShape kind : {StoneShape::ellipse, StoneShape::harmonics})
    shapes.push_back(draw_shell(shape_of(kind), random)->scaled(2.0));
  for (const auto& shape : shapes) {
    constexpr double kSpacing = 0.3;
    const auto points = shape->points(kSpacing);
    EXPECT_NEAR(static_cast<double>(points.size()), shape->size() / (0.866 * kSpacing * kSpacing), 1.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(shape->nearest(points[i].at).distance, 0.0, 1e-9);
      EXPECT_NEAR(norm(points[i].normal), 1.0, 1e-12);
      EXPECT_GT(dot(points[i].normal, points[i].at), 0.0);
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(norm(points[i].at - points[j].at), 0.45 * kSpacing);
    }
    // taken points count
    const std::vector<Vec<3>> taken{points[0].at, points[1].at};
    EXPECT_EQ(shape->points(kSpacing, taken).size(), points.size() - 2);
  }
}

TEST(Shell, StonesAreAsNearAsTheirVertices) {
  const auto cube = std::make_shared<const Shell>(cube_shell());
  const Stone<3> a{{}, 2.0, 0, 0, cube}, b{{{2.3, 0.2, 0.1}}, 2.0, 0, 0, cube};
  EXPECT_TRUE(are_closer(a, b, 0.31));
  EXPECT_FALSE(are_closer(a, b, 0.29));
  EXPECT_NEAR(approach(a, b).gap, 0.3, 1e-12);
  EXPECT_NEAR(approach(a, b).direction[0], 1.0, 1e-12);
  const Stone<3> ball{{{0.0, 2.5, 0.0}}, 1.0};
  EXPECT_NEAR(approach(a, ball).gap, 1.0, 1e-12);
  EXPECT_NEAR(approach(ball, a).direction[1], -1.0, 1e-12);
}

// Promise: the file of stones keeps their places, phases and surfaces, and a fault in it is told with its
// line.
TEST(StonesFile, KeepsStonesAndTellsFaultsWithTheirLine) {
  Random random(5);
  const std::vector<std::string> phases{"aggregate", "pore"};
  std::vector<Stone<3>> stones;
  for (const StoneShape kind : kShapes) {
    auto shape = draw_shell(shape_of(kind), random)->scaled(0.02);
    stones.push_back({{{0.1 * static_cast<double>(stones.size()), 0.02, 0.03}},
                      0.02,
                      static_cast<int>(stones.size() % 2),
                      0,
                      std::move(shape)});
  }
  stones.push_back({{{0.5, 0.0, 0.0}}, 0.01});  // a ball, of triangles in the file
  const auto file = own_folder() / "stones.obj";
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  const std::string text = stones_obj(stones, phases);
  write(text);
  const auto read = read_stones_obj(file, 1.0, "none");
  ASSERT_EQ(read.size(), stones.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(norm(read[i].centre - stones[i].centre), 0.0, 1e-9);
    EXPECT_EQ(read[i].phase, phases[stones[i].phase]);
    EXPECT_NEAR(read[i].shape->extent() / extent(stones[i]), 1.0, stones[i].shape ? 1e-6 : 0.01);
    EXPECT_EQ(read[i].shape->corner_count(), stones[i].shape ? stones[i].shape->corner_count() : 0);
  }
  EXPECT_NEAR(read_stones_obj(file, 1e-3, "none")[0].diameter, 1e-3 * read[0].diameter, 1e-12);
  const auto says = [&](const std::string& what) {
    write(what);
    return message([&] { read_stones_obj(file, 1.0, "none"); });
  };
  expect_in("no faces", says("v 0 0 0\n"));
  expect_in("stones.obj:2: \"x\" is not a number", says("o a\nv 0 x 0\n"));
  expect_in("stones.obj:3: there is no vertex 2: 1 lines v", says("o a\nv 0 0 0\nf 1 1 2\n"));
  expect_in("stones.obj:1: ", says("o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
}

/// A stone in the middle of a cube whose blocks have a size of 1, from the radius of the ball of its volume.
Specimen<3> followed(StoneShape kind, double radius, std::uint64_t seed) {
  Random of_stone(seed);
  Stone<3> stone{{}, 1.0};
  stone.shape = draw_shell(shape_of(kind), of_stone);
  const double factor = radius / std::cbrt(0.75 * extent(stone) / kPi);
  stone.diameter *= factor;
  if (stone.shape) stone.shape = stone.shape->scaled(factor);
  const double edge = 2.0 * reach(stone) + 3.0;
  stone.centre = {{0.5 * edge, 0.5 * edge, 0.5 * edge}};
  Specimen<3> s{.outline = {Region::rectangle(edge, edge), Prism::Axis::z, edge}, .stones = {stone}};
  BlockParameters p;
  p.count = static_cast<int>(edge * edge * edge);
  p.radius_spread = 0.3;
  p.shortest_edge = 0.35;
  p.largest_bend = kPi / 9.0;
  Random random(seed);
  Blocks<3> blocks = make_blocks(p, s.outline, random, nullptr, s.stones);
  EXPECT_EQ(std::ssize(blocks.cells.cells), p.count);
  s.cells = std::move(blocks.cells);
  s.stone = std::move(blocks.stone);
  return s;
}

TEST(FollowedStones, HaveTheirVolumeAndSurface) {
  for (const StoneShape kind :
       {StoneShape::circle, StoneShape::ellipse, StoneShape::polygon, StoneShape::harmonics}) {
    const Specimen<3> s = followed(kind, 3.0, 1);
    require_valid(s.cells, s.outline, "followed");
    const StoneFit fit = fits_of(s).front();
    EXPECT_NEAR(fit.extent_of_blocks / fit.extent, 1.0, 0.01) << static_cast<int>(kind);
    EXPECT_NEAR(fit.interface / fit.size, 1.0, 0.05) << static_cast<int>(kind);
    EXPECT_LT(fit.deviation, 0.05) << static_cast<int>(kind);
    EXPECT_GT(fit.blocks, 100);
  }
}

TEST(FollowedStones, ASmallOneIsOneBlock) {
  for (const StoneShape kind : {StoneShape::circle, StoneShape::ellipse}) {
    const Specimen<3> s = followed(kind, 0.8, 2);
    const StoneFit fit = fits_of(s).front();
    EXPECT_EQ(fit.blocks, 1);
    EXPECT_NEAR(fit.extent_of_blocks / fit.extent, 1.0, 0.04);
    EXPECT_NEAR(fit.interface / fit.size, 1.0, 0.1);
  }
}

}  // namespace
}  // namespace pyroclast::specimen
