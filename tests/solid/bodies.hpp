#pragma once

#include "pyroclast/solid/body.hpp"

/// Bodies that the tests of solids share.
namespace pyroclast::solid {

inline Body cuboid(double width, double height, double depth) {
  return {specimen::Region::rectangle(width, height), Body::Axis::z, depth};
}

/// A cylinder along y: a prism on a polygon of the circle's area.
inline Body cylinder(double diameter, double height) {
  const double radius = 0.5 * diameter;
  const auto corners = specimen::circle_corners({{radius, radius}}, diameter, diameter / 10.0);
  return {specimen::Region::polygon(corners, {"rim"}, true), Body::Axis::y, height};
}

}  // namespace pyroclast::solid
