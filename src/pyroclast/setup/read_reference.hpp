#pragma once

#include <filesystem>

#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// Reads which curves the figures draw beside the results: a built-in reference, or a CSV file of the user's.
/// The run itself has no use for it; figures take it from the deck that the run keeps. A wrong name, and a
/// file that figures could not draw, are errors of the deck. \param output  the table [output] \param folder
/// from which a relative file name is taken
void read_reference(const Section& output, const std::filesystem::path& folder);

}  // namespace pyroclast
