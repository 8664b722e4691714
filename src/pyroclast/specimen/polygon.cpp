#include "pyroclast/specimen/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pyroclast::specimen {
namespace {

/// Calls f(a, b) for every edge of the polygon.
template <class F>
void for_each_edge(Corners polygon, F&& f) {
  for (std::size_t i = 0; i < polygon.size(); ++i) f(polygon[i], polygon[i + 1 < polygon.size() ? i + 1 : 0]);
}

/// Returns the signed angle from a to b, in (-pi, pi].
double angle_between(const Vec<2>& a, const Vec<2>& b) {
  return std::atan2(cross(a, b), dot(a, b));
}

/// Returns the signed area that the triangle (0, a, b) has in common with the circle of this radius around 0.
double common_area_of_triangle(const Vec<2>& a, const Vec<2>& b, double radius) {
  const Vec<2> ab = b - a;
  const double length_squared = dot(ab, ab);
  const double sector = 0.5 * radius * radius;
  if (length_squared == 0.0) return 0.0;

  // The line a + t (b - a) meets the circle at middle -/+ half.
  const double middle = -dot(a, ab) / length_squared;
  const double discriminant = middle * middle - (dot(a, a) - radius * radius) / length_squared;
  if (discriminant <= 0.0) return sector * angle_between(a, b);
  const double half = std::sqrt(discriminant);
  const double enter = std::clamp(middle - half, 0.0, 1.0);
  const double leave = std::clamp(middle + half, 0.0, 1.0);
  if (enter >= leave) return sector * angle_between(a, b);

  const Vec<2> p = a + enter * ab;
  const Vec<2> q = a + leave * ab;
  double sum = 0.5 * cross(p, q);
  if (enter > 0.0) sum += sector * angle_between(a, p);
  if (leave < 1.0) sum += sector * angle_between(q, b);
  return sum;
}

}  // namespace

double area(Corners polygon) {
  double twice = 0.0;
  for_each_edge(polygon,
                [&](const Vec<2>& a, const Vec<2>& b) { twice += cross(a - polygon[0], b - polygon[0]); });
  return 0.5 * twice;
}

Vec<2> centroid(Corners polygon) {
  const Vec<2> origin = polygon[0];
  double twice = 0.0;
  Vec<2> moment;
  for_each_edge(polygon, [&](const Vec<2>& a, const Vec<2>& b) {
    const double z = cross(a - origin, b - origin);
    twice += z;
    moment += z * (a - origin + b - origin);
  });
  return origin + moment * (1.0 / (3.0 * twice));
}

double interior_angle(Corners polygon, std::size_t i) {
  const std::size_t n = polygon.size();
  return std::numbers::pi -
         angle_between(polygon[i] - polygon[(i + n - 1) % n], polygon[(i + 1) % n] - polygon[i]);
}

double largest_angle(Corners polygon) {
  double largest = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) largest = std::max(largest, interior_angle(polygon, i));
  return largest;
}

double thinnest_zone(Corners polygon) {
  const Vec<2> centre = centroid(polygon);
  double smallest = std::numeric_limits<double>::infinity();
  for_each_edge(polygon, [&](const Vec<2>& a, const Vec<2>& b) {
    const double longest = std::max({norm(b - a), norm(a - centre), norm(b - centre)});
    smallest = std::min(smallest, cross(a - centre, b - centre) / longest);
  });
  return smallest;
}

double smallest_angle(const std::array<Vec<2>, 3>& triangle) {
  double smallest = std::numbers::pi;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec<2>& corner = triangle[i];
    smallest = std::min(
        smallest, std::abs(angle_between(triangle[(i + 1) % 3] - corner, triangle[(i + 2) % 3] - corner)));
  }
  return smallest;
}

double common_area(Corners polygon, const Vec<2>& centre, double radius) {
  double sum = 0.0;
  for_each_edge(polygon, [&](const Vec<2>& a, const Vec<2>& b) {
    sum += common_area_of_triangle(a - centre, b - centre, radius);
  });
  return sum;
}

bool cross_each_other(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const auto side = [](const Vec<2>& p, const Vec<2>& q, const Vec<2>& r) { return cross(q - p, r - p); };
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

double common_area(Corners convex, std::vector<Vec<2>> other) {
  std::vector<Vec<2>> kept;
  for (std::size_t i = 0; i < convex.size() && !other.empty(); ++i) {
    const Vec<2> from = convex[i], along = convex[(i + 1) % convex.size()] - from;
    const auto side = [&](const Vec<2>& p) { return cross(along, p - from); };
    kept.clear();
    for (std::size_t k = 0; k < other.size(); ++k) {
      const Vec<2>&a = other[k], &b = other[(k + 1) % other.size()];
      const double side_a = side(a), side_b = side(b);
      if (side_a >= 0.0) kept.push_back(a);
      if ((side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0))
        kept.push_back(a + (side_a / (side_a - side_b)) * (b - a));
    }
    other.swap(kept);
  }
  return other.size() < 3 ? 0.0 : area(other);
}

}  // namespace pyroclast::specimen
