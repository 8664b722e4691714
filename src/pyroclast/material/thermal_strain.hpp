#pragma once

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// What a thermal expansion coefficient alpha(T) says. The paper's Eq. (18) is read as secant.
enum class ExpansionReading {
  secant,  ///< strain since 20 °C over the temperature rise: strain = alpha(T) (T - 20 °C)
  tangent  ///< strain per kelvin at T: strain = integral of alpha from 20 °C to T
};

/// Free thermal strain since 20 °C, as a function of the temperature, °C.
///
/// \param expansion     alpha, 1/K; may be negative
/// \param temperatures  finite interval on which the strain is wanted; the result holds where `expansion` is
/// defined
///                      too
///
/// Throws Error when the two have no interval in common, or the tangent reading cannot start from 20 °C.
Curve free_thermal_strain(const Curve& expansion, ExpansionReading reading, Interval temperatures);

/// What quartz adds to the free strain of rock where it turns from its alpha into its beta form, at 573 °C.
struct QuartzStep {
  double strain = 0.0;          ///< in every direction
  Interval over{550.0, 600.0};  ///< on which it comes, as a cubic that begins and ends without slope, °C
};

/// A free thermal strain with the step.
/// \param temperatures  finite interval on which it is wanted, °C
Curve with_quartz_step(const Curve& strain, const QuartzStep& step, Interval temperatures);

}  // namespace pyroclast
