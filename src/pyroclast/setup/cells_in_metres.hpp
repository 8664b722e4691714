#pragma once

#include <filesystem>
#include <string_view>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Reads a file of cells (`specimen::read_cells`) whose list of vertices says its unit.
/// \param join  joins vertices nearer to each other than this, m (`specimen::joined`); 0: none
/// \return in m
/// Throws Error, with the file, also for a unit that is not one of length.
specimen::Cells cells_in_metres(const std::filesystem::path& file, double join = 0.0);

/// Metres of a unit of length, such as "mm". Throws Error, with the unit, for another one.
double metres_of(std::string_view unit);

}  // namespace pyroclast
