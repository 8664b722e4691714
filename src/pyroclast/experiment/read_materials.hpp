#pragma once

#include <array>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"

namespace pyroclast {

/// Reads [materials]: aggregate, mortar, platen, and how their `expansion` is meant. `curves` must be of the
/// temperature. Errors are recorded in the deck.
std::array<SolidMaterial, 3> read_solids(const Section& root, CurveReader& curves);

/// Reads [contacts]. A property of mortar_mortar that is a plain constant follows its `temperature_ratio`.
ContactParameters read_contacts(const Section& root, CurveReader& curves);

}  // namespace pyroclast
