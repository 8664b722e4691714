#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Face on the outline of a body: neither shared by two zones nor joined by contacts to another block of the
/// body.
template <int Dim>
struct OutlineFace {
  std::array<int, Dim> gridpoints;  ///< gridpoints in the order that makes the normal right-handed
  int zone;
  Vec<Dim> centre;  ///< m
  Vec<Dim> normal;  ///< unit normal, outward
  double area;      ///< m² (2D: length times thickness)
};

/// Returns all faces on the outline of a body, in the order of their zones.
/// \param takes_part  true where a block belongs to the body
template <int Dim>
std::vector<OutlineFace<Dim>> outline(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                                      const std::vector<bool>& takes_part);

/// Returns for each face of an outline the face of the earlier outline whose place it takes: the same face,
/// or for a face that blocks bared when they left, the nearest of the faces that left and look the same way,
/// else the nearest of all that left; -1 where none did.
template <int Dim>
std::vector<int> earlier_faces(const std::vector<OutlineFace<Dim>>& earlier,
                               const std::vector<OutlineFace<Dim>>& now);

/// Tells for each block whether its material is one of those that take part, by material of the model.
std::vector<bool> blocks_of(const Model& model, const std::vector<bool>& materials);
/// Tells for each gridpoint whether it belongs to a block that takes part.
template <int Dim>
std::vector<bool> gridpoints_of(const ModelOf<Dim>& model, const std::vector<bool>& takes_part);

/// Returns a choice of outline faces whose centres lie in a plane (2D: on a line) perpendicular to an axis.
/// \param axis        0, 1 or 2 for x, y, z
/// \param coordinate  coordinate of the plane, m
/// \param tolerance   largest distance from the plane, m
template <int Dim>
auto on_plane(int axis, double coordinate, double tolerance) {
  return [=](const OutlineFace<Dim>& face) { return std::abs(face.centre[axis] - coordinate) <= tolerance; };
}

/// Returns a choice of outline faces whose centres lie in a box, bounds included.
template <int Dim>
auto in_box(const Vec<Dim>& low, const Vec<Dim>& high) {
  return [=](const OutlineFace<Dim>& face) {
    for (int i = 0; i < Dim; ++i)
      if (!(low[i] <= face.centre[i] && face.centre[i] <= high[i])) return false;
    return true;
  };
}

}  // namespace pyroclast
