#pragma once

#include <numbers>
#include <vector>

#include "pyroclast/solid/prism.hpp"

/// Bodies that the tests of solids share.
namespace pyroclast::solid {

inline Prism cuboid(double width, double height, double depth) {
  return {specimen::Region::rectangle(width, height), Prism::Axis::z, depth};
}

/// A cylinder along y: a prism on a polygon of the circle's area.
inline Prism cylinder(double diameter, double height, int sides = 31) {
  const double radius = 0.5 * diameter;
  const auto corners =
      specimen::circle_corners({{radius, radius}}, diameter, std::numbers::pi * diameter / sides);
  return {specimen::Region::polygon(corners, {"rim"}, true), Prism::Axis::y, height};
}

/// A box, a cylinder and a triangle drawn out.
inline std::vector<Prism> bodies() {
  const auto triangle =
      specimen::Region::polygon({{{0.0, 0.0}}, {{0.1, 0.0}}, {{0.03, 0.08}}}, {"a", "b", "c"});
  return {cuboid(0.1, 0.2, 0.05), cylinder(0.1, 0.2), Prism(triangle, Prism::Axis::z, 0.06)};
}

}  // namespace pyroclast::solid
