#include "pyroclast/specimen/metrics.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

void measure_edges(const Tessellation& tessellation, BlockMetrics& metrics) {
  const std::vector<Edge> all = edges(tessellation);
  metrics.shortest_edge = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Edge& edge : all) {
    const Vec<2>& a = tessellation.vertices[static_cast<std::size_t>(edge.v0)];
    const Vec<2>& b = tessellation.vertices[static_cast<std::size_t>(edge.v1)];
    const double length = norm(b - a);
    sum += length;
    if (length < metrics.shortest_edge) {
      metrics.shortest_edge = length;
      metrics.shortest_edge_cell = edge.left;
      metrics.shortest_edge_at = 0.5 * (a + b);
    }
  }
  metrics.mean_edge = sum / static_cast<double>(all.size());
}

}  // namespace

BlockMetrics measure(const Tessellation& tessellation) {
  BlockMetrics metrics{};
  measure_edges(tessellation, metrics);
  metrics.smallest_angle = 180.0;
  double total_area = 0.0;
  std::size_t zones = 0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    total_area += area(polygon);
    const ZonedBlock block = zone_block(polygon);
    zones += block.zones.size();
    for (const auto& zone : block.zones) {
      const auto at = [&](int i) { return block.gridpoints[static_cast<std::size_t>(i)]; };
      const double angle = smallest_angle({at(zone[0]), at(zone[1]), at(zone[2])}) * 180.0 / std::numbers::pi;
      if (angle < metrics.smallest_angle) {
        metrics.smallest_angle = angle;
        metrics.smallest_angle_cell = static_cast<int>(c);
      }
    }
  }
  metrics.zones_per_block = static_cast<double>(zones) / static_cast<double>(tessellation.cells.size());
  metrics.mean_size = std::sqrt(total_area / static_cast<double>(tessellation.cells.size()));
  return metrics;
}

}  // namespace pyroclast::specimen
