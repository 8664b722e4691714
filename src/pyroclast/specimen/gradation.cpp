#include "pyroclast/specimen/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/shell.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

template <int Dim>
double diameter_of(double extent) {
  if constexpr (Dim == 2)
    return std::sqrt(4.0 * extent / std::numbers::pi);
  else
    return std::cbrt(6.0 * extent / std::numbers::pi);
}

/// Draws a diameter in [low, high). The extent passing grows as d^nf, so the number of stones per size falls
/// as d^(nf - 1 - Dim); this inverts its cumulative form.
template <int Dim>
double draw_diameter(double low, double high, double fuller_exponent, Random& random) {
  const double power = fuller_exponent - Dim;
  const double a = std::pow(low, power);
  const double b = std::pow(high, power);
  return std::clamp(std::pow(a + (b - a) * random.uniform(), 1.0 / power), low, high);
}

}  // namespace

double fuller_passing(const AggregateParameters& parameters, double size) {
  const auto passing = [&](double d) { return std::pow(d / parameters.d_max, parameters.fuller_exponent); };
  const double smallest = passing(parameters.d_min);
  return (passing(size) - smallest) / (1.0 - smallest);
}

double passing(const AggregateParameters& parameters, double size) {
  if (parameters.passing.empty()) return fuller_passing(parameters, size);
  const std::vector<double>&sizes = parameters.sieves, &shares = parameters.passing;
  const auto next = std::ranges::upper_bound(sizes, size) - sizes.begin();
  if (next == 0) return 0.0;
  if (next == std::ssize(sizes)) return 1.0;
  const double part = (size - sizes[next - 1]) / (sizes[next] - sizes[next - 1]);
  return shares[next - 1] + part * (shares[next] - shares[next - 1]);
}

namespace {

/// Returns a stone of width 1 of the shapes asked for.
template <int Dim>
Stone<Dim> draw_unit_stone(const ShapeParameters& parameters, Random& random) {
  Stone<Dim> stone{{}, 1.0};
  if constexpr (Dim == 2)
    stone.shape = draw_outline(parameters, random);
  else
    stone.shape = draw_shell(parameters, random);
  return stone;
}

/// Returns a stone at the origin, larger by a factor.
template <int Dim>
Stone<Dim> scaled(Stone<Dim> stone, double factor) {
  stone.diameter *= factor;
  if (stone.shape) stone.shape = stone.shape->scaled(factor);
  return stone;
}

}  // namespace

template <int Dim>
std::vector<Stone<Dim>> draw_stones(const AggregateParameters& parameters, double specimen_extent,
                                    Random& random) {
  const double total = parameters.fraction * specimen_extent;
  const std::vector<double>& sieves = parameters.sieves;
  std::vector<Stone<Dim>> stones;
  double remaining = 0.0;
  Stone<Dim> next = draw_unit_stone<Dim>(parameters.shape, random);
  // extent of the next stone over that of a round one
  const auto factor = [&] { return next.shape ? extent(next) / extent_of_round<Dim>(1.0) : 1.0; };
  const auto take = [&](double diameter) {
    stones.push_back(scaled(next, diameter));
    remaining -= extent(stones.back());
    next = draw_unit_stone<Dim>(parameters.shape, random);
  };
  for (std::size_t i = sieves.size() - 1; i > 0; --i) {
    const double low = sieves[i - 1];
    const double share = passing(parameters, sieves[i]) - passing(parameters, low);
    if (share == 0.0) continue;  // a gap of the grading
    remaining += total * share;
    while (remaining >= factor() * extent_of_round<Dim>(low)) {
      const double high = std::min(sieves[i], diameter_of<Dim>(remaining / factor()));
      take(draw_diameter<Dim>(low, high, parameters.fuller_exponent, random));
    }
  }
  if (remaining > 0.5 * factor() * extent_of_round<Dim>(parameters.d_min)) take(parameters.d_min);
  std::ranges::stable_sort(stones, std::greater<>(), &Stone<Dim>::diameter);
  return stones;
}

template std::vector<Stone<2>> draw_stones(const AggregateParameters&, double, Random&);
template std::vector<Stone<3>> draw_stones(const AggregateParameters&, double, Random&);

template <int Dim>
std::vector<GradationPoint> gradation(const AggregateParameters& parameters,
                                      const std::vector<Stone<Dim>>& aggregates,
                                      std::span<const double> sizes) {
  if (aggregates.empty()) throw Error("No grading curve: the specimen has no aggregates.");
  const double total = extent_of(std::span<const Stone<Dim>>(aggregates));
  std::vector<GradationPoint> points;
  for (const double size : sizes) {
    double realised = 0.0;
    for (const auto& a : aggregates)
      if (a.diameter <= size) realised += extent(a);
    points.push_back({size, 100.0 * passing(parameters, size), 100.0 * realised / total});
  }
  return points;
}

template std::vector<GradationPoint> gradation(const AggregateParameters&, const std::vector<Stone<2>>&,
                                               std::span<const double>);
template std::vector<GradationPoint> gradation(const AggregateParameters&, const std::vector<Stone<3>>&,
                                               std::span<const double>);

}  // namespace pyroclast::specimen
