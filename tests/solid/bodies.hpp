#pragma once

#include "pyroclast/solid/prism.hpp"

/// Bodies that the tests of solids share.
namespace pyroclast::solid {

inline Prism cuboid(double width, double height, double depth) {
  return {specimen::Region::rectangle(width, height), Prism::Axis::z, depth};
}

/// A cylinder along y: a prism on a polygon of the circle's area.
inline Prism cylinder(double diameter, double height) {
  const double radius = 0.5 * diameter;
  const auto corners = specimen::circle_corners({{radius, radius}}, diameter, diameter / 10.0);
  return {specimen::Region::polygon(corners, {"rim"}, true), Prism::Axis::y, height};
}

}  // namespace pyroclast::solid
