#pragma once

#include "pyroclast/simulation/loop/stage.hpp"

namespace pyroclast {

/// Adds what a stage did to the water in the pores: largest pressures, and what left. Adds nothing where the
/// run has none, or the stage no rows.
void tell_water(const History& history, RowRange rows, StageReport& report);

}  // namespace pyroclast
