#pragma once

#include <string>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/drive_loads.hpp"

namespace pyroclast {

/// Throws Error where a body, or the supports and loads on it, do not allow the actions of a drive. Changes
/// the supports and loads to those that the drive leaves, see Stage::check.
void check_actions(const DriveKeys& keys, const Simulation& simulation, Acting& acting);

/// Throws Error where a drive would act on a set that another one, which is under way, keeps moving or
/// loading.
/// \param supports  supports with those of the new drive
void check_actions_beside(const DriveKeys& keys, const DriveKeys& under_way, const Model& model,
                          const Supports& supports);

/// Returns the motion of a set that an action holds or moves.
HeldMotion motion_of(const DriveAction& action);

/// Returns a load that acted before supports took hold, without the parts that they bear from now on: a
/// pressure whose faces are all held along their normals, and a force along the components along which all
/// of its set is held.
SetLoad without_borne(const Model& model, const Supports& supports, const std::string& set, SetLoad load);

}  // namespace pyroclast
