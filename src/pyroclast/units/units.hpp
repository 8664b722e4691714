#pragma once

#include <string>
#include <string_view>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// A kind of physical quantity, by the unit in which the program computes with it.
struct Unit {
  const char* si;       ///< the unit of the value inside, in the notation of UDUNITS-2
  const char* name;     ///< what the quantity is called in messages
  const char* example;  ///< a quantity of this kind as a user would write it
};

/// The kinds of quantity that decks hold. Values are SI, except that a temperature is in °C.
namespace unit {
inline constexpr Unit dimensionless{"1", "dimensionless number", "31 %"};
inline constexpr Unit length{"m", "length", "150 mm"};
inline constexpr Unit area{"m2", "area", "450 cm2"};
inline constexpr Unit angle{"rad", "angle", "34 deg"};
inline constexpr Unit time{"s", "time", "90 min"};
inline constexpr Unit frequency{"1/s", "frequency", "10 1/s"};
inline constexpr Unit velocity{"m/s", "velocity", "0.8 mm/s"};
inline constexpr Unit acceleration{"m/s2", "acceleration", "9.81 m/s2"};
inline constexpr Unit density{"kg/m3", "density", "2650 kg/m3"};
inline constexpr Unit force{"N", "force", "120 kN"};
inline constexpr Unit stress{"Pa", "stress", "30 MPa"};
/// Stiffness of a contact per unit of its area.
inline constexpr Unit stiffness_per_area{"Pa/m", "contact stiffness", "18400 GPa/m"};
inline constexpr Unit fracture_energy{"J/m2", "fracture energy", "40 N/m"};
/// A temperature, in °C.
inline constexpr Unit temperature{"degC", "temperature", "20 degC"};
/// A difference of two temperatures, in K; a quantity in degC is refused here, because it is a temperature.
inline constexpr Unit temperature_difference{"K", "temperature difference", "5 K"};
inline constexpr Unit heating_rate{"K/s", "heating rate", "5 K/min"};
inline constexpr Unit conductivity{"W/m/K", "thermal conductivity", "1.6 W/m/K"};
inline constexpr Unit specific_heat{"J/kg/K", "specific heat", "900 J/kg/K"};
inline constexpr Unit heat_transfer{"W/m2/K", "heat transfer coefficient", "25 W/m2/K"};
inline constexpr Unit heat_flux{"W/m2", "heat flux", "15 kW/m2"};
inline constexpr Unit expansion{"1/K", "thermal expansion coefficient", "1e-5 1/K"};
}  // namespace unit

/// A text that is not a quantity of the kind asked for. `what()` is the text in quotes and the reason.
class QuantityError : public Error {
 public:
  enum class Kind { no_number, not_finite, no_unit, unknown_unit, wrong_dimension };

  QuantityError(Kind kind, std::string_view text, const std::string& reason);

  Kind kind() const { return kind_; }
  /// What is wrong and what is allowed, without the text itself.
  const std::string& reason() const { return reason_; }

 private:
  Kind kind_;
  std::string reason_;
};

/// The value of a quantity such as "18400 GPa/m", "20 degC" or "25 W/m²/K", in `unit.si`.
///
/// The number is written with a decimal point whatever the locale. The unit is anything UDUNITS-2 knows, as
/// well as "deg" for an angle; a dimensionless quantity may go without. "/" divides by the one unit that
/// follows, and by a unit set right behind its exponent: "W/m2/K", "W/(m2 K)" and "W/m²K" are a heat transfer
/// coefficient, "W/m2 K" is not. What UDUNITS-2 would take but nobody means is refused: numbers inside a unit
/// ("18 400 GPa/m"), a unit for its reciprocal ("4 s" for a frequency), radians for a plain number. Safe to
/// call from several threads.
///
/// @throws QuantityError if the text has no number, a number that is not finite, no unit, a unit that is not
///         known, or a unit of another dimension.
/// @throws Error if the unit database cannot be read.
double parse_quantity(std::string_view text, const Unit& unit);

/// What a quantity of this kind must look like, for messages: 'a unit of length (m) is needed, e.g. "150
/// mm"'.
std::string requirement(const Unit& unit);

}  // namespace pyroclast
