#pragma once

#include <functional>
#include <map>
#include <string>

#include "pyroclast/simulation/acting/loads.hpp"
#include "pyroclast/stages/drive_keys.hpp"

namespace pyroclast {

/// Difference below which directions of forces are parallel or at right angles.
inline constexpr double kParallel = 1e-9;

using LoadsBySet = std::map<std::string, SetLoad>;
/// Function that returns the load of a set when the stage began.
using LoadBefore = std::function<SetLoad(const std::string& set)>;

/// Returns the velocity or load of an action at a time of the stage, without the load from before the stage.
/// A controlled force is added to all of that load.
/// \param time         time since the stage began, s
/// \param load_factor  factor of the forces in a stage with a control
double part_of(const DriveKeys& keys, const DriveAction& action, double time, double load_factor);

/// Returns the loads of the sets that the stage loads: all that it states for a set adds up. A load from
/// before ends along the directions that are stated, evenly over the longest of their ramps, and stays across
/// them.
LoadsBySet loads_at(const DriveKeys& keys, double time, double load_factor, const LoadBefore& before);

}  // namespace pyroclast
