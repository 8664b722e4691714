#pragma once

#include "pyroclast/base/lanes.hpp"
#include "pyroclast/base/log.hpp"

/// Properties of water and its vapour. Temperatures in degC.
namespace pyroclast::water {

inline constexpr double kGasConstant = 8.314462 / 0.018015;  ///< of water vapour, J/(kg K)
inline constexpr double kCritical = 374.14;                  ///< degC
/// Temperature from which the saturation pressure and the capillary pressure stay as they are, degC: nearer
/// to the critical point liquid and vapour can hardly be told apart.
inline constexpr double kFrozen = 370.0;
inline constexpr double kAtmosphere = 101325.0;  ///< Pa

/// Returns the pressure of vapour above water, Pa (Hyland and Wexler 1983).
inline double saturation_pressure(double temperature) {
  const double t = smaller(temperature, kFrozen) + 273.15;
  return exp(-5800.2206 / t + 1.3914993 - 0.048640239 * t + 4.1764768e-5 * t * t - 1.4452093e-8 * t * t * t +
             6.5459673 * log(t));
}

/// Returns the density of liquid water at its saturation pressure, kg/m3: a fit, within 3.5 % of steam tables
/// up to 300 degC.
inline double liquid_density(double temperature) {
  const double t = larger(0.0, smaller(temperature, 373.0)) / kCritical;
  return 314.4 + 685.6 * power(1.0 - power(t, 1.0 / 0.55), 0.55);
}

/// Returns the viscosity of liquid water, Pa s (Thomas and Sansom 1995, as Gawin, Majorana and
/// Schrefler 1999 have it).
inline double liquid_viscosity(double temperature) {
  return 0.6612 * power(larger(temperature + 273.15, 274.0) - 229.0, -1.562);
}

/// Returns the viscosity of vapour, Pa s (Gawin, Majorana and Schrefler 1999).
inline double vapour_viscosity(double temperature) {
  return 8.85e-6 + 3.53e-8 * temperature;
}

/// Returns by what share of an ideal gas' compressibility that of vapour falls with its pressure, 1/Pa:
/// Z = 1 - p times this, at least kLeastCompressibility. On the saturation line the density is within 4 % of
/// steam tables up to 300 degC.
inline double compressibility_slope(double temperature) {
  const double t = 473.15 / (temperature + 273.15);
  return 0.055e-6 * t * t * t;
}
inline constexpr double kLeastCompressibility = 0.6;

/// Returns the diffusivity of vapour in air times the pressure, m2/s Pa (Tenchev, Li and Purkiss 2001).
inline double diffusivity_times_pressure(double temperature) {
  return 1.87e-5 * power(temperature + 273.15, 2.072);
}

}  // namespace pyroclast::water
