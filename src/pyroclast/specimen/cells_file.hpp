#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cells as a file holds them: JSON with the lists `phases` (names), `vertices_m` ([x, y] each), `cells` (the
/// vertices around each, from 0) and `phase` (of each cell, from 0).
std::string cells_text(const Cells& cells);

/// Reads such a file; cells are turned counter-clockwise. Throws Error, with the file, for what is not of
/// this form, see also `checked`.
Cells read_cells(const std::filesystem::path& file);
/// The same from a text; `name` takes the file's place in messages.
Cells cells_from(const std::string& text, const std::string& name);

}  // namespace pyroclast::specimen
