#pragma once

#include <filesystem>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Point of a path along which a contact point is taken.
struct JumpPathPoint {
  double opening = 0.0, slip = 0.0;  ///< m
  double temperature = kReferenceTemperature;
};

/// Reads a path of jumps from a table whose columns are named among "u_n [um]", "u_s [um]" and "T [degC]", in
/// any order and unit; a quantity without a column stays at rest. Throws Error naming file and line when a
/// column is not known or stands twice, or a value does not convert.
/// \param temperature  temperature of a path without that column, °C
std::vector<JumpPathPoint> jump_path(const MeasuredTable& table, double temperature = kReferenceTemperature);
std::vector<JumpPathPoint> read_jump_path(const std::filesystem::path& file,
                                          double temperature = kReferenceTemperature);

}  // namespace pyroclast
