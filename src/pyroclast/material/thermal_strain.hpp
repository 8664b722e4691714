#pragma once

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Reading of a thermal expansion coefficient alpha(T). The paper's Eq. (18) is read as secant.
enum class ExpansionReading {
  secant,  ///< strain since 20 °C over the temperature rise: strain = alpha(T) (T - 20 °C)
  tangent  ///< strain per kelvin at T: strain = integral of alpha from 20 °C to T
};

/// Returns the free thermal strain since 20 °C, as a function of the temperature, °C. Throws Error when the
/// two intervals have no part in common, or when the tangent reading cannot start from 20 °C.
///
/// \param expansion     alpha, 1/K; may be negative
/// \param temperatures  finite interval on which the strain is wanted; the result holds where `expansion` is
///                      defined too
Curve free_thermal_strain(const Curve& expansion, ExpansionReading reading, Interval temperatures);

/// Strain that quartz adds to the free strain of rock where it turns from its alpha into its beta form, at
/// 573 °C.
struct QuartzStep {
  double strain = 0.0;  ///< strain in every direction
  /// Interval of the step, °C; the strain is a cubic without slope at both ends.
  Interval over{550.0, 600.0};
};

/// Returns a free thermal strain with the step added.
/// \param temperatures  finite interval on which the strain is wanted, °C
Curve with_quartz_step(const Curve& strain, const QuartzStep& step, Interval temperatures);

}  // namespace pyroclast
