#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {
namespace {

void measure_edges(const Cells<2>& cells, Metrics<2>& metrics) {
  const std::vector<Facet<2>> all = facets(cells);
  metrics.shortest_edge = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Facet<2>& edge : all) {
    const Vec<2>& a = cells.vertices[static_cast<std::size_t>(edge.corners[0])];
    const Vec<2>& b = cells.vertices[static_cast<std::size_t>(edge.corners[1])];
    const double length = norm(b - a);
    sum += length;
    if (length < metrics.shortest_edge) {
      metrics.shortest_edge = length;
      metrics.shortest_edge_cell = edge.inner;
      metrics.shortest_edge_at = 0.5 * (a + b);
    }
  }
  metrics.mean_edge = sum / static_cast<double>(all.size());
}

/// Returns the least height of a tetrahedron over one of its faces, m.
double least_height(const std::array<Vec<3>, 4>& x) {
  const Vec<3> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const double widest =
      std::max({norm(cross(a, b)), norm(cross(b, c)), norm(cross(c, a)), norm(cross(b - a, c - a))});
  return std::abs(dot(a, cross(b, c))) / widest;
}

}  // namespace

Metrics<2> measure(const Cells<2>& cells, const Metrics<2>& done) {
  Metrics<2> metrics = done;
  measure_edges(cells, metrics);
  metrics.smallest_angle = 180.0;
  double total_area = 0.0;
  std::size_t zones = 0;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    total_area += extent(cells, c);
    const ZonedCell<2> zoned = zone_cell(cells, c);
    zones += zoned.zones.size();
    for (const auto& [p, q, r] : zoned.zones) {
      const auto& x = zoned.gridpoints;
      const double angle = smallest_angle({x[p], x[q], x[r]}) * 180.0 / std::numbers::pi;
      if (angle >= metrics.smallest_angle) continue;
      metrics.smallest_angle = angle;
      metrics.smallest_angle_cell = static_cast<int>(c);
    }
  }
  metrics.zones_per_block = static_cast<double>(zones) / static_cast<double>(cells.cells.size());
  metrics.mean_size = std::sqrt(total_area / static_cast<double>(cells.cells.size()));
  return metrics;
}

Metrics<3> measure(const Cells<3>& cells, const Prism& body, const Metrics<3>& done) {
  Metrics<3> metrics = done;
  metrics.shortest_edge = std::numeric_limits<double>::infinity();
  std::size_t zones = 0;
  for (const Facet<3>& face : cells.faces) {
    const auto corners = static_cast<int>(face.corners.size());
    zones += static_cast<std::size_t>(corners - 2) * (face.outer >= 0 ? 2 : 1);
    if (face.outer >= 0) {
      metrics.most_corners = std::max(metrics.most_corners, corners);
      metrics.largest_bend =
          std::max(metrics.largest_bend, bend(cells.vertices, face.corners) * 180.0 / std::numbers::pi);
    }
    for (int i = 0; i < corners; ++i)
      metrics.shortest_edge =
          std::min(metrics.shortest_edge,
                   norm(cells.vertices[face.corners[(i + 1) % corners]] - cells.vertices[face.corners[i]]));
  }
  metrics.lowest_zone = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell) {
    const ZonedCell<3> zoned = zone_cell(cells, cell);
    for (const auto& [a, b, c, d] : zoned.zones) {
      const auto& x = zoned.gridpoints;
      const double height = least_height({x[a], x[b], x[c], x[d]});
      if (height >= metrics.lowest_zone) continue;
      metrics.lowest_zone = height;
      metrics.lowest_zone_cell = static_cast<int>(cell);
    }
  }
  metrics.zones_per_block = static_cast<double>(zones) / static_cast<double>(cells.cells.size());
  metrics.mean_size = std::cbrt(body.extent() / static_cast<double>(cells.cells.size()));
  return metrics;
}

}  // namespace pyroclast::specimen
