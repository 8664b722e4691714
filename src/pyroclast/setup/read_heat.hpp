#pragma once

#include <optional>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"

namespace pyroclast {

/// Reads [heat] (docs/understand/heat.md); empty if the deck has none. Errors are recorded in the deck.
/// \param time_curves  reader of curves of the time from the start of heating
std::optional<HeatConditions> read_heat(const Section& root, CurveReader& time_curves,
                                        const DeckSpace& space);

/// Reads [heat.cracks]; empty if the deck has none. Errors are recorded in the deck.
/// \param curves  reader of curves of the temperature
std::optional<CrackHeat> read_crack_heat(const Section& root, CurveReader& curves);

}  // namespace pyroclast
