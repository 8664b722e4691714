#pragma once

#include <vector>

#include "pyroclast/results/text_file.hpp"

namespace pyroclast::app {

/// Description of the option `--overwrite` of commands that write decks.
inline constexpr const char* kOverwriteDecks = "Replace the files of an earlier call";

/// Writes decks and studies, all or none, and prints their names. Throws Error where a file exists.
/// \param overwrite  true to replace files that begin as those of an earlier call do: with the same line
void write_decks(const std::vector<TextFile>& files, bool overwrite);

}  // namespace pyroclast::app
