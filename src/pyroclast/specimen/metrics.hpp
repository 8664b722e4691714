#pragma once

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Measures edges, zones and sizes of the blocks; leaves the counts of regularisation at zero.
BlockMetrics measure(const Tessellation& tessellation);

}  // namespace pyroclast::specimen
