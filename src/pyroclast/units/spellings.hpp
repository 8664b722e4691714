#pragma once

#include <string_view>

#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// Returns the unit that a text most likely means but does not spell: "W/(m K)" for "W/m·K", "MPa" for "Mpa",
/// "kgf/cm2" for "kp/cm2". Empty where no unit is near.
std::string_view meant_spelling(std::string_view given, const Unit& unit);

}  // namespace pyroclast
