#include "pyroclast/solid/superposition.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "pyroclast/solid/laguerre.hpp"
#include "pyroclast/specimen/grain.hpp"

namespace pyroclast::solid {
namespace {

Complex cells_of(const Prism& body, int count) {
  Random random(3);
  return laguerre_complex(spaced_seeds(body, count, 0.3, random), body).complex;
}

double in_all_cells(const Complex& complex, const Vec<3>& centre, double radius) {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell)
    sum += common_volume(complex, cell, centre, radius);
  return sum;
}

// Promise: cells share a ball out among them, whatever its size and wherever its centre, on a face too.
TEST(CommonVolume, CellsShareABallOut) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const Complex complex = cells_of(body, 200);
  for (const double radius : {0.001, 0.01, 0.045})
    for (const Vec<3>& centre : {Vec<3>{{0.05, 0.05, 0.05}}, {{0.046, 0.051, 0.0473}}}) {
      const double ball = specimen::extent_of_round<3>(2.0 * radius);
      EXPECT_NEAR(in_all_cells(complex, centre, radius), ball, 1e-9 * ball) << radius;
    }
  Vec<3> on_face{};
  for (const CellFace& face : complex.faces)
    if (face.outer >= 0) {
      for (const int v : face.corners) on_face += complex.vertices[v] * (1.0 / face.corners.size());
      break;
    }
  const double ball = specimen::extent_of_round<3>(0.004);
  EXPECT_NEAR(in_all_cells(complex, on_face, 0.002), body.distance(on_face) < -0.002 ? ball : 0.0,
              1e-8 * ball);
}

TEST(CommonVolume, OfABallThatASideCutsIsThatOfItsCap) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const Complex complex = cells_of(body, 50);
  const double radius = 0.02, depth = 0.03;  // of the part within the body
  const double cap = std::numbers::pi * depth * depth * (radius - depth / 3.0);
  EXPECT_NEAR(in_all_cells(complex, {{depth - radius, 0.05, 0.05}}, radius), cap, 1e-9 * cap);
}

TEST(CommonVolume, OfABallAroundTheWholeBodyIsTheBody) {
  const Prism body = cylinder(0.1, 0.1);
  const Complex complex = cells_of(body, 50);
  EXPECT_NEAR(in_all_cells(complex, {{0.05, 0.05, 0.05}}, 1.0), body.volume(), 1e-9 * body.volume());
}

}  // namespace
}  // namespace pyroclast::solid
