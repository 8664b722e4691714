#include "pyroclast/specimen/stone_fit.hpp"

#include <array>
#include <cmath>

#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

/// Returns the mean square distance of an edge from the outline of a stone, m²: by Gauss's rule of three
/// points.
double mean_square_distance(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to) {
  const std::array<double, 3> at{0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const std::array<double, 3> weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double sum = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double away = distance(stone, from + at[i] * (to - from));
    sum += weight[i] * away * away;
  }
  return sum;
}

/// Returns the length of an edge, m, or the area of a face, m².
double size_of(const Cells<2>& cells, const Facet<2>& edge) {
  return norm(cells.vertices[edge.corners[1]] - cells.vertices[edge.corners[0]]);
}
double size_of(const Cells<3>& cells, const Facet<3>& face) {
  return norm(area_vector(cells, face));
}

/// Returns the integral over a facet of the square of its distance from the surface of a stone.
double square_distance(const Cells<2>& cells, const Facet<2>& edge, const Stone<2>& stone) {
  return size_of(cells, edge) *
         mean_square_distance(stone, cells.vertices[edge.corners[0]], cells.vertices[edge.corners[1]]);
}
/// By the middles of the edges of each triangle, which is exact for squares.
double square_distance(const Cells<3>& cells, const Facet<3>& face, const Stone<3>& stone) {
  const auto at = [&](std::size_t i) { return cells.vertices[face.corners[i]]; };
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
    const Vec<3> a = at(0), b = at(i), c = at(i + 1);
    const double area = 0.5 * norm(cross(b - a, c - a));
    for (const Vec<3>& middle : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) {
      const double away = distance(stone, middle);
      sum += area / 3.0 * away * away;
    }
  }
  return sum;
}

}  // namespace

template <int Dim>
std::vector<StoneFit> fits_of(const Specimen<Dim>& specimen) {
  if (specimen.stone.empty()) return {};
  std::vector<StoneFit> fits;
  for (const Stone<Dim>& stone : specimen.stones)
    fits.push_back(
        {extent(stone), stone.shape ? stone.shape->size() : Ball<Dim>(0.5 * stone.diameter).size()});
  for (std::size_t c = 0; c < specimen.cells.cells.size(); ++c) {
    if (specimen.stone[c] < 0) continue;
    StoneFit& fit = fits[specimen.stone[c]];
    fit.extent_of_blocks += extent(specimen.cells, c);
    ++fit.blocks;
  }
  for (const Facet<Dim>& facet : facets(specimen.cells)) {
    if (facet.outer < 0) continue;
    const int left = specimen.stone[facet.inner], right = specimen.stone[facet.outer];
    if (left == right) continue;
    for (const int stone : {left, right}) {
      if (stone < 0) continue;
      fits[stone].interface += size_of(specimen.cells, facet);
      fits[stone].deviation += square_distance(specimen.cells, facet, specimen.stones[stone]);
    }
  }
  for (StoneFit& fit : fits)
    if (fit.interface > 0.0) fit.deviation = std::sqrt(fit.deviation / fit.interface);
  return fits;
}

template std::vector<StoneFit> fits_of(const Specimen<2>&);
template std::vector<StoneFit> fits_of(const Specimen<3>&);

}  // namespace pyroclast::specimen
