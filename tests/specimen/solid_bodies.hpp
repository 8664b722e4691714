#pragma once

#include <numbers>
#include <vector>

#include "pyroclast/specimen/prism.hpp"
#include "pyroclast/specimen/spaced_seeds.hpp"
#include "pyroclast/specimen/specimen.hpp"

/// Bodies that the tests of solids share.
namespace pyroclast::specimen {

inline Prism cuboid(double width, double height, double depth) {
  return {Region::rectangle(width, height), Prism::Axis::z, depth};
}

/// A cylinder along y: a prism on a polygon of the circle's area.
inline Prism cylinder(double diameter, double height, int sides = 31) {
  const double radius = 0.5 * diameter;
  const auto corners = circle_corners({{radius, radius}}, diameter, std::numbers::pi * diameter / sides);
  return {Region::polygon(corners, {"rim"}, true), Prism::Axis::y, height};
}

/// A box, a cylinder and a triangle drawn out.
inline std::vector<Prism> bodies() {
  const auto triangle = Region::polygon({{{0.0, 0.0}}, {{0.1, 0.0}}, {{0.03, 0.08}}}, {"a", "b", "c"});
  return {cuboid(0.1, 0.2, 0.05), cylinder(0.1, 0.2), Prism(triangle, Prism::Axis::z, 0.06)};
}

inline Specimen<3> made_in(SpecimenParameters p, const Prism& body, Team* team = nullptr) {
  p.outline = body;
  return make_specimen<3>(p, team);
}

}  // namespace pyroclast::specimen
