#pragma once

#include "pyroclast/material/curve.hpp"
#include "pyroclast/thermal/boundary_condition.hpp"

namespace pyroclast {

/// State of a contact for heat.
struct ContactGap {
  double damage = 0.0;   ///< share of the contact's solid bridges that is lost, 0 to 1
  double opening = 0.0;  ///< opening between the faces, m; not negative
};

/// Heat flow through contacts that are damaged and open. Three ways act side by side: solid bridges, of which
/// damage leaves a share (as in Özdemir, Brekelmans and Geers 2010); the gas between the faces, with the
/// jumps of temperature at its molecules' last collisions (Kennard 1938); and radiation between two grey
/// parallel faces.
struct GapHeat {
  double bridges = 0.0;    ///< conductance of an intact contact, W/(m² K)
  Curve gas_conductivity;  ///< conductivity of the gas, W/(m K), over the temperature
  double jump_distance = 0.0;  ///< m by which the gas seems wider than the opening; greater than 0
  double emissivity = 0.0;  ///< emissivity of each face, 0 to 1
  /// Conductance below which a contact parts the temperatures of its two sides, W/(m² K); above twice this
  /// value it joins them again.
  double split_below = 0.0;

  /// Returns the emissivity that acts between two parallel faces, 1 / (2 / epsilon - 1).
  double mutual_emissivity() const { return 1.0 / (2.0 / emissivity - 1.0); }

  /// Returns the heat flux over the difference of the two temperatures between which it flows, W/(m² K); the
  /// temperatures are in °C. Exact for radiation, whatever the difference.
  /// \param gas  conductivity of the gas at the mean of both, W/(m K)
  double conductance(const ContactGap& gap, double gas, double a, double b) const {
    const double absolute_a = a - absolute_zero, absolute_b = b - absolute_zero;
    const double radiation = mutual_emissivity() * stefan_boltzmann *
                             (absolute_a * absolute_a + absolute_b * absolute_b) * (absolute_a + absolute_b);
    return (1.0 - gap.damage) * bridges + gas / (gap.opening + jump_distance) + radiation;
  }
  /// Returns a bound of how fast the flux grows with either temperature, W/(m² K).
  /// \param gas      greatest conductivity of the gas, W/(m K)
  /// \param hottest  bound of the temperature of both faces, °C
  double steepest(const ContactGap& gap, double gas, double hottest) const {
    const double absolute = hottest - absolute_zero;
    return (1.0 - gap.damage) * bridges + gas / (gap.opening + jump_distance) +
           4.0 * mutual_emissivity() * stefan_boltzmann * absolute * absolute * absolute;
  }
};

}  // namespace pyroclast
