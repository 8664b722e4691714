#include "pyroclast/solid/complex.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
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
    filled += its;
  }
  if (!(std::abs(filled - body.volume()) <= kVolumeError * body.volume()))
    throw Error(fmt::format("{}: its cells fill {:.12g} m3, but the body has {:.12g} m3", what, filled,
                            body.volume()));
}

}  // namespace pyroclast::solid
