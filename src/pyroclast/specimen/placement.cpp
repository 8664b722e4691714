#include "pyroclast/specimen/placement.hpp"

#include <algorithm>
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
                             const AggregateParameters& parameters, Random& random) {
  // Bins twice the smallest diameter: a small circle looks at few neighbours, a large one lists in few bins.
  CircleGrid grid(width, height, 2.0 * parameters.d_min);
  std::vector<double> missing;
  for (const double diameter : diameters) {
    if (const auto circle = find_place(diameter, width, height, grid, parameters, random)) {
      grid.insert(*circle);
    } else {
      missing.push_back(diameter);
    }
  }
  if (!missing.empty()) throw_missing(missing, diameters.size(), width * height, parameters);
  return grid.circles();
}

}  // namespace pyroclast::specimen
