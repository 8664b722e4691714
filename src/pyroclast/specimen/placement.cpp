#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/circle_grid.hpp"
#include "pyroclast/specimen/gradation.hpp"

namespace pyroclast::specimen {
namespace {

/// Share of the specimen above which circles and half of the gaps around them are not even tried. Discs of
/// one size fill 0.547 of the plane at random, discs of a gradation somewhat more.
constexpr double kDensestPlacement = 0.8;

/// Finds a free place for a circle of this diameter; returns none when `attempts` centres are all taken.
std::optional<Aggregate> find_place(double diameter, const Region& region, const CircleGrid& grid,
                                    const AggregateParameters& parameters, Random& random) {
  const Box& box = region.box();
  const double margin = 0.5 * diameter + parameters.minimum_gap;
  if (2.0 * margin > std::min(box.width(), box.height())) return std::nullopt;
  for (int attempt = 0; attempt < parameters.attempts; ++attempt) {
    const double x = random.uniform(box.low[0] + margin, box.high[0] - margin);
    const double y = random.uniform(box.low[1] + margin, box.high[1] - margin);
    const Aggregate circle{{{x, y}}, diameter};
    if (!region.is_rectangle() && region.distance_before_cuts(circle.centre) > -margin) continue;
    if (!grid.overlaps(circle, parameters.minimum_gap)) return circle;
  }
  return std::nullopt;
}

/// Throws Error for circles that can never fit: with their gaps they would take more than any packing.
void require_feasible(std::span<const double> diameters, double specimen_area,
                      const AggregateParameters& parameters) {
  double area = 0.0;
  for (const double d : diameters) area += circle_area(d + parameters.minimum_gap);
  if (area / specimen_area < kDensestPlacement) return;
  throw Error(fmt::format(
      "{}: the aggregates of a fraction of {:.4g} cannot fit: {} circles of {:.4g} to {:.4g} mm with gaps of "
      "{:.4g} mm between them "
      "would take {:.2f} of the specimen, and random placement fills {} at most; allow a lower fraction, a "
      "larger d_min, or a smaller minimum_gap",
      parameters.place, parameters.fraction, diameters.size(), 1e3 * diameters.back(),
      1e3 * diameters.front(), 1e3 * parameters.minimum_gap, area / specimen_area, kDensestPlacement));
}

[[noreturn]] void throw_no_place(std::span<const double> diameters, std::size_t placed, double specimen_area,
                                 const AggregateParameters& parameters) {
  double area = 0.0;
  for (std::size_t i = 0; i < placed; ++i) area += circle_area(diameters[i]);
  throw Error(fmt::format(
      "{}: the aggregates do not fit: after {} of {}, an area fraction of {:.3f} of the {:.3f} asked for, "
      "one of {:.4g} mm found no place in {} attempts; allow a lower fraction, "
      "a smaller minimum_gap than {:.4g} mm, or more attempts",
      parameters.place, placed, diameters.size(), area / specimen_area, parameters.fraction,
      1e3 * diameters[placed], parameters.attempts, 1e3 * parameters.minimum_gap));
}

}  // namespace

std::vector<Aggregate> place(std::span<const double> diameters, const Region& region,
                             const AggregateParameters& parameters, std::span<const Aggregate> standing,
                             Random& random) {
  require_feasible(diameters, region.area(), parameters);
  // Bins twice the smallest diameter: a small circle looks at few neighbours, a large one lists in few bins.
  CircleGrid grid(region.box(), 2.0 * parameters.d_min);
  for (const Aggregate& circle : standing) grid.insert(circle);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const auto circle = find_place(diameters[i], region, grid, parameters, random);
    if (!circle) throw_no_place(diameters, i, region.area(), parameters);
    grid.insert(*circle);
  }
  return {grid.circles().begin() + static_cast<std::ptrdiff_t>(standing.size()), grid.circles().end()};
}

std::vector<Fibre> place_fibres(const FibreParameters& p, const Region& region,
                                std::span<const Aggregate> standing, Random& random) {
  const auto fits = [&](const Fibre& fibre) {
    for (const Vec<2>& end : {fibre.from, fibre.to})
      if (region.distance_before_cuts(end) > -p.minimum_gap) return false;
    return std::ranges::none_of(standing, [&](const Aggregate& a) {
      return distance_from_segment(a.centre, fibre.from, fibre.to) < 0.5 * a.diameter + p.minimum_gap;
    });
  };
  std::vector<Fibre> fibres;
  for (int i = 0; i < p.count; ++i) {
    int attempt = 0;
    for (; attempt < p.attempts; ++attempt) {
      const Box& box = region.box();
      const Vec<2> centre{{random.uniform(box.low[0], box.high[0]), random.uniform(box.low[1], box.high[1])}};
      const double angle = random.uniform(0.0, std::numbers::pi);
      const Vec<2> half = Vec<2>{{std::cos(angle), std::sin(angle)}} * (0.5 * p.length);
      const Fibre fibre{centre - half, centre + half};
      if (!fits(fibre)) continue;
      fibres.push_back(fibre);
      break;
    }
    if (attempt == p.attempts)
      throw Error(
          fmt::format("{}: the fibres do not fit: {} of {} of the phase \"{}\", {:.4g} m long, found a place "
                      "within {} attempts; "
                      "allow fewer or shorter ones, a smaller minimum_gap than {:.4g} m, or more attempts",
                      p.place, fibres.size(), p.count, p.phase, p.length, p.attempts, p.minimum_gap));
  }
  return fibres;
}

}  // namespace pyroclast::specimen
