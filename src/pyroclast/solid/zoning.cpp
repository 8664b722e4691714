#include <algorithm>

#include "pyroclast/solid/complex.hpp"

namespace pyroclast::solid {

ZonedCell zone_cell(const Complex& complex, std::size_t cell) {
  ZonedCell zoned;
  std::vector<std::array<int, 3>> triangles;  // gridpoints, counter-clockwise seen from outside
  for (const int f : complex.cells[cell]) {
    const CellFace& face = complex.faces[f];
    std::vector<int> corners;
    for (const int v : face.corners) {
      const auto gridpoint = static_cast<int>(std::ranges::find(zoned.vertices, v) - zoned.vertices.begin());
      if (gridpoint == static_cast<int>(zoned.vertices.size())) zoned.vertices.push_back(v);
      corners.push_back(gridpoint);
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      if (face.inner == static_cast<int>(cell))
        triangles.push_back({corners[0], corners[i], corners[i + 1]});
      else
        triangles.push_back({corners[0], corners[i + 1], corners[i]});
    }
  }
  auto& x = zoned.gridpoints;
  Vec<3> middle{};
  for (const int v : zoned.vertices) {
    x.push_back(complex.vertices[v]);
    middle += complex.vertices[v] * (1.0 / static_cast<double>(zoned.vertices.size()));
  }
  Vec<3> moment{};
  double all = 0.0;
  for (const auto& [a, b, c] : triangles) {
    const double six = dot(x[a] - middle, cross(x[b] - middle, x[c] - middle));
    moment += (x[a] + x[b] + x[c] - 3.0 * middle) * (0.25 * six);
    all += six;
  }
  const int last = static_cast<int>(x.size());
  x.push_back(middle + moment * (1.0 / all));
  for (const auto& [a, b, c] : triangles) zoned.zones.push_back({a, c, b, last});
  return zoned;
}

}  // namespace pyroclast::solid
