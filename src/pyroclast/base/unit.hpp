#pragma once

#include <string_view>

namespace pyroclast {

/// Kind of physical quantity, given by the unit in which the program computes with it.
struct Unit {
  const char* si;       ///< the unit of the value inside, in the notation of UDUNITS-2
  const char* name;     ///< name of the quantity in messages
  const char* example;  ///< a quantity of this kind as a user would write it

  /// Tells whether the values of both kinds are in the same unit.
  friend constexpr bool operator==(const Unit& a, const Unit& b) { return std::string_view(a.si) == b.si; }
};

/// Kinds of quantity that decks hold. Values are SI, except that a temperature is in °C.
namespace unit {
inline constexpr Unit dimensionless{"1", "dimensionless number", "31 %"};
inline constexpr Unit length{"m", "length", "150 mm"};
inline constexpr Unit area{"m2", "area", "450 cm2"};
inline constexpr Unit area_rate{"m2/s", "rate of an area", "5 cm2/s"};
inline constexpr Unit angle{"rad", "angle", "34 deg"};
inline constexpr Unit time{"s", "time", "90 min"};
inline constexpr Unit frequency{"1/s", "frequency", "10 1/s"};
inline constexpr Unit velocity{"m/s", "velocity", "0.8 mm/s"};
inline constexpr Unit acceleration{"m/s2", "acceleration", "9.81 m/s2"};
inline constexpr Unit density{"kg/m3", "density", "2650 kg/m3"};
inline constexpr Unit force{"N", "force", "120 kN"};
inline constexpr Unit force_rate{"N/s", "rate of a force", "2 kN/s"};
inline constexpr Unit stress{"Pa", "stress", "30 MPa"};
inline constexpr Unit stress_rate{"Pa/s", "rate of a stress", "0.5 MPa/s"};
inline constexpr Unit energy{"J", "energy", "5 J"};
inline constexpr Unit stiffness{"N/m", "stiffness", "2 GN/m"};
/// Stiffness of a contact per unit of its area.
inline constexpr Unit stiffness_per_area{"Pa/m", "contact stiffness", "18400 GPa/m"};
inline constexpr Unit fracture_energy{"J/m2", "fracture energy", "40 N/m"};
/// Temperature, in °C.
inline constexpr Unit temperature{"degC", "temperature", "20 degC"};
/// Difference of two temperatures, in K; a quantity in degC is refused here, because it is a temperature.
inline constexpr Unit temperature_difference{"K", "temperature difference", "5 K"};
inline constexpr Unit heating_rate{"K/s", "heating rate", "5 K/min"};
inline constexpr Unit conductivity{"W/m/K", "thermal conductivity", "1.6 W/m/K"};
inline constexpr Unit specific_heat{"J/kg/K", "specific heat", "900 J/kg/K"};
inline constexpr Unit heat_transfer{"W/m2/K", "heat transfer coefficient", "25 W/m2/K"};
inline constexpr Unit heat_flux{"W/m2", "heat flux", "15 kW/m2"};
inline constexpr Unit expansion{"1/K", "thermal expansion coefficient", "1e-5 1/K"};

inline constexpr const Unit* all[] = {&dimensionless,
                                      &length,
                                      &area,
                                      &area_rate,
                                      &angle,
                                      &time,
                                      &frequency,
                                      &velocity,
                                      &acceleration,
                                      &density,
                                      &force,
                                      &force_rate,
                                      &stress,
                                      &stress_rate,
                                      &energy,
                                      &stiffness,
                                      &stiffness_per_area,
                                      &fracture_energy,
                                      &temperature,
                                      &temperature_difference,
                                      &heating_rate,
                                      &conductivity,
                                      &specific_heat,
                                      &heat_transfer,
                                      &heat_flux,
                                      &expansion};
}  // namespace unit

}  // namespace pyroclast
