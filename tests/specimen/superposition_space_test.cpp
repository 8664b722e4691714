#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/superposition.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

Cells<3> cells_of(const Prism& body, int count) {
  Random random(3);
  return laguerre_cells(spaced_seeds(body, count, 0.3, random), body).cells;
}

double in_all_cells(const Cells<3>& cells, const Vec<3>& centre, double radius) {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell)
    sum += common_volume(cells, cell, centre, radius);
  return sum;
}

// Promise: cells share a ball out among them, whatever its size and wherever its centre, on a face too.
TEST(CommonVolume, CellsShareABallOut) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const Cells<3> cells = cells_of(body, 200);
  for (const double radius : {0.001, 0.01, 0.045})
    for (const Vec<3>& centre : {Vec<3>{{0.05, 0.05, 0.05}}, {{0.046, 0.051, 0.0473}}}) {
      const double ball = extent_of_round<3>(2.0 * radius);
      EXPECT_NEAR(in_all_cells(cells, centre, radius), ball, 1e-9 * ball) << radius;
    }
  Vec<3> on_face{};
  for (const Facet<3>& face : cells.faces)
    if (face.outer >= 0) {
      for (const int v : face.corners) on_face += cells.vertices[v] * (1.0 / face.corners.size());
      break;
    }
  const double ball = extent_of_round<3>(0.004);
  EXPECT_NEAR(in_all_cells(cells, on_face, 0.002), body.distance(on_face) < -0.002 ? ball : 0.0, 1e-8 * ball);
}

TEST(CommonVolume, OfABallThatASideCutsIsThatOfItsCap) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const Cells<3> cells = cells_of(body, 50);
  const double radius = 0.02, depth = 0.03;  // of the part within the body
  const double cap = std::numbers::pi * depth * depth * (radius - depth / 3.0);
  EXPECT_NEAR(in_all_cells(cells, {{depth - radius, 0.05, 0.05}}, radius), cap, 1e-9 * cap);
}

TEST(CommonVolume, OfABallAroundTheWholeBodyIsTheBody) {
  const Prism body = cylinder(0.1, 0.1);
  const Cells<3> cells = cells_of(body, 50);
  EXPECT_NEAR(in_all_cells(cells, {{0.05, 0.05, 0.05}}, 1.0), body.extent(), 1e-9 * body.extent());
}

// Promise: a ball that touches no part of a cell has nothing in common with it, and a corner of a cube cuts
// an eighth out of a ball around it.
TEST(CommonVolume, OfABallAroundACornerIsAnEighth) {
  const Prism body = cuboid(1.0, 1.0, 1.0);
  const Cells<3> cube = laguerre_cells({{{{0.5, 0.5, 0.5}}}, {0.5}}, body).cells;
  for (const double radius : {0.3, 0.9}) {
    const double eighth = extent_of_round<3>(2.0 * radius) / 8.0;
    EXPECT_NEAR(common_volume(cube, 0, {{1.0, 1.0, 1.0}}, radius), eighth, 1e-9 * eighth);
  }
  EXPECT_EQ(common_volume(cube, 0, {{1.6, 0.5, 0.5}}, 0.5), 0.0);
  EXPECT_EQ(common_volume(cube, 0, {{1.4, 1.4, 0.5}}, 0.5), 0.0);
  EXPECT_GT(common_volume(cube, 0, {{1.4, 0.5, 0.5}}, 0.5), 0.0);
}

/// Eight cubes of 1 m, cell 4 x + 2 y + z from 0 on.
struct Cubes {
  Prism body = cuboid(2.0, 2.0, 2.0);
  Cells<3> cells = made();

  Cells<3> made() const {
    Seeds<3> seeds;
    for (int i = 0; i < 8; ++i) {
      seeds.position.push_back({{0.5 + i / 4, 0.5 + i / 2 % 2, 0.5 + i % 2}});
      seeds.radius.push_back(0.5);
    }
    return laguerre_cells(seeds, body).cells;
  }
  Superposed superposed(const std::vector<Stone<3>>& balls, Superposition rule,
                        double covered_fraction = 0.5) const {
    SpecimenParameters p;
    p.superposition = rule;
    p.covered_fraction = covered_fraction;
    return superpose<3>(cells, body, balls, p, 1);
  }
};

Stone<3> ball(const Vec<3>& centre, double diameter) {
  return {centre, diameter, 0, 0, nullptr};
}

/// Stones of the eight cells, of which the others have none.
std::vector<int> only(const std::vector<std::pair<int, int>>& cells) {
  std::vector<int> stone(8, -1);
  for (const auto& [cell, of] : cells) stone[static_cast<std::size_t>(cell)] = of;
  return stone;
}

TEST(Superpose, WithoutBallsAllIsMatrix) {
  const auto none = Cubes().superposed({}, Superposition::fit, 0.7);
  EXPECT_EQ(none.stone, only({}));
  EXPECT_EQ(none.covered_fraction, std::nextafter(1.0, 0.0)) << "nothing fits better than no cell";
}

// Promise: by the rule of centroids a cell is of the first ball that holds its centroid.
TEST(Superpose, ByCentroidsACellIsOfTheFirstBallAroundIts) {
  const std::vector<Stone<3>> balls{ball({{0.5, 0.5, 0.9}}, 0.81), ball({{0.5, 0.5, 0.9}}, 1.4),
                                    ball({{1.5, 1.5, 1.1}}, 0.79), ball({{1.5, 1.5, 1.2}}, 0.62)};
  const auto superposed = Cubes().superposed(balls, Superposition::centroid, 0.7);
  EXPECT_EQ(superposed.stone, only({{0, 0}, {1, 1}, {7, 3}}));
  EXPECT_EQ(superposed.covered_fraction, 0.7);
}

// Promise: by the rule of volumes a cell is aggregate where balls cover more of it than the stated fraction,
// all of them together, and is of the one that covers most.
TEST(Superpose, ByVolumesACellIsOfTheBallThatCoversMost) {
  const Cubes cubes;
  const auto by_volume = [&](const std::vector<Stone<3>>& balls, double fraction) {
    return cubes.superposed(balls, Superposition::area, fraction);
  };
  const std::vector<Stone<3>> whole{ball({{0.5, 0.5, 0.5}}, 1.0)};  // pi / 6 = 0.5236
  EXPECT_EQ(by_volume(whole, 0.523).stone, only({{0, 0}}));
  EXPECT_EQ(by_volume(whole, 0.524).stone, only({}));
  EXPECT_EQ(by_volume(whole, 0.524).covered_fraction, 0.524);
  // halves of two balls, and an eighth of a third: 0.0654 + 0.1131 + 0.0335 = 0.212
  const std::vector<Stone<3>> three{ball({{0.5, 0.5, 0.0}}, 0.63), ball({{0.0, 0.5, 0.5}}, 0.756),
                                    ball({{1.0, 1.0, 1.0}}, 0.8)};
  EXPECT_EQ(by_volume(three, 0.211).stone, only({{0, 1}}));
  EXPECT_EQ(by_volume(three, 0.213).stone, only({}));
  // balls that overlap cover no more than all of a cell, which is of the first of balls alike
  const std::vector<Stone<3>> over(3, ball({{0.5, 0.5, 0.5}}, 1.0));
  EXPECT_EQ(by_volume(over, 1.0).stone, only({}));
  EXPECT_EQ(by_volume(over, 0.999).stone, only({{0, 0}}));
}

// Promise: by the rule `each` a ball takes the cell of which it covers most, where that brings the volumes
// nearer to each other: so from half of a cell on.
TEST(Superpose, ByEachABallTakesACellFromHalfOfItsVolumeOn) {
  const Cubes cubes;
  const auto by_each = [&](const std::vector<Stone<3>>& balls) {
    return cubes.superposed(balls, Superposition::each);
  };
  const double half = std::cbrt(0.5 * 6.0 / std::numbers::pi);
  EXPECT_EQ(by_each({ball({{0.5, 0.5, 0.5}}, 1.01 * half)}).stone, only({{0, 0}}));
  EXPECT_EQ(by_each({ball({{0.5, 0.5, 0.5}}, 0.99 * half)}).stone, only({}));
  EXPECT_EQ(by_each({ball({{1.1, 0.5, 0.5}}, 1.01 * half)}).stone, only({{4, 0}}));
  const double covered = by_each({ball({{0.5, 0.5, 0.5}}, 1.01 * half)}).covered_fraction;
  EXPECT_LT(covered, 1.0);
  EXPECT_GT(covered, 1.0 - 1e-15);
}

// Promise: larger balls choose first, whatever their order; who finds its cell taken takes the next, or none.
TEST(Superpose, ByEachLargerBallsChooseFirst) {
  const Cubes cubes;
  const auto by_each = [&](const std::vector<Stone<3>>& balls) {
    return cubes.superposed(balls, Superposition::each).stone;
  };
  const Stone<3> small = ball({{0.8, 0.5, 0.5}}, 1.1), large = ball({{0.5, 0.5, 0.5}}, 1.2);
  EXPECT_EQ(by_each({small, large}), only({{0, 1}, {4, 0}}));
  EXPECT_EQ(by_each({large, small}), only({{0, 0}, {4, 1}}));
  // the second has no other cell, so that the cell that is covered most of the others follows
  const Stone<3> within = ball({{0.5, 0.5, 0.5}}, 0.9);
  EXPECT_EQ(by_each({ball({{0.6, 0.5, 0.5}}, 1.0), within}), only({{0, 0}}));
  EXPECT_EQ(by_each({ball({{0.6, 0.5, 0.5}}, 1.2), within, within}), only({{0, 0}, {4, 0}}));
}

// Promise: then cells become aggregate, the most covered first, of the ball that covers most of them, as long
// as the volumes come nearer; a share between theirs and those of the others is told.
TEST(Superpose, ByEachTheMostCoveredCellsFollow) {
  const Cubes cubes;
  // an eighth of a ball of 4.19 m³ in each cell: four cells come nearest
  const auto even = cubes.superposed({ball({{1.0, 1.0, 1.0}}, 2.0)}, Superposition::each);
  EXPECT_EQ(std::ranges::count(even.stone, 0), 4);
  EXPECT_NEAR(even.covered_fraction, std::numbers::pi / 6.0, 1e-9);
  // moved towards x: the four cells there have more
  const std::vector<Stone<3>> beside{ball({{1.05, 1.0, 1.0}}, 2.0)};
  const auto moved = cubes.superposed(beside, Superposition::each);
  EXPECT_EQ(moved.stone, only({{4, 0}, {5, 0}, {6, 0}, {7, 0}}));
  EXPECT_EQ(cubes.superposed(beside, Superposition::area, moved.covered_fraction).stone, moved.stone);
  // towards one corner, with 5.58 m³: six cells, but for the one across and the first beside it
  const auto to_corner = cubes.superposed({ball({{1.1, 1.1, 1.1}}, 2.2)}, Superposition::each);
  EXPECT_EQ(std::ranges::count(to_corner.stone, 0), 6);
  EXPECT_EQ(to_corner.stone[0], -1);
  EXPECT_EQ(to_corner.stone[7], 0);
  // with another ball beside, each cell is of the one that covers most of it
  const auto two =
      cubes.superposed({ball({{1.0, 1.0, 1.0}}, 2.0), ball({{0.5, 0.5, 0.5}}, 1.3)}, Superposition::each);
  EXPECT_EQ(two.stone[0], 1);
  EXPECT_EQ(std::ranges::count(two.stone, 0), 4);
}

// Promise: by `fit` alone the most covered cells are aggregate, and a small ball may have none.
TEST(Superpose, ByFitSmallBallsAreLost) {
  const Cubes cubes;
  const std::vector<Stone<3>> balls{ball({{0.6, 0.5, 0.5}}, 1.6), ball({{1.8, 1.8, 1.8}}, 0.4)};  // 2.18 m³
  EXPECT_EQ(cubes.superposed(balls, Superposition::each).stone, only({{0, 0}, {7, 1}}));
  EXPECT_EQ(cubes.superposed(balls, Superposition::fit).stone, only({{0, 0}, {4, 0}}));
}

}  // namespace
}  // namespace pyroclast::specimen
