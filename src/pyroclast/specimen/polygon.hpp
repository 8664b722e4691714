#pragma once

#include <array>
#include <span>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast::specimen {

/// Corners of a simple polygon, counter-clockwise, m.
using Corners = std::span<const Vec<2>>;

/// Returns the signed area, m^2: positive when the corners run counter-clockwise.
double area(Corners polygon);

/// Returns the centroid of the area, m. The area must not be zero.
Vec<2> centroid(Corners polygon);

/// Returns the interior angle at corner i, radians in (0, 2 pi).
double interior_angle(Corners polygon, std::size_t i);

/// Returns the largest interior angle, radians in (0, 2 pi); below pi when the polygon is strictly convex.
double largest_angle(Corners polygon);

/// Returns the smallest altitude of the triangles that join each edge to the centroid, m: the thickness of
/// the thinnest zone, to which the time step of an explicit scheme is proportional. Not positive when a
/// triangle is inverted or empty.
double thinnest_zone(Corners polygon);

/// Returns the smallest angle of a triangle, radians.
double smallest_angle(const std::array<Vec<2>, 3>& triangle);

/// Tells whether the segments from a to b and from c to d run through each other.
bool cross_each_other(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d);

/// Returns the area that a convex or non-convex polygon has in common with a circle, m^2. Exact up to
/// rounding.
double common_area(Corners polygon, const Vec<2>& centre, double radius);

/// Returns the area that a convex polygon has in common with another one, m^2. Exact up to rounding.
double common_area(Corners convex, std::vector<Vec<2>> other);

}  // namespace pyroclast::specimen
