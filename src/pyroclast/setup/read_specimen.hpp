#pragma once

#include <filesystem>
#include <span>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_bearings.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Reads [specimen], [aggregates], [blocks] and [superposition], but for the thickness. What is wrong is
/// recorded in the deck.
/// \param folder    from which a relative name of a tessellation's file is taken
/// \param bearings  that lie on the specimen
specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder,
                                           std::span<const ReadBearing> bearings = {});

}  // namespace pyroclast
