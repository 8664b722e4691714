#include "pyroclast/specimen/superposition.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "pyroclast/specimen/grain_grid.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Calls f(corners, numbers of the grains nearby) for each cell and returns the value for each.
template <class F>
auto for_each_cell(const Tessellation& tessellation, const Box& box, std::span<const Aggregate> grains,
                   F&& f) {
  const GrainGrid<2> grid(box.low, box.high, grains);
  std::vector<int> numbers;
  std::vector<decltype(f(Corners{}, numbers))> result;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    const Box around = box_of(polygon);
    grid.collect(around.low, around.high, numbers);
    result.push_back(f(Corners(polygon), numbers));
  }
  return result;
}

Cover cover_of(Corners polygon, std::span<const Aggregate> grains, const std::vector<int>& numbers) {
  constexpr double rounding = 1e-12;  // left by circles that do not touch the cell
  double covered = 0.0, most_of_one = 0.0;
  std::map<int, double> by_phase;
  Cover cover;
  for (const int number : numbers) {
    const Aggregate& a = grains[number];
    const double common =
        a.shape ? common_area(polygon, corners_of(a)) : common_area(polygon, a.centre, 0.5 * a.diameter);
    covered += common;
    by_phase[a.phase] += common;
    if (common <= most_of_one) continue;
    most_of_one = common;
    cover.grain = number;
  }
  double most = 0.0;
  for (const auto& [phase, area] : by_phase)
    if (area > most) {
      most = area;
      cover.phase = phase;
    }
  const double share = covered / area(polygon);
  cover.share = share < rounding ? 0.0 : std::min(share, 1.0);
  return cover;
}

/// Returns the grain in which the centroid of each cell lies, -1: in none.
std::vector<int> grains_at_centroids(const Tessellation& tessellation, const Box& box,
                                     std::span<const Aggregate> grains) {
  return for_each_cell(tessellation, box, grains, [&](Corners polygon, const std::vector<int>& numbers) {
    const Vec<2> centre = centroid(polygon);
    const auto around =
        std::ranges::find_if(numbers, [&](int number) { return holds(grains[number], centre); });
    return around == numbers.end() ? -1 : *around;
  });
}

/// Tells whether a fibre runs through the inside of a convex cell: clips it by the half planes of the edges.
bool crosses(const std::vector<Vec<2>>& polygon, const Fibre& fibre) {
  const Vec<2> along = fibre.to - fibre.from;
  double enters = 0.0, leaves = 1.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<2> edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec<2> inward{{-edge[1], edge[0]}};
    const double start = dot(fibre.from - polygon[i], inward), rate = dot(along, inward);
    if (rate > 0.0)
      enters = std::max(enters, -start / rate);
    else if (rate < 0.0)
      leaves = std::min(leaves, -start / rate);
    else if (start <= 0.0)
      return false;
  }
  return leaves > enters;
}

}  // namespace

std::vector<Cover> covers_of(const Tessellation& tessellation, const Box& box,
                             std::span<const Aggregate> aggregates) {
  return for_each_cell(tessellation, box, aggregates, [&](Corners polygon, const std::vector<int>& numbers) {
    return cover_of(polygon, aggregates, numbers);
  });
}

double fitting_fraction(const Tessellation& tessellation, std::span<const Cover> covers,
                        std::span<const Aggregate> aggregates) {
  struct Cell {
    double covered, area;
  };
  std::vector<Cell> cells;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < covers.size(); ++c) {
    corners(tessellation, c, polygon);
    cells.push_back({covers[c].share, area(polygon)});
  }
  std::ranges::sort(cells, std::greater<>(), &Cell::covered);
  double missing = extent_of(aggregates);
  // cells become aggregate, the most covered first, while that brings their area nearer to that of the
  // circles
  std::size_t taken = 0;
  for (; taken < cells.size() && 0.5 * cells[taken].area < missing; ++taken) missing -= cells[taken].area;
  if (taken == 0) return std::nextafter(1.0, 0.0);
  if (taken == cells.size()) return 0.0;
  return 0.5 * (cells[taken - 1].covered + cells[taken].covered);
}

Superposed superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                     const SpecimenParameters& parameters, int matrix) {
  const Box& box = parameters.region.box();
  Superposed result{.covered_fraction = parameters.covered_fraction};
  if (parameters.superposition == Superposition::centroid) {
    result.grain = grains_at_centroids(tessellation, box, aggregates);
    for (const int grain : result.grain) result.phase.push_back(grain < 0 ? matrix : aggregates[grain].phase);
    return result;
  }
  const std::vector<Cover> covers = covers_of(tessellation, box, aggregates);
  if (parameters.superposition == Superposition::fit)
    result.covered_fraction = fitting_fraction(tessellation, covers, aggregates);
  for (const Cover& cover : covers) {
    const bool is_covered = cover.share > result.covered_fraction;
    result.phase.push_back(is_covered ? cover.phase : matrix);
    result.grain.push_back(is_covered ? cover.grain : -1);
  }
  return result;
}

void superpose(const Tessellation& tessellation, std::span<const Fibre> fibres, std::vector<int>& phase,
               std::vector<int>& grain) {
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    for (const Fibre& fibre : fibres)
      if (crosses(polygon, fibre)) {
        phase[c] = fibre.phase;
        grain[c] = -1;
      }
  }
}

}  // namespace pyroclast::specimen
