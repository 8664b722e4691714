#pragma once

#include <array>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/material/thermal_strain.hpp"

namespace pyroclast {

/// Reads how [materials] means its `expansion`.
ExpansionReading read_expansion_reading(const Section& root);

/// Reads [materials]: aggregate, mortar, platen. `curves` must be of the temperature. Errors are recorded in
/// the deck.
std::array<SolidMaterial, 3> read_solids(const Section& root, ExpansionReading reading, CurveReader& curves);

/// The same for heat conduction alone: of aggregate and mortar only density, conductivity and specific heat;
/// other properties have no effect.
std::array<SolidMaterial, 3> read_conducting_solids(const Section& root, CurveReader& curves);

/// Reads [contacts]. A property of mortar_mortar that is a plain constant follows its `temperature_ratio`.
ContactParameters read_contacts(const Section& root, CurveReader& curves);

}  // namespace pyroclast
