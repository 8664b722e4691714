#pragma once

#include <filesystem>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Reads [specimen], [aggregates], [blocks] and [superposition], but for the thickness. What is wrong is
/// recorded in the deck. \param folder  from which a relative name of a tessellation's file is taken
specimen::SpecimenParameters read_specimen(const Section& root, const std::filesystem::path& folder);

}  // namespace pyroclast
