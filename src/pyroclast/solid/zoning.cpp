#include "pyroclast/base/place_in.hpp"
#include "pyroclast/solid/complex.hpp"

namespace pyroclast::solid {

ZonedCell zone_cell(const Complex& complex, std::size_t cell) {
  ZonedCell zoned;
  auto& vertices = zoned.vertices;
  const auto gridpoint = [&](int vertex) { return place_in(vertices, vertex); };
  for (const int face : complex.cells[cell])
    for (const int v : complex.faces[face].corners)
      if (gridpoint(v) == static_cast<int>(vertices.size())) vertices.push_back(v);
  std::vector<std::array<int, 3>> triangles;  // gridpoints, counter-clockwise seen from outside
  for_each_triangle(complex, cell, [&](int a, int b, int c) {
    triangles.push_back({gridpoint(a), gridpoint(b), gridpoint(c)});
  });
  auto& x = zoned.gridpoints;
  Vec<3> middle{};
  for (const int v : vertices) {
    x.push_back(complex.vertices[v]);
    middle += complex.vertices[v] * (1.0 / static_cast<double>(vertices.size()));
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
