#include "pyroclast/results/properties_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Temperatures that are listed at least, as far as a curve has them: those of the paper's Figs. 10 and 11,
/// °C.
constexpr Interval kListed{20.0, 800.0};

/// Greatest distance of two rows, K: small enough to show the jump of the standards' specific heat at 100 °C.
constexpr double kTemperatureStep = 1.0;

constexpr double kMissed = 1e-3;  // of the greatest value, see PropertyRows::few

struct PropertyPoint {
  double temperature, value;
};

void add_material(const BlockMaterial& material, bool moves, std::vector<ReadCurve>& list) {
  const auto add = [&](const char* key, const Unit& unit, const Curve& curve) {
    list.push_back({fmt::format("materials.{}.{}", material.name, key), unit.si, curve});
  };
  if (moves) add("E", unit::stress, material.young);
  add("density", unit::density, material.density);
  if (moves) add("thermal_strain", unit::dimensionless, material.thermal_strain);
  if (moves && material.creep) add("creep.strain", unit::dimensionless, material.creep->strain);
  if (material.conductivity) add("conductivity", unit::conductivity, *material.conductivity);
  if (!material.specific_heat) return;
  add("specific_heat", unit::specific_heat, *material.specific_heat);
  list.push_back({fmt::format("materials.{}.heat_capacity", material.name), "J/m3/K",
                  material.density * *material.specific_heat});
}

void add_contact(const ContactMaterial& contact, const std::string& name, std::vector<ReadCurve>& list) {
  for (std::size_t i = 0; i < contact.numbers.size(); ++i) {
    const PropertyInfo& info = contact.law->properties[i];
    if (is_apart_from_temperature(info.role) && info.role != Role::hidden_cracks) continue;
    list.push_back({fmt::format("contacts.{}.{}", name, info.key), info.unit.si, contact.numbers[i]});
  }
}

std::vector<PropertyPoint> every_kelvin(const Curve& curve, const Interval& run) {
  const Interval own = curve.range();
  const Interval range{std::max(own.lower, std::min(run.lower, kListed.lower)),
                       std::min(own.upper, std::max(run.upper, kListed.upper))};
  const int steps = std::max(1, static_cast<int>(std::ceil((range.upper - range.lower) / kTemperatureStep)));
  std::vector<PropertyPoint> points;
  for (int i = 0; i <= steps; ++i) {
    const double T = i == steps ? range.upper : range.lower + i * (range.upper - range.lower) / steps;
    points.push_back({T, curve(T)});
  }
  return points;
}

/// Returns some of the points, the first and the last among them: the line from each to the next one misses
/// no point between them by more than `missed`.
std::vector<PropertyPoint> few_of(const std::vector<PropertyPoint>& points, double missed) {
  std::vector<PropertyPoint> kept{points.front()};
  double least = -std::numeric_limits<double>::infinity(), most = -least;  // slopes that miss none
  for (std::size_t i = 1; i < points.size(); ++i) {
    double apart = points[i].temperature - kept.back().temperature;
    if (const double slope = (points[i].value - kept.back().value) / apart; slope < least || slope > most) {
      kept.push_back(points[i - 1]);
      least = -std::numeric_limits<double>::infinity();
      most = -least;
      apart = points[i].temperature - kept.back().temperature;
    }
    least = std::max(least, (points[i].value - missed - kept.back().value) / apart);
    most = std::min(most, (points[i].value + missed - kept.back().value) / apart);
  }
  kept.push_back(points.back());
  return kept;
}

double greatest_of(const std::vector<PropertyPoint>& points) {
  double greatest = 0.0;
  for (const PropertyPoint& point : points) greatest = std::max(greatest, std::abs(point.value));
  return greatest;
}

}  // namespace

std::vector<ReadCurve> property_curves(const ConcreteMaterials& materials, bool moves) {
  std::vector<ReadCurve> list;
  for (const BlockMaterial& material : materials.block_materials)
    if (moves || !material.name.empty()) add_material(material, moves, list);
  for (std::size_t i = 0; i + materials.bearing_interfaces < materials.contacts.size(); ++i)
    add_contact(materials.contacts[i], materials.interfaces[i], list);
  return list;
}

std::string properties_csv(const std::vector<ReadCurve>& properties, const Interval& run, PropertyRows rows) {
  std::string text = "property,unit,temperature_degC,value,ratio_to_20_degC\n";
  for (const ReadCurve& property : properties) {
    const Curve& curve = property.curve;
    const double reference = curve.holds(kReferenceTemperature) ? curve(kReferenceTemperature) : 0.0;
    std::vector<PropertyPoint> points = every_kelvin(curve, run);
    if (rows == PropertyRows::few) points = few_of(points, kMissed * greatest_of(points));
    for (const auto [T, value] : points) {
      const double ratio = reference != 0.0 ? value / reference : std::numeric_limits<double>::quiet_NaN();
      text += fmt::format("{},{},{:.12g},{:.12g},{:.12g}\n", property.path, property.unit, T, value, ratio);
    }
  }
  return text;
}

}  // namespace pyroclast
