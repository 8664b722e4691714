#include "pyroclast/specimen/polyhedron.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {

namespace {

/// Largest difference of the cells' volume from that of the body, over it.
constexpr double kVolumeError = 1e-9;

/// Returns the solid angle of the triangle (a, b, c) seen from the origin, signed by its sense (van Oosterom
/// and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125).
double solid_angle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return 2.0 *
         std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// Returns the volume that the tetrahedron of the origin and a triangle has in common with the ball around
/// the origin, signed by the sense of the triangle. The ball cuts a disc out of the triangle's plane. Over
/// the part of the triangle in that disc stands a pyramid, over the rest a sector of the ball.
double common_volume_of_tetrahedron(const std::array<Vec<3>, 3>& corner, double radius) {
  const Vec<3> doubled = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = norm(doubled);
  if (length == 0.0) return 0.0;
  const Vec<3> normal = doubled * (1.0 / length);
  const double distance = dot(normal, corner[0]);
  const double sector = radius * radius * radius / 3.0;
  const double all = solid_angle(corner[0], corner[1], corner[2]);
  if (std::abs(distance) >= radius) return sector * all;
  const Vec<3> foot = normal * distance;
  const double of_disc = std::sqrt(radius * radius - distance * distance);
  // solid angle of a part of the disc, over its angle at the foot
  const double a_radian = std::copysign(1.0 - std::abs(distance) / radius, distance);
  double area = 0.0, angle = 0.0;  // of the part of the triangle in the disc
  for (int i = 0; i < 3; ++i) {
    const Vec<3> a = corner[i] - foot, ab = corner[(i + 1) % 3] - corner[i];
    const double squared = dot(ab, ab);
    const double middle = -dot(a, ab) / squared;
    const double discriminant = middle * middle - (dot(a, a) - of_disc * of_disc) / squared;
    const double half = discriminant > 0.0 ? std::sqrt(discriminant) : 0.0;
    const double enter = std::clamp(middle - half, 0.0, 1.0), leave = std::clamp(middle + half, 0.0, 1.0);
    const auto turn = [&](double from, double to) {
      const Vec<3> p = a + ab * from, q = a + ab * to;
      return std::atan2(dot(normal, cross(p, q)), dot(p, q));
    };
    const auto add_sector = [&](double from, double to) {
      const double turned = turn(from, to);
      area += 0.5 * of_disc * of_disc * turned;
      angle += a_radian * turned;
    };
    if (discriminant <= 0.0 || enter >= leave) {
      add_sector(0.0, 1.0);
      continue;
    }
    const Vec<3> p = a + ab * enter, q = a + ab * leave;
    area += 0.5 * dot(normal, cross(p, q));
    angle += solid_angle(foot, foot + p, foot + q);
    if (enter > 0.0) add_sector(0.0, enter);
    if (leave < 1.0) add_sector(leave, 1.0);
  }
  return distance * area / 3.0 + sector * (all - angle);
}

}  // namespace

Vec<3> area_vector(const Cells<3>& cells, const Facet<3>& face) {
  const auto& at = cells.vertices;
  Vec<3> doubled{};
  for (std::size_t i = 1; i + 1 < face.corners.size(); ++i)
    doubled +=
        cross(at[face.corners[i]] - at[face.corners[0]], at[face.corners[i + 1]] - at[face.corners[0]]);
  return 0.5 * doubled;
}

double bend(const std::vector<Vec<3>>& at, const std::vector<int>& corners) {
  Vec<3> all{};
  const auto doubled = [&](std::size_t i) {
    return cross(at[corners[i]] - at[corners[0]], at[corners[i + 1]] - at[corners[0]]);
  };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) all += doubled(i);
  double largest = 0.0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    // exact for small angles too, where the cosine is not
    largest = std::max(largest, std::atan2(norm(cross(doubled(i), all)), dot(doubled(i), all)));
  return largest;
}

double lowest_of_fan(const std::vector<Vec<3>>& at, const std::vector<int>& corners) {
  double low = std::numeric_limits<double>::max();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec<3>&a = at[corners[0]], &b = at[corners[i]], &c = at[corners[i + 1]];
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    low = std::min(low, norm(cross(b - a, c - a)) / longest);
  }
  return low;
}

bool turn_to_best_fan(const std::vector<Vec<3>>& at, std::vector<int>& corners, double largest_bend) {
  const auto begins_at = [&](std::size_t first) {
    return corners.begin() + static_cast<std::ptrdiff_t>(first);
  };
  std::size_t best = corners.size();
  double highest = -1.0;
  for (std::size_t first = 0; first < corners.size(); ++first) {
    const double low = lowest_of_fan(at, corners);
    if (low > highest && bend(at, corners) <= largest_bend) {
      highest = low;
      best = first;
    }
    std::rotate(corners.begin(), begins_at(1), corners.end());  // Clang 14 cannot do ranges::rotate
  }
  if (best == corners.size()) return false;
  std::rotate(corners.begin(), begins_at(best), corners.end());
  return true;
}

double flatness(const Cells<3>& cells, std::size_t cell, double size) {
  const auto& at = cells.vertices;
  const Vec<3>* first = nullptr;
  Vec<3> moment{};
  double all = 0.0;
  for_each_triangle(cells, cell, [&](int a, int b, int c) {
    if (first == nullptr) first = &at[a];
    const Vec<3> x = at[a] - *first, y = at[b] - *first, z = at[c] - *first;
    const double six = dot(x, cross(y, z));
    moment += (x + y + z) * (0.25 * six);
    all += six;
  });
  const Vec<3> centroid = *first + moment * (1.0 / all);
  double sum = 0.0;
  for_each_triangle(cells, cell, [&](int a, int b, int c) {
    const Vec<3> x = at[a] - centroid, y = at[b] - centroid, z = at[c] - centroid;
    const Vec<3> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    const double six = dot(x, yz);  // six times the volume, twice the surface: r is their quotient
    const double surface = norm(yz) + norm(zx) + norm(xy) + norm(yz + zx + xy);
    const double flat = size * surface / six;
    sum += six > 0.0 ? six * (flat * flat) * (flat * flat) : std::numeric_limits<double>::infinity();
  });
  return sum / (6.0 * size * size * size);
}

double extent(const Cells<3>& cells, std::size_t cell) {
  const auto& at = cells.vertices;
  const Vec<3> origin = at[cells.faces[cells.cells[cell].front()].corners.front()];
  double six = 0.0;
  for_each_triangle(cells, cell, [&](int a, int b, int c) {
    six += dot(at[a] - origin, cross(at[b] - origin, at[c] - origin));
  });
  return six / 6.0;
}

double common_volume(const Cells<3>& cells, std::size_t cell, const Vec<3>& centre, double radius) {
  // A centre in the very plane of a face would see it from both sides.
  const Vec<3> beside = centre + Vec<3>{{1.1e-10, 0.7e-10, 1.3e-10}} * radius;
  double volume = 0.0;
  const auto& at = cells.vertices;
  for_each_triangle(cells, cell, [&](int a, int b, int c) {
    volume += common_volume_of_tetrahedron({at[a] - beside, at[b] - beside, at[c] - beside}, radius);
  });
  constexpr double kRounding = 1e-12;  // left by a ball that does not touch the cell
  const double ball = extent_of_round<3>(2.0 * radius);
  return volume < kRounding * ball ? 0.0 : volume;
}

const char* fault_of(const Cells<3>& cells, std::size_t cell) {
  std::unordered_set<int> vertices;
  std::unordered_map<std::uint64_t, int> edges;  // how often its faces walk an edge up, less how often down
  for (const int f : cells.cells[cell]) {
    const Facet<3>& face = cells.faces[f];
    const bool is_inner = face.inner == static_cast<int>(cell);
    std::unordered_set<int> of_face;
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int from = face.corners[i], to = face.corners[(i + 1) % face.corners.size()];
      if (!of_face.insert(from).second) return "has a face that meets a corner twice";
      vertices.insert(from);
      const auto [low, high] = std::minmax(from, to);
      edges[static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint64_t>(high)] +=
          (from < to) == is_inner ? 1 : -1;
    }
  }
  if (std::ranges::any_of(edges, [](const auto& edge) { return edge.second != 0; })) return "is not closed";
  if (vertices.size() + cells.cells[cell].size() != edges.size() + 2) return "is not simple";
  if (!(extent(cells, cell) > 0.0)) return "has no volume";
  if (!std::isfinite(flatness(cells, cell, 1.0)))
    return "turns a triangle of a face away from its centroid, so that it cannot be cut into zones";
  return nullptr;
}

void require_valid(const Cells<3>& cells, const Prism& body, const std::string& what) {
  double filled = 0.0;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    if (const char* const fault = fault_of(cells, cell))
      throw Error(fmt::format("{}: cell {} (from 0) {}", what, cell, fault));
    filled += extent(cells, cell);
  }
  const double whole = body.extent_before_cuts();
  if (!(std::abs(filled - whole) <= kVolumeError * whole))
    throw Error(fmt::format(
        "{}: its cells fill {:.12g} m3, but the body has {:.12g} m3; both may differ by {:g} of it", what,
        filled, whole, kVolumeError));
}

}  // namespace pyroclast::specimen
