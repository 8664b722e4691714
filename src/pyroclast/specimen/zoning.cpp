#include <numeric>

#include "pyroclast/base/place_in.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {

ZonedCell<2> zone_block(const std::vector<Vec<2>>& corners) {
  const int n = static_cast<int>(corners.size());
  ZonedCell<2> block{std::vector<int>(corners.size()), corners, {}};
  std::iota(block.vertices.begin(), block.vertices.end(), 0);
  block.gridpoints.push_back(centroid(corners));
  for (int i = 0; i < n; ++i) block.zones.push_back({i, i + 1 < n ? i + 1 : 0, n});
  return block;
}

ZonedCell<2> zone_cell(const Cells<2>& cells, std::size_t cell) {
  std::vector<Vec<2>> polygon;
  corners(cells, cell, polygon);
  ZonedCell<2> zoned = zone_block(polygon);
  zoned.vertices = cells.cells[cell];
  return zoned;
}

ZonedCell<3> zone_cell(const Cells<3>& cells, std::size_t cell) {
  ZonedCell<3> zoned;
  auto& vertices = zoned.vertices;
  const auto gridpoint = [&](int vertex) { return place_in(vertices, vertex); };
  for (const int face : cells.cells[cell])
    for (const int v : cells.faces[face].corners)
      if (gridpoint(v) == static_cast<int>(vertices.size())) vertices.push_back(v);
  std::vector<std::array<int, 3>> triangles;  // gridpoints, counter-clockwise seen from outside
  for_each_triangle(cells, cell, [&](int a, int b, int c) {
    triangles.push_back({gridpoint(a), gridpoint(b), gridpoint(c)});
  });
  auto& x = zoned.gridpoints;
  Vec<3> middle{};
  for (const int v : vertices) {
    x.push_back(cells.vertices[v]);
    middle += cells.vertices[v] * (1.0 / static_cast<double>(vertices.size()));
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

Vec<3> centroid(const Cells<3>& cells, std::size_t cell) {
  return zone_cell(cells, cell).gridpoints.back();
}

}  // namespace pyroclast::specimen
