#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// Returns the unit that a text most likely means but does not spell: "W/(m K)" for "W/m·K", "MPa" for "Mpa",
/// "kgf/cm2" for "kp/cm2". Empty where no unit is near.
std::string_view meant_spelling(std::string_view given, const Unit& unit);

/// Returns the unit of a share that a text such as "‰", "microstrain" or "Vol.-%" means: "%", "mm/m" or
/// "um/m". Empty for another text.
std::string_view share_unit(std::string_view text);

/// Returns the units that people write for a kind.
std::vector<std::string_view> usual_units(const Unit& unit);

/// Returns all texts that people write for units of this program, those among them that it refuses too.
std::vector<std::string> unit_spellings();

}  // namespace pyroclast
