#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Writes cells, in m, as a file holds them: JSON with the lists `phases` (names), `vertices_m` ([x, y]
/// each), `cells` (the vertices around each, from 0) and `phase` (of each cell, from 0).
std::string cells_text(const Cells& cells);

/// Content of a file of cells. The name of its list of vertices may have another unit: `vertices_mm`.
struct CellsFile {
  Cells cells;       ///< cells in `unit`
  std::string unit;  ///< unit of length, as it is written
};

/// Reads a file of cells and turns the cells counter-clockwise. Throws Error, with the file, for a text of
/// another form, see also `checked`.
CellsFile read_cells(const std::filesystem::path& file);
/// Reads cells from a text; `name` takes the file's place in messages.
CellsFile cells_from(const std::string& text, const std::string& name);

}  // namespace pyroclast::specimen
