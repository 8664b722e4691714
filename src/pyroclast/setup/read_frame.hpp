#pragma once

#include <filesystem>

#include "pyroclast/simulation/stress_free.hpp"

namespace pyroclast {

/// Array of a frame with the temperature of each gridpoint, below /VTKHDF.
inline constexpr const char* kFrameTemperature = "PointData/temperature [degC]";

/// Reads the temperatures at the gridpoints of the specimen, without bearings, from a frame `blocks_<k>.hdf`
/// of a run's fields and the `mesh.h5` beside it. Throws Error where the file is no frame, its mesh is
/// missing, or its body is of another dimension. \param dimension  dimension of the body that takes the
/// temperatures, 2 or 3
StressFree read_frame_temperatures(const std::filesystem::path& frame, int dimension);

}  // namespace pyroclast
