#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <variant>

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

/// Says, for messages, how blocks in space come.
inline constexpr const char* kInSpace =
    "Blocks in space come by [specimen] shape = \"polyhedra\" and file, which is JSON with their faces (see "
    "docs/do/bodies.md, Blocks made elsewhere)";

/// Function from a unit of length to one that turns numbers of it into m. Throws Error for another unit.
using ToMetres = std::function<std::function<double(double)>(const std::string& unit)>;

/// Cells of a file, in the plane or in space.
using FileOfCells = std::variant<GivenCells<2>, GivenCells<3>>;

/// Reads a file of cells and completes them. The names of its lists of vertices and sizes may have another
/// unit, such as `vertices_mm`. Throws Error, with the file, for a text of another form, and as `completed`.
/// \param to_metres  empty: m is the only unit
/// \param join       distance below which vertices are joined, m; 0: none
FileOfCells read_cells(const std::filesystem::path& file, const ToMetres& to_metres = {}, double join = 0.0);
/// Reads cells from a text; `name` takes the file's place in messages; it may be empty.
FileOfCells cells_from(const std::string& text, const std::string& name, const ToMetres& to_metres = {},
                       double join = 0.0);

}  // namespace pyroclast::specimen
