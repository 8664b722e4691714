#pragma once

#include "pyroclast/material/curve.hpp"
#include "pyroclast/thermal/boundary_condition.hpp"

namespace pyroclast {

/// What is left of a contact for heat.
struct ContactGap {
  double damage = 0.0;   ///< share of its solid bridges that is lost, 0 to 1
  double opening = 0.0;  ///< between its faces, m; not negative
};

/// How heat crosses contacts that are damaged and open. Three ways stand side by side: solid bridges, of
/// which damage leaves a share (as in Özdemir, Brekelmans and Geers 2010); the gas between the faces, with
/// the jumps of temperature at its molecules' last collisions (Kennard 1938); and radiation between two grey
/// parallel faces.
struct GapHeat {
  double bridges = 0.0;        ///< conductance of an intact contact, W/(m² K)
  Curve gas_conductivity;      ///< W/(m K), of the temperature
  double jump_distance = 0.0;  ///< by which the gas seems wider than the opening, m, greater than 0
  double emissivity = 0.0;     ///< of each face, 0 to 1
  /// A contact below this conductance parts the temperatures of its two sides, W/(m² K); above twice that it
  /// joins them again.
  double split_below = 0.0;

  /// Emissivity that acts between two parallel faces, 1 / (2 / epsilon - 1).
  double mutual_emissivity() const { return 1.0 / (2.0 / emissivity - 1.0); }

  /// Heat flux over the difference of two temperatures, °C, between which it flows, W/(m² K). Exact for
  /// radiation, whatever the difference.
  /// \param gas  conductivity of the gas at the mean of both, W/(m K)
  double conductance(const ContactGap& gap, double gas, double a, double b) const {
    const double absolute_a = a - absolute_zero, absolute_b = b - absolute_zero;
    const double radiation = mutual_emissivity() * stefan_boltzmann *
                             (absolute_a * absolute_a + absolute_b * absolute_b) * (absolute_a + absolute_b);
    return (1.0 - gap.damage) * bridges + gas / (gap.opening + jump_distance) + radiation;
  }
  /// Bound of how fast the flux grows with either temperature, W/(m² K).
  /// \param gas      greatest conductivity of the gas, W/(m K)
  /// \param hottest  of both faces, °C
  double steepest(const ContactGap& gap, double gas, double hottest) const {
    const double absolute = hottest - absolute_zero;
    return (1.0 - gap.damage) * bridges + gas / (gap.opening + jump_distance) +
           4.0 * mutual_emissivity() * stefan_boltzmann * absolute * absolute * absolute;
  }
};

}  // namespace pyroclast
