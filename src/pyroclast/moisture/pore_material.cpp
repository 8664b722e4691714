#include "pyroclast/moisture/pore_material.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/thermal/require.hpp"

namespace pyroclast {

namespace {

/// Returns the surface tension of water over that far from its critical point.
double surface_tension(double temperature) {
  return power(1.0 - std::min(temperature, water::kFrozen) / water::kCritical, 1.26);
}

double surface_tension_at_20_degC() {
  static const double value = surface_tension(kReferenceTemperature);
  return value;
}

}  // namespace

void PoreMaterial::check() const {
  const auto needed = [](bool allowed, const char* quantity, double value, const char* wanted) {
    require(allowed, "pores", quantity, value, wanted);
  };
  needed(porosity > 0.0 && porosity < 1.0, "porosity", porosity, "above 0 and below 1");
  needed(permeability > 0.0, "permeability", permeability, "above 0 m2");
  needed(entry_pressure > 0.0, "entry pressure", entry_pressure, "above 0 Pa");
  needed(exponent > 1.0, "exponent of the retention", exponent, "above 1");
  needed(cement >= 0.0, "cement", cement, "0 kg/m3 or more");
  needed(compliance > 0.0, "compliance", compliance, "above 0 1/Pa");
  needed(tortuosity >= 0.0 && tortuosity <= 1.0, "tortuosity", tortuosity, "between 0 and 1");
}

double dehydrated(double highest_temperature) {
  const double t = highest_temperature;
  return t < 200.0 ? 0.0 : t < 300.0 ? 7e-4 * (t - 200.0) : 0.07 + 4e-5 * (t - 300.0);
}

PoreConditions::PoreConditions(const PoreMaterial& its_material, double its_temperature,
                               double highest_temperature)
    : material(&its_material),
      temperature(its_temperature),
      saturation_pressure(water::saturation_pressure(temperature)),
      liquid_density(water::liquid_density(temperature)),
      entry_pressure(its_material.entry_pressure * surface_tension(temperature) /
                     surface_tension_at_20_degC()),
      liquid_viscosity(water::liquid_viscosity(temperature)),
      vapour_viscosity(water::vapour_viscosity(temperature)),
      gas(water::kGasConstant * (temperature + 273.15)),
      compressibility_slope(water::compressibility_slope(temperature)),
      permeability(its_material.permeability_at(highest_temperature)),
      diffusion(its_material.tortuosity * its_material.porosity *
                water::diffusivity_times_pressure(temperature) / gas) {}

double pressure_of_saturation(const PoreConditions& at, double saturation) {
  const double n = at.material->exponent;
  const double x = power(saturation, -n) - 1.0;
  const double suction = at.entry_pressure * power(x, (n - 1.0) / n);
  return at.saturation_pressure * exp(-suction / (at.liquid_density * at.gas));
}

double pressure_of_content(const PoreConditions& at, double content, double guess, WaterAt* water_at) {
  // Newton's method in ln p within a bracket, which it halves where a step leaves it: content rises with p.
  double low = -40.0, high = 40.0;  // ln of p over the saturation pressure
  double y = std::clamp(log(guess / at.saturation_pressure), low, high);
  double best = y, least = -1.0;
  for (int trial = 0; trial < 200 && low < high; ++trial) {
    const double p = at.saturation_pressure * exp(y);
    const WithSlope found = water_at(at, WithSlope(p, p)).content;
    const double off = found.value - content;
    if (least < 0.0 || std::abs(off) < least) {
      least = std::abs(off);
      best = y;
    }
    if (off == 0.0) break;
    (off > 0.0 ? high : low) = y;
    double next = y - off / found.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == y || next == low || next == high) break;
    y = next;
  }
  return at.saturation_pressure * exp(best);
}

}  // namespace pyroclast
