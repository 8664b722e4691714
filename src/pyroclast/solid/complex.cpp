#include "pyroclast/solid/complex.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast::solid {

namespace {

/// Largest difference of the cells' volume from that of the body, over it.
constexpr double kVolumeError = 1e-9;

}  // namespace

Vec<3> area_vector(const Complex& complex, const CellFace& face) {
  const auto& at = complex.vertices;
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

bool turn_to_best_fan(const std::vector<Vec<3>>& at, std::vector<int>& corners, double largest_bend) {
  const auto begins_at = [&](std::size_t first) {
    return corners.begin() + static_cast<std::ptrdiff_t>(first);
  };
  std::size_t best = corners.size();
  double highest = -1.0;
  for (std::size_t first = 0; first < corners.size(); ++first) {
    double low = std::numeric_limits<double>::max();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vec<3>&a = at[corners[0]], &b = at[corners[i]], &c = at[corners[i + 1]];
      const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
      low = std::min(low, norm(cross(b - a, c - a)) / longest);
    }
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

double flatness(const Complex& complex, std::size_t cell, double size) {
  const auto& at = complex.vertices;
  const Vec<3>* first = nullptr;
  Vec<3> moment{};
  double all = 0.0;
  for_each_triangle(complex, cell, [&](int a, int b, int c) {
    if (first == nullptr) first = &at[a];
    const Vec<3> x = at[a] - *first, y = at[b] - *first, z = at[c] - *first;
    const double six = dot(x, cross(y, z));
    moment += (x + y + z) * (0.25 * six);
    all += six;
  });
  const Vec<3> centroid = *first + moment * (1.0 / all);
  double sum = 0.0;
  for_each_triangle(complex, cell, [&](int a, int b, int c) {
    const Vec<3> x = at[a] - centroid, y = at[b] - centroid, z = at[c] - centroid;
    const Vec<3> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    const double six = dot(x, yz);  // six times the volume, twice the surface: r is their quotient
    const double surface = norm(yz) + norm(zx) + norm(xy) + norm(yz + zx + xy);
    const double flat = size * surface / six;
    sum += six > 0.0 ? six * (flat * flat) * (flat * flat) : std::numeric_limits<double>::infinity();
  });
  return sum / (6.0 * size * size * size);
}

double volume(const Complex& complex, std::size_t cell) {
  const auto& at = complex.vertices;
  const Vec<3> origin = at[complex.faces[complex.cells[cell].front()].corners.front()];
  double six = 0.0;
  for_each_triangle(complex, cell, [&](int a, int b, int c) {
    six += dot(at[a] - origin, cross(at[b] - origin, at[c] - origin));
  });
  return six / 6.0;
}

void require_valid(const Complex& complex, const Prism& body, const std::string& what) {
  const auto fail = [&](std::size_t cell, const char* why) {
    throw Error(fmt::format("{}: cell {} (from 0) {}", what, cell, why));
  };
  double filled = 0.0;
  for (std::size_t cell = 0; cell < complex.cells.size(); ++cell) {
    std::unordered_set<int> vertices;
    std::unordered_map<std::uint64_t, int> edges;  // how often its faces walk an edge up, less how often down
    for (const int f : complex.cells[cell]) {
      const CellFace& face = complex.faces[f];
      const bool is_inner = face.inner == static_cast<int>(cell);
      std::unordered_set<int> of_face;
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        const int from = face.corners[i], to = face.corners[(i + 1) % face.corners.size()];
        if (!of_face.insert(from).second) fail(cell, "has a face that meets a corner twice");
        vertices.insert(from);
        const auto [low, high] = std::minmax(from, to);
        edges[static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint64_t>(high)] +=
            (from < to) == is_inner ? 1 : -1;
      }
    }
    if (std::ranges::any_of(edges, [](const auto& edge) { return edge.second != 0; }))
      fail(cell, "is not closed");
    if (vertices.size() + complex.cells[cell].size() != edges.size() + 2) fail(cell, "is not simple");
    const double its = volume(complex, cell);
    if (!(its > 0.0)) fail(cell, "has no volume");
    if (!std::isfinite(flatness(complex, cell, 1.0)))
      fail(cell, "turns a triangle of a face away from its centroid, so that it cannot be cut into zones");
    filled += its;
  }
  if (!(std::abs(filled - body.volume()) <= kVolumeError * body.volume()))
    throw Error(fmt::format(
        "{}: its cells fill {:.12g} m3, but the body has {:.12g} m3; both may differ by {:g} of it", what,
        filled, body.volume(), kVolumeError));
}

}  // namespace pyroclast::solid
