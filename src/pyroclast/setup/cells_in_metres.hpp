#pragma once

#include <filesystem>
#include <string_view>

#include "pyroclast/specimen/cells_file.hpp"

namespace pyroclast {

/// Reads a file of cells whose lists state their unit, see specimen::read_cells.
specimen::FileOfCells cells_in_metres(const std::filesystem::path& file, double join = 0.0);

/// Returns the metres of a unit of length, such as "mm". Throws Error, with the unit, for another unit.
double metres_of(std::string_view unit);

}  // namespace pyroclast
