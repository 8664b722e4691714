#pragma once

#include <variant>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Heat that flows into the body through a face, as functions of the time in s. A face without any condition
/// is adiabatic; several conditions on one face act together, as convection and radiation do in a fire.

/// Given flux.
struct HeatFlux {
  Curve flux;  ///< W/m², into the body
};

/// Convection h_c (T_f - T), paper Eq. (2).
struct Convection {
  Curve coefficient;      ///< h_c, W/(m² K), not negative
  Curve gas_temperature;  ///< T_f, °C
};

/// Radiation epsilon sigma (T_f^4 - T^4) with absolute temperatures.
struct Radiation {
  Curve emissivity;       ///< resultant emissivity of face and surroundings, 0 to 1
  Curve gas_temperature;  ///< temperature of the surroundings, °C
};

using BoundaryCondition = std::variant<HeatFlux, Convection, Radiation>;

inline constexpr double stefan_boltzmann = 5.670374419e-8;  ///< W/(m² K⁴), CODATA 2018

}  // namespace pyroclast
