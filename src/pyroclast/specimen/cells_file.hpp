#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cells as a file holds them, in m: JSON with the lists `phases` (names), `vertices_m` ([x, y] each),
/// `cells` (the vertices around each, from 0) and `phase` (of each cell, from 0).
std::string cells_text(const Cells& cells);

/// What a file of this form says. The name of its list of vertices may have another unit: `vertices_mm`.
struct CellsFile {
  Cells cells;       ///< in `unit`
  std::string unit;  ///< of length, as it is written
};

/// Reads such a file; cells are turned counter-clockwise. Throws Error, with the file, for what is not of
/// this form, see also `checked`.
CellsFile read_cells(const std::filesystem::path& file);
/// The same from a text; `name` takes the file's place in messages.
CellsFile cells_from(const std::string& text, const std::string& name);

}  // namespace pyroclast::specimen
