#include "pyroclast/specimen/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "pyroclast/base/error.hpp"

namespace pyroclast::specimen {
namespace {

double diameter_of(double area) {
  return std::sqrt(4.0 * area / std::numbers::pi);
}

/// Draws a diameter in [low, high). The area passing grows as d^nf, so the number of circles per size falls
/// as d^(nf - 3); this inverts its cumulative form.
double draw_diameter(double low, double high, double fuller_exponent, Random& random) {
  const double power = fuller_exponent - 2.0;
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

std::vector<double> draw_diameters(const AggregateParameters& parameters, double specimen_area,
                                   Random& random) {
  const double total = parameters.fraction * specimen_area;
  const std::vector<double>& sieves = parameters.sieves;
  std::vector<double> diameters;
  double remaining = 0.0;
  for (std::size_t i = sieves.size() - 1; i > 0; --i) {
    const double low = sieves[i - 1];
    const double share = passing(parameters, sieves[i]) - passing(parameters, low);
    if (share == 0.0) continue;  // a gap of the grading
    remaining += total * share;
    while (remaining >= circle_area(low)) {
      const double high = std::min(sieves[i], diameter_of(remaining));
      diameters.push_back(draw_diameter(low, high, parameters.fuller_exponent, random));
      remaining -= circle_area(diameters.back());
    }
  }
  if (remaining > 0.5 * circle_area(parameters.d_min)) diameters.push_back(parameters.d_min);
  std::sort(diameters.begin(), diameters.end(), std::greater<>());
  return diameters;
}

std::vector<GradationPoint> gradation(const AggregateParameters& parameters,
                                      std::span<const Aggregate> aggregates, std::span<const double> sizes) {
  if (aggregates.empty()) throw Error("No grading curve: the specimen has no aggregates.");
  double total = 0.0;
  for (const Aggregate& a : aggregates) total += circle_area(a.diameter);
  std::vector<GradationPoint> points;
  for (const double size : sizes) {
    double realised = 0.0;
    for (const Aggregate& a : aggregates) {
      if (a.diameter <= size) realised += circle_area(a.diameter);
    }
    points.push_back({size, 100.0 * passing(parameters, size), 100.0 * realised / total});
  }
  return points;
}

}  // namespace pyroclast::specimen
