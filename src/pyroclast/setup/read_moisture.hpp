#pragma once

#include <optional>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/acting/heat_conditions.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Reads [moisture], and the pores of the phases in [materials] (docs/understand/moisture.md); empty if the
/// deck has no [moisture]. Errors are recorded in the deck.
/// \param heat         statements on heat, which drives the water
/// \param moves        true where a stage moves the body
/// \param time_curves  reader of curves of the time from the start of heating
/// \param curves       reader of curves of the temperature
std::optional<MoistureConditions> read_moisture(const Section& root,
                                                const specimen::SpecimenParameters& specimen,
                                                const DeckSpace& space, const HeatConditions& heat,
                                                bool moves, CurveReader& time_curves, CurveReader& curves);

/// Warns where the specific heat of a phase with the concrete's pores has no peak, so that water evaporates
/// without heat.
void warn_of_free_evaporation(const Section& root, const MoistureConditions& moisture,
                              const std::vector<BlockMaterial>& block_materials);

}  // namespace pyroclast
