#pragma once

#include <filesystem>
#include <span>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_bearings.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Reads [specimen], [aggregates], [blocks] and [superposition], without the thickness. Errors are recorded
/// in the deck.
/// \param folder    folder to which the name of a tessellation's file is relative
/// \param sets      sets of the deck, near which blocks may be finer
/// \param bearings  bearings on the specimen
/// \param space     space in which the deck describes it
specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder,
                                           const DeckSpace& space, std::span<const SetParameters> sets = {},
                                           std::span<const ReadBearing> bearings = {});

}  // namespace pyroclast
