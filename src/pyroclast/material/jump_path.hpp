#pragma once

#include <filesystem>
#include <istream>
#include <vector>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Where a contact point is to go.
struct JumpPathPoint {
  double opening = 0.0, slip = 0.0;  ///< m
  double temperature = kReferenceTemperature;
};

/// A path of jumps from a CSV file whose header names columns with their units, among "u_n [um]", "u_s [um]"
/// and "T [degC]", in any order; what has no column stays at rest. Lines that are blank or begin with # are
/// skipped. Throws Error naming file and line when the file cannot be read, a column is not known or stands
/// twice, or a value does not convert.
std::vector<JumpPathPoint> read_jump_path(const std::filesystem::path& file);
/// The same from a stream; `file` names it in messages.
std::vector<JumpPathPoint> read_jump_path(std::istream& stream, const std::filesystem::path& file);

}  // namespace pyroclast
