#include "pyroclast/thermal/heat_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

constexpr const char* kFlux = "heat flux";
constexpr const char* kCoefficient = "convection: coefficient";
constexpr const char* kConvectionGas = "convection: gas temperature";
constexpr const char* kEmissivity = "radiation: emissivity";
constexpr const char* kRadiationGas = "radiation: gas temperature";

double fourth_power(double x) {
  const double square = x * x;
  return square * square;
}

/// Returns the curves of a condition with their names.
std::vector<std::pair<const char*, const Curve*>> curves_of(const HeatFlux& c) {
  return {{kFlux, &c.flux}};
}
std::vector<std::pair<const char*, const Curve*>> curves_of(const Convection& c) {
  return {{kCoefficient, &c.coefficient}, {kConvectionGas, &c.gas_temperature}};
}
std::vector<std::pair<const char*, const Curve*>> curves_of(const Radiation& c) {
  return {{kEmissivity, &c.emissivity}, {kRadiationGas, &c.gas_temperature}};
}

void require_values(const Curve& curve, const char* quantity, double least, double greatest) {
  const auto [a, b] = curve.range();
  const double low = curve.minimum(a, b);
  const double high = curve.maximum(a, b);
  if (low < least || high > greatest)
    throw Error(fmt::format("{} ({}) has values from {} to {}, but {} to {} is allowed", quantity,
                            curve.describe(), low, high, least, greatest));
}

void require_physical(const HeatFlux&) {}
void require_physical(const Convection& c) {
  require_values(c.coefficient, kCoefficient, 0.0, std::numeric_limits<double>::infinity());
}
void require_physical(const Radiation& c) {
  require_values(c.emissivity, kEmissivity, 0.0, 1.0);
}

/// Returns the temperatures to which a flux between two, W/m², can draw.
Interval reach_of_flux(double least, double greatest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Interval reach = nothing();
  if (least < 0.0) include(reach, -infinity);
  if (greatest > 0.0) include(reach, infinity);
  return reach;
}
Interval extremes(const Curve& curve, double begin, double end) {
  return {curve.minimum(begin, end), curve.maximum(begin, end)};
}

/// Returns the temperatures to which a condition can draw between two times.
Interval reach_of(const HeatFlux& c, double begin, double end) {
  const auto [least, greatest] = extremes(c.flux, begin, end);
  return reach_of_flux(least, greatest);
}
template <class OfGas>
Interval reach_of(const OfGas& c, double begin, double end) {
  return extremes(c.gas_temperature, begin, end);
}

/// Returns the temperatures to which a condition can draw at one time.
Interval reach_at(const HeatFlux& c, double time) {
  const double flux = c.flux(time);
  return reach_of_flux(flux, flux);
}
template <class OfGas>
Interval reach_at(const OfGas& c, double time) {
  const double gas = c.gas_temperature(time);
  return {gas, gas};
}

/// Heat flux into a face at temperature T, at one time, W/m²: constant - coefficient T - emissive (absolute
/// T)^4.
struct FaceLaw {
  double constant, coefficient, emissive;

  double flux(double temperature) const {
    return constant - coefficient * temperature - emissive * fourth_power(temperature - absolute_zero);
  }
  double slope(double temperature) const {
    const double absolute = temperature - absolute_zero;
    return coefficient + 4.0 * emissive * absolute * absolute * absolute;
  }
};

FaceLaw law_at(const HeatFlux& c, double time) {
  return {c.flux(time), 0.0, 0.0};
}
FaceLaw law_at(const Convection& c, double time) {
  const double h = c.coefficient(time);
  return {h * c.gas_temperature(time), h, 0.0};
}
FaceLaw law_at(const Radiation& c, double time) {
  const double emissive = c.emissivity(time) * stefan_boltzmann;
  return {emissive * fourth_power(c.gas_temperature(time) - absolute_zero), 0.0, emissive};
}

/// Returns a law with the greatest coefficients of a span of time, for slopes only.
FaceLaw steepest_law(const HeatFlux&, double, double) {
  return {0.0, 0.0, 0.0};
}
FaceLaw steepest_law(const Convection& c, double begin, double end) {
  return {0.0, c.coefficient.maximum(begin, end), 0.0};
}
FaceLaw steepest_law(const Radiation& c, double begin, double end) {
  return {0.0, 0.0, c.emissivity.maximum(begin, end) * stefan_boltzmann};
}

double& part(HeatByKind& heat, const HeatFlux&) {
  return heat.flux;
}
double& part(HeatByKind& heat, const Convection&) {
  return heat.convection;
}
double& part(HeatByKind& heat, const Radiation&) {
  return heat.radiation;
}

}  // namespace

void require_curve_of_time(const Curve& curve, const char* quantity) {
  if (!curve.is_constant() && curve.axis() != time_axis())
    throw Error(fmt::format("{} ({}) is a function of {} [{}], but it must be one of the time", quantity,
                            curve.describe(), curve.axis().symbol, curve.axis().unit));
}

void require_defined(const Curve& curve, const char* quantity, double begin, double end) {
  if (!curve.holds({begin, end}))
    throw Error(fmt::format("{} ({}) is not defined all the way from {} to {} s", quantity, curve.describe(),
                            begin, end));
}

void HeatBoundary::add(const BoundaryCondition& condition, std::vector<BoundaryPatch> patches,
                       const ChunkList& nodes) {
  std::visit(
      [](const auto& c) {
        for (const auto& [quantity, curve] : curves_of(c)) require_curve_of_time(*curve, quantity);
        require_physical(c);
      },
      condition);
  ChunkList chunks = nodes.of_some(static_cast<int>(patches.size()), [&](int i) { return patches[i].node; });
  entries_.push_back({condition, std::move(patches), std::move(chunks)});
}

void HeatBoundary::require_defined(double begin, double end) const {
  for (const auto& entry : entries_)
    for (const auto& [quantity, curve] :
         std::visit([](const auto& c) { return curves_of(c); }, entry.condition))
      pyroclast::require_defined(*curve, quantity, begin, end);
}

Interval HeatBoundary::reach(double begin, double end) const {
  Interval reach = nothing();
  for (const auto& entry : entries_)
    include(reach, std::visit([&](const auto& c) { return reach_of(c, begin, end); }, entry.condition));
  return reach;
}

void HeatBoundary::add_reach(double time, std::vector<Interval>& ranges) const {
  for (const auto& entry : entries_) {
    const Interval reach = std::visit([&](const auto& c) { return reach_at(c, time); }, entry.condition);
    for (const auto& patch : entry.patches) include(ranges[patch.node], reach);
  }
}

void HeatBoundary::inflow(double time, const std::vector<double>& temperature, std::vector<double>& heat,
                          KeptSums& sums) const {
  for (const auto& entry : entries_)
    for (const auto& patch : entry.patches) heat[patch.node] = 0.0;
  for (const auto& entry : entries_) {
    const FaceLaw law = std::visit([&](const auto& c) { return law_at(c, time); }, entry.condition);
    sums.keep(entry.chunks, [&](int i) {
      const auto& patch = entry.patches[i];
      const double inflow = patch.area * law.flux(temperature[patch.node]);
      heat[patch.node] += inflow;
      return inflow;
    });
  }
}

HeatByKind HeatBoundary::by_kind(std::span<const double> of_conditions) const {
  HeatByKind sum;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    std::visit([&](const auto& c) { part(sum, c) += of_conditions[i]; }, entries_[i].condition);
  return sum;
}

void HeatBoundary::add_slope(double begin, double end, const std::vector<double>& hottest, double weight,
                             std::vector<double>& slope) const {
  for (const auto& entry : entries_) {
    const FaceLaw law =
        std::visit([&](const auto& c) { return steepest_law(c, begin, end); }, entry.condition);
    for (const auto& patch : entry.patches)
      slope[patch.node] += weight * patch.area * law.slope(hottest[patch.node]);
  }
}

}  // namespace pyroclast
