#pragma once

#include <string_view>

#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// The unit of a kind that a text most likely means and does not spell: "W/(m K)" for "W/m·K", "MPa" for
/// "Mpa", "kgf/cm2" for "kp/cm2". Empty where none is near.
std::string_view meant_spelling(std::string_view given, const Unit& unit);

}  // namespace pyroclast
