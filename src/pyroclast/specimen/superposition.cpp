#include "pyroclast/specimen/superposition.hpp"

#include <algorithm>

#include "pyroclast/specimen/circle_grid.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// Calls f(corners, circles nearby) for each cell; the value it returns is that cell's.
template <class F>
auto for_each_cell(const Tessellation& tessellation, double width, double height,
                   std::span<const Aggregate> aggregates, F&& f) {
  double bin = std::max(width, height);
  for (const Aggregate& a : aggregates) bin = std::min(bin, 2.0 * a.diameter);
  CircleGrid grid(width, height, bin);
  for (const Aggregate& a : aggregates) grid.insert(a);

  std::vector<decltype(f(Corners{}, grid.circles()))> result;
  std::vector<Vec<2>> polygon;
  std::vector<Aggregate> nearby;
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
    grid.collect(lower, upper, nearby);
    result.push_back(f(Corners(polygon), nearby));
  }
  return result;
}

}  // namespace

std::vector<double> covered_fractions(const Tessellation& tessellation, double width, double height,
                                      std::span<const Aggregate> aggregates) {
  return for_each_cell(tessellation, width, height, aggregates,
                       [](Corners polygon, const std::vector<Aggregate>& nearby) {
                         double covered = 0.0;
                         for (const Aggregate& a : nearby) {
                           covered += common_area(polygon, a.centre, 0.5 * a.diameter);
                         }
                         constexpr double rounding = 1e-12;  // left by circles that do not touch the cell
                         const double share = covered / area(polygon);
                         return share < rounding ? 0.0 : std::min(share, 1.0);
                       });
}

std::vector<Constituent> superpose(const Tessellation& tessellation, std::span<const Aggregate> aggregates,
                                   const SpecimenParameters& parameters) {
  if (parameters.superposition == Superposition::centroid) {
    return for_each_cell(tessellation, parameters.width, parameters.height, aggregates,
                         [](Corners polygon, const std::vector<Aggregate>& nearby) {
                           const Vec<2> centre = centroid(polygon);
                           const bool inside =
                               std::any_of(nearby.begin(), nearby.end(), [&](const Aggregate& a) {
                                 return norm(centre - a.centre) <= 0.5 * a.diameter;
                               });
                           return inside ? Constituent::aggregate : Constituent::mortar;
                         });
  }
  std::vector<Constituent> result;
  for (const double covered :
       covered_fractions(tessellation, parameters.width, parameters.height, aggregates)) {
    result.push_back(covered > parameters.covered_fraction ? Constituent::aggregate : Constituent::mortar);
  }
  return result;
}

}  // namespace pyroclast::specimen
