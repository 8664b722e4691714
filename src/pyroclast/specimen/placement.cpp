#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/circle_grid.hpp"

namespace pyroclast::specimen {
namespace {

/// A free place for a circle of this diameter; none when `attempts` centres are all taken.
std::optional<Aggregate> find_place(double diameter, double width, double height, const CircleGrid& grid,
                                    const AggregateParameters& parameters, Random& random) {
  const double margin = 0.5 * diameter + parameters.minimum_gap;
  if (2.0 * margin > std::min(width, height)) return std::nullopt;
  for (int attempt = 0; attempt < parameters.attempts; ++attempt) {
    const double x = random.uniform(margin, width - margin);
    const double y = random.uniform(margin, height - margin);
    const Aggregate circle{{{x, y}}, diameter};
    if (!grid.overlaps(circle, parameters.minimum_gap)) return circle;
  }
  return std::nullopt;
}

/// Of a point from a fibre, m.
double distance(const Vec<2>& point, const Fibre& fibre) {
  const Vec<2> along = fibre.to - fibre.from;
  const double share = std::clamp(dot(point - fibre.from, along) / dot(along, along), 0.0, 1.0);
  return norm(point - (fibre.from + along * share));
}

[[noreturn]] void throw_missing(std::span<const double> missing, std::size_t asked, double specimen_area,
                                const AggregateParameters& parameters) {
  double area = 0.0;
  for (const double d : missing) area += 0.25 * std::numbers::pi * d * d;
  throw Error(fmt::format(
      "The aggregates do not fit: {} of {} found no place in {} attempts each, diameters {:.4g} to {:.4g} m. "
      "Missing is an area fraction of {:.4f} of the {:.4f} asked for. Allow a lower fraction, a smaller "
      "minimum gap than {:.4g} m, or more attempts.",
      missing.size(), asked, parameters.attempts, missing.back(), missing.front(), area / specimen_area,
      parameters.fraction, parameters.minimum_gap));
}

}  // namespace

std::vector<Aggregate> place(std::span<const double> diameters, double width, double height,
                             const AggregateParameters& parameters, std::span<const Aggregate> standing,
                             Random& random) {
  // Bins twice the smallest diameter: a small circle looks at few neighbours, a large one lists in few bins.
  CircleGrid grid(width, height, 2.0 * parameters.d_min);
  for (const Aggregate& circle : standing) grid.insert(circle);
  std::vector<double> missing;
  for (const double diameter : diameters) {
    if (const auto circle = find_place(diameter, width, height, grid, parameters, random)) {
      grid.insert(*circle);
    } else {
      missing.push_back(diameter);
    }
  }
  if (!missing.empty()) throw_missing(missing, diameters.size(), width * height, parameters);
  return {grid.circles().begin() + static_cast<std::ptrdiff_t>(standing.size()), grid.circles().end()};
}

std::vector<Fibre> place_fibres(const FibreParameters& p, double width, double height,
                                std::span<const Aggregate> standing, Random& random) {
  const auto fits = [&](const Fibre& fibre) {
    for (const Vec<2>& end : {fibre.from, fibre.to})
      if (std::min({end[0], width - end[0], end[1], height - end[1]}) < p.minimum_gap) return false;
    return std::ranges::none_of(standing, [&](const Aggregate& a) {
      return distance(a.centre, fibre) < 0.5 * a.diameter + p.minimum_gap;
    });
  };
  std::vector<Fibre> fibres;
  for (int i = 0; i < p.count; ++i) {
    int attempt = 0;
    for (; attempt < p.attempts; ++attempt) {
      const Vec<2> centre{{random.uniform(0.0, width), random.uniform(0.0, height)}};
      const double angle = random.uniform(0.0, std::numbers::pi);
      const Vec<2> half = Vec<2>{{std::cos(angle), std::sin(angle)}} * (0.5 * p.length);
      const Fibre fibre{centre - half, centre + half};
      if (!fits(fibre)) continue;
      fibres.push_back(fibre);
      break;
    }
    if (attempt == p.attempts)
      throw Error(
          fmt::format("The fibres do not fit: {} of {} of the phase \"{}\", {:.4g} m long, found a place "
                      "within {} attempts. "
                      "Allow fewer or shorter ones, a smaller minimum gap than {:.4g} m, or more attempts.",
                      fibres.size(), p.count, p.phase, p.length, p.attempts, p.minimum_gap));
  }
  return fibres;
}

}  // namespace pyroclast::specimen
