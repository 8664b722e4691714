#include "pyroclast/specimen/grain_fit.hpp"

#include <array>
#include <cmath>

#include "pyroclast/specimen/grain.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Returns the mean square distance of an edge from the outline of a grain, m²: by Gauss's rule of three
/// points.
double mean_square_distance(const Grain<2>& grain, const Vec<2>& from, const Vec<2>& to) {
  const std::array<double, 3> at{0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const std::array<double, 3> weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double away = distance(grain, from + at[i] * (to - from));
    sum += weight[i] * away * away;
  }
  return sum;
}

}  // namespace

std::vector<GrainFit> fits_of(const Specimen<2>& specimen) {
  if (specimen.grain.empty()) return {};
  std::vector<GrainFit> fits;
  for (const Grain<2>& grain : specimen.stones)
    fits.push_back({extent(grain), grain.shape ? grain.shape->size() : Ball<2>(0.5 * grain.diameter).size()});
  const Cells<2>& tessellation = specimen.cells;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    if (specimen.grain[c] < 0) continue;
    corners(tessellation, c, polygon);
    GrainFit& fit = fits[specimen.grain[c]];
    fit.area_of_blocks += area(polygon);
    ++fit.blocks;
  }
  for (const Facet<2>& edge : facets(tessellation)) {
    const int left = specimen.grain[edge.inner], right = edge.outer < 0 ? -1 : specimen.grain[edge.outer];
    if (left == right || edge.outer < 0) continue;
    const Vec<2>&from = tessellation.vertices[edge.corners[0]], &to = tessellation.vertices[edge.corners[1]];
    for (const int grain : {left, right}) {
      if (grain < 0) continue;
      fits[grain].interface += norm(to - from);
      fits[grain].deviation += norm(to - from) * mean_square_distance(specimen.stones[grain], from, to);
    }
  }
  for (GrainFit& fit : fits)
    if (fit.interface > 0.0) fit.deviation = std::sqrt(fit.deviation / fit.interface);
  return fits;
}

}  // namespace pyroclast::specimen
