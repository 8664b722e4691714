#pragma once

#include <array>
#include <vector>

#include "pyroclast/model/loose_bodies.hpp"

namespace pyroclast {

/// Zones of a loose body.
template <int Dim>
struct LooseZones {
  std::vector<Vec<Dim>> gridpoints;  ///< m
  std::vector<std::array<int, Dim + 1>> zones;
  std::vector<int> outline;  ///< gridpoints on the outline, in the plane counter-clockwise
};

/// Cuts a body into zones. One with four corners in the plane, and one with the faces of a box in space, has
/// a grid of zones; another one has rings or shells around its centroid.
template <int Dim>
LooseZones<Dim> zones_of(const LooseBody& body);
template <>
LooseZones<2> zones_of(const LooseBody& body);
template <>
LooseZones<3> zones_of(const LooseBody& body);

/// Returns the corners of a body in the plane, counter-clockwise.
std::vector<Vec<2>> corners_around(const LooseBody& body);

}  // namespace pyroclast
