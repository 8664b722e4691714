#include "pyroclast/specimen/superposition.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/stone_grid.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Calls f(corners, circles nearby) for each cell and returns the value for each.
template <class F>
auto for_each_cell(const Tessellation& tessellation, const Box& box, std::span<const Aggregate> aggregates,
                   F&& f) {
  const StoneGrid<2> grid(box.low, box.high, aggregates);
  std::vector<decltype(f(Corners{}, grid.stones()))> result;
  std::vector<Vec<2>> polygon;
  std::vector<Aggregate> nearby;
  std::vector<int> numbers;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    Vec<2> lower = polygon.front();
    Vec<2> upper = polygon.front();
    for (const Vec<2>& p : polygon) {
      for (int i = 0; i < 2; ++i) {
        lower[i] = std::min(lower[i], p[i]);
        upper[i] = std::max(upper[i], p[i]);
      }
    }
    grid.collect(lower, upper, numbers);
    nearby.clear();
    for (const int number : numbers) nearby.push_back(grid.stones()[number]);
    result.push_back(f(Corners(polygon), nearby));
  }
  return result;
}

Cover cover_of(Corners polygon, const std::vector<Aggregate>& nearby) {
  constexpr double rounding = 1e-12;  // left by circles that do not touch the cell
  double covered = 0.0;
  std::map<int, double> by_phase;
  for (const Aggregate& a : nearby) {
    const double common = common_area(polygon, a.centre, 0.5 * a.diameter);
    covered += common;
    by_phase[a.phase] += common;
  }
  Cover cover;
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

std::vector<int> phases_at_centroids(const Tessellation& tessellation, const Box& box,
                                     std::span<const Aggregate> aggregates, int matrix) {
  const auto phase_of = [&](Corners polygon, const std::vector<Aggregate>& nearby) {
    const Vec<2> centre = centroid(polygon);
    const auto around = std::ranges::find_if(
        nearby, [&](const Aggregate& a) { return norm(centre - a.centre) <= 0.5 * a.diameter; });
    return around == nearby.end() ? matrix : around->phase;
  };
  return for_each_cell(tessellation, box, aggregates, phase_of);
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
  return for_each_cell(tessellation, box, aggregates, cover_of);
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
  double missing = 0.0;
  for (const Aggregate& a : aggregates) missing += 0.25 * std::numbers::pi * a.diameter * a.diameter;
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
    result.phase = phases_at_centroids(tessellation, box, aggregates, matrix);
    return result;
  }
  const std::vector<Cover> covers = covers_of(tessellation, box, aggregates);
  if (parameters.superposition == Superposition::fit)
    result.covered_fraction = fitting_fraction(tessellation, covers, aggregates);
  for (const Cover& cover : covers)
    result.phase.push_back(cover.share > result.covered_fraction ? cover.phase : matrix);
  return result;
}

void superpose(const Tessellation& tessellation, std::span<const Fibre> fibres, std::vector<int>& phase) {
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < tessellation.cells.size(); ++c) {
    corners(tessellation, c, polygon);
    for (const Fibre& fibre : fibres)
      if (crosses(polygon, fibre)) phase[c] = fibre.phase;
  }
}

}  // namespace pyroclast::specimen
