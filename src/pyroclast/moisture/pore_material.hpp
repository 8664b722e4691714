#pragma once

#include "pyroclast/material/curve.hpp"
#include "pyroclast/moisture/derivative.hpp"
#include "pyroclast/moisture/water.hpp"

namespace pyroclast {

/// Pores of a material and the water that they can hold.
struct PoreMaterial {
  double porosity = 0.0;      ///< share of the volume, 0 to 1
  double permeability = 0.0;  ///< intrinsic, at 20 degC, m2
  /// Permeability over that at 20 degC, over the highest temperature so far, degC.
  Curve permeability_ratio = Curve::constant(1.0);
  double entry_pressure = 0.0;  ///< a of van Genuchten's retention at 20 degC, Pa
  double exponent = 0.0;        ///< n of it, above 1
  double cement = 0.0;          ///< kg/m3; its hydrates give water back
  /// Storage beyond saturation, share of the liquid's density by pressure, 1/Pa: the pores' own compliance.
  double compliance = 1e-8;
  double tortuosity = 0.33;  ///< of the diffusion of vapour

  /// Returns the permeability of pores that have been this hot, m2.
  double permeability_at(double highest_temperature) const {
    return permeability * permeability_ratio(highest_temperature);
  }
  /// Throws Error naming the number that is out of range.
  void check() const;
};

/// Returns the water that hydrates have given back when they have been this hot, kg by kg of cement
/// (University of Glasgow, as Tenchev, Li and Purkiss 2001 have it).
double dehydrated(double highest_temperature);

/// What of a material's water follows from temperatures alone.
struct PoreConditions {
  PoreConditions(const PoreMaterial& material, double temperature, double highest_temperature);

  const PoreMaterial* material;
  double temperature;            ///< degC
  double saturation_pressure;    ///< Pa
  double liquid_density;         ///< kg/m3
  double entry_pressure;         ///< Pa: it falls with the surface tension
  double liquid_viscosity;       ///< Pa s
  double vapour_viscosity;       ///< Pa s
  double gas;                    ///< gas constant of vapour times the absolute temperature, J/kg
  double compressibility_slope;  ///< 1/Pa
  double permeability;           ///< m2
  double diffusion;              ///< diffusivity in open pores times pressure over `gas`, kg Pa/(m s Pa)
};

/// Water in pores at a pressure of vapour.
template <class Real>
struct PoreWater {
  Real content;          ///< liquid and vapour, kg by m3 of the material
  Real saturation;       ///< share of the pores that liquid fills
  Real liquid_pressure;  ///< Pa
  Real vapour_density;   ///< kg/m3
  Real liquid_mobility;  ///< relative permeability times density over viscosity, s/m2
  Real vapour_mobility;  ///< relative permeability over viscosity, 1/(Pa s); the density is left out
  Real diffusion;        ///< mass flow by diffusion for a pressure gradient of 1, kg/(m s Pa)
};

/// Returns the density of vapour at a pressure, Pa, kg/m3.
template <class Real>
Real vapour_density(const PoreConditions& at, const Real& pressure) {
  Real z = Real(1.0) - pressure * Real(at.compressibility_slope);
  if (value_of(z) < water::kLeastCompressibility) z = water::kLeastCompressibility;
  return pressure / (z * Real(at.gas));
}

/// Computes the water at a vapour pressure, Pa: liquid and vapour in equilibrium (Kelvin), van Genuchten's
/// retention (1980) with Mualem's (1976) relative permeability of the liquid and that of Parker, Lenhard and
/// Kuppusamy (1987) of the vapour. Real: double, or WithSlope for derivatives.
template <class Real>
PoreWater<Real> pore_water(const PoreConditions& at, const Real& pressure) {
  using pyroclast::log;
  using pyroclast::power;
  using std::sqrt;
  const PoreMaterial& m = *at.material;
  PoreWater<Real> w;
  w.vapour_density = vapour_density(at, pressure);
  if (value_of(pressure) >= at.saturation_pressure) {
    const Real beyond = pressure - Real(at.saturation_pressure);
    w.content = Real(m.porosity * at.liquid_density) * (Real(1.0) + Real(m.compliance) * beyond);
    w.saturation = 1.0;
    w.liquid_pressure = pressure;
    w.liquid_mobility = at.liquid_density / at.liquid_viscosity;
    w.vapour_mobility = 0.0;
    w.diffusion = 0.0;
    return w;
  }
  const double n = m.exponent;
  const Real suction = Real(-at.liquid_density * at.gas) * log(pressure / Real(at.saturation_pressure));
  const Real x = power(suction / Real(at.entry_pressure), n / (n - 1.0));
  const Real wet = Real(1.0) / (Real(1.0) + x), dry = x / (Real(1.0) + x);  // saturation^n and 1 less that
  w.saturation = power(wet, 1.0 / n);
  const Real gaseous = Real(1.0) - w.saturation;
  w.content = Real(m.porosity) * (Real(at.liquid_density) * w.saturation + gaseous * w.vapour_density);
  w.liquid_pressure = pressure - suction;
  const Real outer = power(dry, 1.0 / n), inner = Real(1.0) - outer;
  w.liquid_mobility = sqrt(w.saturation) * inner * inner * Real(at.liquid_density / at.liquid_viscosity);
  w.vapour_mobility = sqrt(gaseous) * outer * outer * Real(1.0 / at.vapour_viscosity);
  Real at_least = pressure;
  if (value_of(at_least) < water::kAtmosphere) at_least = water::kAtmosphere;
  w.diffusion = Real(at.diffusion) * gaseous / at_least;
  return w;
}

/// Returns the vapour pressure, Pa, at which pores are so full. saturation: above 0, at most 1.
double pressure_of_saturation(const PoreConditions& at, double saturation);

/// Function that computes water at a vapour pressure; its content rises with the pressure.
using WaterAt = PoreWater<WithSlope>(const PoreConditions& at, const WithSlope& pressure);

/// Returns the vapour pressure, Pa, at which the material holds so much water, kg/m3, above 0. The search
/// begins at `guess`; the content is met to rounding.
/// \param water_at  pore_water, or crack_water for a crack
double pressure_of_content(const PoreConditions& at, double content, double guess,
                           WaterAt* water_at = pore_water<WithSlope>);

}  // namespace pyroclast
