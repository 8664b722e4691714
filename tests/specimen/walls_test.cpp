// Promise: holes and notches of a solid go through its depth, their walls lie where the deck says, and blocks
// fill the rest.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

constexpr double kWidthOfPlate = 0.1, kHeightOfPlate = 0.12, kDepthOfPlate = 0.03, kHoleRadius = 0.015;
constexpr Vec<2> kHoleCentre{{0.055, 0.08}};

/// A plate with a round hole of 24 sides, a square one and a notch from the left.
Prism plate_with_cuts(double notch_width) {
  std::vector<Vec<2>> square;
  for (const auto& [x, y] : {std::array{0.07, 0.02}, {0.09, 0.02}, {0.09, 0.04}, {0.07, 0.04}})
    square.push_back({{x, y}});
  const std::array holes{
      Hole{"bore", circle_corners(kHoleCentre, 2.0 * kHoleRadius, kHoleRadius * std::numbers::pi / 12.0),
           true},
      Hole{"window", square, false}};
  const std::array notches{Notch{"saw", {{0.0, 0.03}}, {{0.03, 0.03}}, notch_width, 0.005}};
  return {Region::rectangle(kWidthOfPlate, kHeightOfPlate).with_holes(holes).with_notches(notches),
          Prism::Axis::z, kDepthOfPlate};
}

SpecimenParameters of_plate(int blocks, double shortest_edge, std::uint64_t seed) {
  SpecimenParameters p;
  p.seed = seed;
  p.aggregates.phase = p.matrix;
  p.blocks.count = blocks;
  p.blocks.radius_spread = 0.3;
  p.blocks.shortest_edge = shortest_edge;
  p.blocks.largest_bend = 20.0 * std::numbers::pi / 180.0;
  return p;
}

/// Area of the facets on each side, m², and the farthest of their corners from the walls, m.
struct OnWalls {
  std::map<std::string, double> area;
  double farthest = 0.0;
};

OnWalls on_walls(const Specimen<3>& s) {
  OnWalls on;
  for (const Facet<3>& face : s.cells.faces) {
    if (face.outer >= 0) continue;
    const std::string& name = s.outline.sides()[face.side].name;
    on.area[name] += norm(area_vector(s.cells, face));
    if (name != "bore" && name != "window" && name != "saw") continue;
    for (const int v : face.corners)
      on.farthest = std::max(on.farthest, s.outline.distance_from_walls(s.cells.vertices[v]));
  }
  return on;
}

TEST(WallsOfSolids, LieWhereHolesAndNotchesAre) {
  const Prism body = plate_with_cuts(0.004);
  const double notch = (0.03 - 0.5 * 0.005) * 0.004;
  EXPECT_NEAR(body.extent(),
              kDepthOfPlate * (kWidthOfPlate * kHeightOfPlate - std::numbers::pi * kHoleRadius * kHoleRadius -
                               0.0004 - notch),
              1e-4 * body.extent());
  for (const double shortest_edge : {0.0, 0.35}) {
    const Specimen<3> s = made_in(of_plate(1500, shortest_edge, 1), body);
    EXPECT_EQ(std::ssize(s.cells.cells), 1500);
    double filled = 0.0;
    for (std::size_t cell = 0; cell < s.cells.cells.size(); ++cell) {
      filled += extent(s.cells, cell);
      EXPECT_TRUE(std::isfinite(flatness(s.cells, cell, 1.0))) << cell;
    }
    EXPECT_NEAR(filled / body.extent(), 1.0, 2e-3) << shortest_edge;
    const OnWalls on = on_walls(s);
    EXPECT_NEAR(on.area.at("bore") / (2.0 * std::numbers::pi * kHoleRadius * kDepthOfPlate), 1.0, 0.03);
    EXPECT_NEAR(on.area.at("window") / (4.0 * 0.02 * kDepthOfPlate), 1.0, 0.01);
    EXPECT_NEAR(on.area.at("saw") / (2.0 * (0.025 + std::hypot(0.005, 0.002)) * kDepthOfPlate), 1.0, 0.05);
    const double section = body.extent() / kDepthOfPlate;
    EXPECT_NEAR(on.area.at("front") / section, 1.0, 0.01);
    EXPECT_NEAR(on.area.at("back") / section, 1.0, 0.01);
    EXPECT_NEAR(on.area.at("left"), (kHeightOfPlate - 0.004) * kDepthOfPlate, 0.02 * on.area.at("left"));
    EXPECT_LT(on.farthest, 0.35 * s.metrics.mean_size);
  }
}

TEST(WallsOfSolids, GoThroughFiles) {
  const Specimen<3> made = made_in(of_plate(500, 0.35, 1), plate_with_cuts(0.004));
  const auto file = cells_from(cells_text(made), "plate.json");
  const Specimen<3> read = specimen_from(std::get<GivenCells<3>>(file));
  const OnWalls before = on_walls(made), after = on_walls(read);
  EXPECT_EQ(read.cells.cells, made.cells.cells);
  EXPECT_DOUBLE_EQ(read.outline.extent(), made.outline.extent());
  ASSERT_EQ(before.area.size(), after.area.size());
  for (const auto& [side, area] : before.area) EXPECT_NEAR(after.area.at(side), area, 1e-9 * area) << side;
}

TEST(WallsOfSolids, PartBlocksAtANotchThatIsMuchNarrowerThanThey) {
  const Prism body = plate_with_cuts(0.0005);
  const Specimen<3> s = made_in(of_plate(800, 0.35, 2), body);
  for (const Facet<3>& face : s.cells.faces) {  // no two blocks touch across the notch
    if (face.outer < 0) continue;
    const double from = centroid(s.cells, face.inner)[1] - 0.03, to = centroid(s.cells, face.outer)[1] - 0.03;
    Vec<3> middle{};
    for (const int v : face.corners) middle += s.cells.vertices[v] * (1.0 / std::ssize(face.corners));
    EXPECT_FALSE(from * to < 0.0 && middle[0] < 0.02) << middle[0] << " " << middle[1];
  }
  EXPECT_NEAR(on_walls(s).area.at("saw") / (2.0 * 0.03 * kDepthOfPlate), 1.0, 0.1);
}

TEST(WallsOfSolids, KeepStonesOutOfHolesAndCutThroughThoseInNotches) {
  SpecimenParameters p = of_plate(1500, 0.35, 3);
  p.aggregates = {.phase = "aggregate",
                  .fraction = 0.3,
                  .d_min = 0.008,
                  .d_max = 0.016,
                  .fuller_exponent = 0.45,
                  .sieves = {0.008, 0.016},
                  .minimum_gap = 0.0005,
                  .attempts = 100000};
  p.superposition = Superposition::each;
  const Specimen<3> s = made_in(p, plate_with_cuts(0.004));
  int sawn = 0;
  for (const Stone<3>& stone : s.stones) {
    const double across = std::hypot(stone.centre[0] - kHoleCentre[0], stone.centre[1] - kHoleCentre[1]);
    EXPECT_GT(across, kHoleRadius + 0.5 * stone.diameter - 2e-4);
    sawn += stone.centre[0] < 0.03 && std::abs(stone.centre[1] - 0.03) < 0.5 * stone.diameter;
  }
  EXPECT_GT(sawn, 0);
  EXPECT_NEAR(s.fraction_superposed, s.fraction_placed, 0.03);
}

TEST(WallsOfSolids, AreRefusedWhereBlocksFollowStonesOrANotchHasNoWidth) {
  SpecimenParameters p = of_plate(800, 0.35, 1);
  p.superposition = Superposition::follow;
  p.aggregates.stones = std::vector<KnownStone<3>>{{{{0.02, 0.1, 0.015}}, 0.012, "aggregate", "here"}};
  EXPECT_THROW(made_in(p, plate_with_cuts(0.004)), Error);
  EXPECT_THROW(plate_with_cuts(0.0), Error);
}

}  // namespace
}  // namespace pyroclast::specimen
