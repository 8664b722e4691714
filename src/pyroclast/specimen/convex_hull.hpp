#pragma once

#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast::specimen {

/// Convex polyhedron.
struct ConvexPolyhedron {
  std::vector<Vec<3>> corners;          ///< m
  std::vector<std::vector<int>> faces;  ///< corners of each, counter-clockwise seen from outside
};

/// Returns the faces of the convex hull of points, by trying all triples; none where all lie in a plane. A
/// face has all its corners, counter-clockwise seen from outside, and begins with the lowest number. Points
/// that are no corners of the hull, to 1e-9 of its size, and those that stand twice belong to no face.
std::vector<std::vector<int>> convex_hull(const std::vector<Vec<3>>& points);

/// Returns an icosahedron whose corners lie 1 from the origin.
ConvexPolyhedron icosahedron();

/// Returns a polyhedron of triangles that are nearly alike, with the volume of a ball: the faces of an
/// icosahedron, each cut into a number of rows.
/// \param edge  length of an edge, approximately, m; 80 triangles at least
ConvexPolyhedron ball_of_facets(const Vec<3>& centre, double diameter, double edge);

}  // namespace pyroclast::specimen
