#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Writes a specimen as a file holds it: JSON with the lists `phases` (names), `vertices_m` ([x, y] each, in
/// space [x, y, z]), `cells` (the vertices around each, from 0) and `phase` (of each cell, from 0). In space
/// `cells` has the faces of each, the list `faces` the vertices around each, and the table `body` has `axis`
/// ("y" or "z"), `length_m` along it, `section_m` (the corners of its section, counter-clockwise) and `sides`
/// (their names from each corner on, or one name of a round section). The list `block_size_m` has the size
/// that each block was to have, where they are not alike. The list `stone` has the number of the stone of
/// each block, from 0, and -1 where it is of none. Stretches of sides are no part of it.
template <int Dim>
std::string cells_text(const Specimen<Dim>& specimen);

/// Content of a file of cells. The name of its list of vertices may have another unit: `vertices_mm`.
struct CellsFile {
  GivenCells<2> cells;  ///< cells in `unit`
  std::string unit;     ///< unit of length, as it is written
};

/// Reads a file of cells and turns the cells counter-clockwise. Throws Error, with the file, for a text of
/// another form, see also `checked`.
CellsFile read_cells(const std::filesystem::path& file);
/// Reads cells from a text; `name` takes the file's place in messages.
CellsFile cells_from(const std::string& text, const std::string& name);

}  // namespace pyroclast::specimen
