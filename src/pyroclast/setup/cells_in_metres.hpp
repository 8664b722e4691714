#pragma once

#include <filesystem>
#include <string_view>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Reads a file of cells (`specimen::read_cells`) whose list of vertices states its unit. Throws Error, with
/// the file, also for a unit that is not one of length.
/// \param join  distance below which vertices are joined, m (`specimen::joined`); 0: none
/// \return the cells in m
specimen::GivenCells<2> cells_in_metres(const std::filesystem::path& file, double join = 0.0);

/// Returns the metres of a unit of length, such as "mm". Throws Error, with the unit, for another unit.
double metres_of(std::string_view unit);

}  // namespace pyroclast
