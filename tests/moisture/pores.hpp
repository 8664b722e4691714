#pragma once

#include <algorithm>

#include "pyroclast/moisture/moisture.hpp"

/// Materials with pores that the tests of this room share.
namespace pyroclast {

/// Factor between the entry pressure at 20 degC and that at 0 degC, from which designs may count it.
inline double from_0_degC() {
  return power(1.0 - 20.0 / water::kCritical, 1.26);
}

inline Curve permeability_growing(double exponent) {
  return Curve::function(
      "growing permeability",
      [exponent](double t) { return std::min(1e4, power(10.0, exponent * (t - 20.0))); }, {0.0, 1300.0},
      temperature_axis());
}

inline PoreMaterial high_strength() {
  PoreMaterial m;
  m.porosity = 0.12;
  m.permeability = 5e-20;
  m.permeability_ratio = permeability_growing(0.008);
  m.entry_pressure = 18.6e6 * from_0_degC();
  m.exponent = 2.27;
  m.cement = 415.0;
  return m;
}

/// Pores that hold hardly any liquid below saturation.
inline PoreMaterial dry_pores(double permeability) {
  PoreMaterial m;
  m.porosity = 0.12;
  m.permeability = permeability;
  m.entry_pressure = 1e-9;
  m.exponent = 2.27;
  return m;
}

}  // namespace pyroclast
