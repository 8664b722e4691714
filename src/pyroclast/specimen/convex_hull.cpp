#include "pyroclast/specimen/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace pyroclast::specimen {

namespace {

/// Distance over the size of a hull from which on points are apart, and out of a plane or a line.
constexpr double kRoundingOfHull = 1e-9;
/// Fewest rows into which a face of an icosahedron is cut.
constexpr double kFewestRows = 2.0;

/// Returns those points of a plane that are corners of their hull, in its sense around a normal. A point has
/// a next one where none lies to the right of the line from one to the other, nor on it but between them.
std::vector<int> corners_around(const std::vector<Vec<3>>& at, const std::vector<int>& points,
                                const Vec<3>& normal, double apart) {
  const auto follows = [&](int from, int to) {
    const Vec<3> along = at[to] - at[from];
    const double length = norm(along);
    return std::ranges::all_of(points, [&](int k) {
      if (k == from || k == to) return true;
      const Vec<3> other = at[k] - at[from];
      const double left = dot(normal, cross(along, other)) / length, on = dot(along, other);
      return left > apart || (left >= -apart && 0.0 < on && on < length * length);
    });
  };
  std::map<int, int> next;
  for (const int from : points)
    for (const int to : points)
      if (from != to && !next.contains(from) && follows(from, to)) next[from] = to;
  std::vector<int> corners;
  if (next.empty()) return corners;
  int here = next.begin()->first;
  do {
    corners.push_back(here);
    here = next.contains(here) ? next[here] : corners.front();
  } while (here != corners.front() && corners.size() < points.size());
  return corners;
}

}  // namespace

std::vector<std::vector<int>> convex_hull(const std::vector<Vec<3>>& points) {
  double size = 0.0;
  for (const Vec<3>& p : points) size = std::max(size, norm(p - points.front()));
  const double apart = kRoundingOfHull * size;
  std::vector<int> once;
  for (int i = 0; i < std::ssize(points); ++i)
    if (std::ranges::none_of(once, [&](int other) { return norm(points[other] - points[i]) <= apart; }))
      once.push_back(i);
  std::vector<std::vector<int>> faces;
  std::set<std::vector<int>> known;
  for (std::size_t i = 0; i < once.size(); ++i)
    for (std::size_t j = i + 1; j < once.size(); ++j)
      for (std::size_t k = j + 1; k < once.size(); ++k) {
        const int a = once[i], b = once[j], c = once[k];
        Vec<3> normal = cross(points[b] - points[a], points[c] - points[a]);
        if (!(norm(normal) > apart * size)) continue;
        normal *= 1.0 / norm(normal);
        std::vector<int> in_plane{a, b, c};
        bool above = false, below = false;
        for (const int other : once) {
          if (other == a || other == b || other == c) continue;
          const double height = dot(normal, points[other] - points[a]);
          if (std::abs(height) <= apart)
            in_plane.push_back(other);
          else
            (height > 0.0 ? above : below) = true;
          if (above && below) break;
        }
        if (above == below) continue;
        std::ranges::sort(in_plane);
        if (known.insert(in_plane).second)
          faces.push_back(corners_around(points, in_plane, above ? -normal : normal, apart));
      }
  return faces;
}

ConvexPolyhedron icosahedron() {
  // the poles and two rows of five corners
  ConvexPolyhedron solid;
  solid.corners.push_back({{0.0, 0.0, 1.0}});
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 5; ++i) {
      const double angle = 0.4 * std::numbers::pi * (i + 0.5 * row),
                   z = row == 0 ? std::sqrt(0.2) : -std::sqrt(0.2);
      solid.corners.push_back({{std::sqrt(0.8) * std::cos(angle), std::sqrt(0.8) * std::sin(angle), z}});
    }
  solid.corners.push_back({{0.0, 0.0, -1.0}});
  solid.faces = convex_hull(solid.corners);
  return solid;
}

ConvexPolyhedron ball_of_facets(const Vec<3>& centre, double diameter, double edge) {
  const ConvexPolyhedron coarse = icosahedron();
  // 20 rows^2 triangles as large as equilateral ones
  const double surface = std::numbers::pi * diameter * diameter;
  const double of_one_row = std::sqrt(surface / (5.0 * std::numbers::sqrt3));
  const int rows = static_cast<int>(std::lround(std::max(kFewestRows, of_one_row / edge)));
  ConvexPolyhedron ball;
  std::map<std::array<std::pair<int, int>, 3>, int> known;  // by parts of the icosahedron's corners
  double volume = 0.0;
  for (const auto& face : coarse.faces) {
    const auto corner = [&](int i, int j) {
      std::array<std::pair<int, int>, 3> parts{{{rows - i - j, face[0]}, {i, face[1]}, {j, face[2]}}};
      for (auto& [part, of] : parts) of = part == 0 ? 0 : of;
      std::ranges::sort(parts);
      const auto [at, is_new] = known.emplace(parts, static_cast<int>(ball.corners.size()));
      if (is_new) {
        Vec<3> place{};
        for (const auto& [part, of] : parts) place += static_cast<double>(part) * coarse.corners[of];
        ball.corners.push_back(place * (1.0 / norm(place)));
      }
      return at->second;
    };
    const auto add = [&](int a, int b, int c) {
      ball.faces.push_back({a, b, c});
      volume += dot(ball.corners[a], cross(ball.corners[b], ball.corners[c])) / 6.0;
    };
    for (int i = 0; i < rows; ++i)
      for (int j = 0; i + j < rows; ++j) {
        add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
        if (i + j + 1 < rows) add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
      }
  }
  const double radius = 0.5 * diameter * std::cbrt(4.0 / 3.0 * std::numbers::pi / volume);
  for (Vec<3>& corner : ball.corners) corner = centre + radius * corner;
  return ball;
}

}  // namespace pyroclast::specimen
