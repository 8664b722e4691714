#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Gridpoints that share one temperature.
struct ThermalNodes {
  std::vector<int> of_gridpoint;  ///< node of each gridpoint; -1 where the block conducts no heat
  std::vector<int> gridpoint;     ///< of each node the first of its gridpoints

  int count() const { return static_cast<int>(gridpoint.size()); }
};

/// Nodes for heat that crosses contacts without resistance (paper, 2.1): gridpoints that contacts join are
/// one. A contact with a resistance would leave its gridpoints apart and pass heat between their nodes
/// instead.
///
/// \param conducts  whether a material takes part, by material of the model
///
/// Throws Error when a contact joins gridpoints that do not coincide, or a gridpoint belongs to no zone.
template <int Dim>
ThermalNodes join_through_contacts(const Model<Dim>& model, const std::vector<bool>& conducts);

/// Face on the outline of the conducting body: neither shared by two zones nor joined by contacts to another
/// conducting block.
template <int Dim>
struct OutlineFace {
  std::array<int, Dim> gridpoints;  ///< in the order that makes the normal right-handed
  int zone;
  Vec<Dim> centre;  ///< m
  Vec<Dim> normal;  ///< unit, outward
  double area;      ///< m² (2D: length times thickness)
};

/// All such faces, in the order of their zones.
template <int Dim>
std::vector<OutlineFace<Dim>> outline(const Model<Dim>& model, const ZoneGeometry<Dim>& geometry,
                                      const std::vector<bool>& conducts);

/// Choice of outline faces whose centres lie in a plane (2D: on a line) perpendicular to an axis.
/// \param axis        0, 1 or 2 for x, y, z
/// \param coordinate  of the plane, m
/// \param tolerance   m
template <int Dim>
auto on_plane(int axis, double coordinate, double tolerance) {
  return [=](const OutlineFace<Dim>& face) { return std::abs(face.centre[axis] - coordinate) <= tolerance; };
}

/// Choice of outline faces whose centres lie in a box, bounds included.
template <int Dim>
auto in_box(const Vec<Dim>& low, const Vec<Dim>& high) {
  return [=](const OutlineFace<Dim>& face) {
    for (int i = 0; i < Dim; ++i)
      if (!(low[i] <= face.centre[i] && face.centre[i] <= high[i])) return false;
    return true;
  };
}

}  // namespace pyroclast
