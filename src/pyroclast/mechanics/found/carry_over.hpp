#pragma once

#include <array>

#include "pyroclast/mechanics/found/rows.hpp"
#include "pyroclast/mechanics/found/triangle_pair.hpp"

namespace pyroclast {

/// Pair of triangles that overlap, in a step.
struct TouchedPair {
  TriangleCorners corners{};  ///< corners of a, then of b, m
  Overlap overlap;
  TrianglePair<double> pair;
  PointAreas<double> areas;
  std::array<Vec<3>, 2> tangents{};  ///< unit vectors in the mean plane, the first along the first edge of a
  // The points.
  std::array<double, Overlap::kMost> gap{};    ///< gap from which depths and openings are taken, m
  std::array<Vec<2>, Overlap::kMost> slide{};  ///< way along the tangents since the last step that pressed, m
  std::array<bool, Overlap::kMost> counts{};   ///< true for points that may press
  bool is_carried_over = false;  ///< true where the points are no longer those of the row's overlap

  /// Lets a point count with an area, m²; with none its area does not change the energy either.
  void keep_area(int point, double area) {
    areas.area[point] = area;
    if (!(area > 0.0)) areas.points[point] = {};
  }
  /// Returns the velocity at which the gap of a point opens, m/s, for the velocities of the corners.
  double opening_velocity(int point, const TriangleCorners& velocity) const;
};

/// Returns unit vectors in the mean plane of a pair. The first one turns with the first edge of a.
std::array<Vec<3>, 2> tangents_of(const TrianglePair<double>& pair);

/// Takes a pair of a row to its overlap at present. Where the overlap has other corners than in the last step
/// that pressed, its points go on from what the nearest of those remember, and the row books the energy of
/// the shear that this takes. Returns false where the triangles do not face each other or do not overlap.
bool touch_pair(const FoundRows<3>& found, FoundRow<3>& row, int lane, const TriangleCorners& corners,
                TouchedPair& pair);

}  // namespace pyroclast
