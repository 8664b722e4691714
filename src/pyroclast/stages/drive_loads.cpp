#include "pyroclast/stages/drive_loads.hpp"

#include <algorithm>
#include <vector>

namespace pyroclast {

namespace {

/// Returns the share of an action's ramp that is over.
double share_of_ramp(const DriveAction& action, double time) {
  return action.ramp_time > 0.0 ? std::min(1.0, time / action.ramp_time) : 1.0;
}

/// Returns the share of the longest ramp that is over, among the loads of one kind on a set.
double share_of_longest(const DriveKeys& keys, const std::string& set, ActionKind kind, double time) {
  const DriveAction* longest = nullptr;
  for (const DriveAction& action : keys.actions)
    if (action.set == set && action.kind == kind &&
        (longest == nullptr || action.ramp_time > longest->ramp_time))
      longest = &action;
  return share_of_ramp(*longest, time);
}

}  // namespace

double part_of(const DriveKeys& keys, const DriveAction& action, double time, double load_factor) {
  if (keys.control && action.kind == ActionKind::force) return load_factor * action.amount;
  const double factor = action.factor ? (*action.factor)(std::min(time, keys.duration)) : 1.0;
  return share_of_ramp(action, time) * factor * action.amount;
}

LoadsBySet loads_at(const DriveKeys& keys, double time, double load_factor, const LoadBefore& before) {
  LoadsBySet loads;
  for (const DriveAction& first : keys.actions) {
    if (!first.is_load() || loads.contains(first.set)) continue;
    const SetLoad old = before(first.set);
    SetLoad& load = loads[first.set] = old;
    double left_of_force = 1.0, left_of_pressure = 1.0, pressure = 0.0;
    Vec<3> force{};
    std::vector<Vec<3>> along;  // directions of forces, orthonormal
    bool has_pressure = false;
    for (const DriveAction& action : keys.actions) {
      if (action.set != first.set) continue;
      if (action.kind == ActionKind::force) {
        force += part_of(keys, action, time, load_factor) * action.direction;
        if (keys.control) continue;
        left_of_force =
            std::min(left_of_force, 1.0 - share_of_longest(keys, first.set, ActionKind::force, time));
        Vec<3> rest = action.direction;
        for (const Vec<3>& known : along) rest += -dot(rest, known) * known;
        if (norm(rest) > kParallel) along.push_back((1.0 / norm(rest)) * rest);
      } else if (action.kind == ActionKind::pressure) {
        pressure += part_of(keys, action, time, load_factor);
        left_of_pressure = 1.0 - share_of_longest(keys, first.set, ActionKind::pressure, time);
        load.is_follower = action.is_follower;
        has_pressure = true;
      }
    }
    for (const Vec<3>& direction : along)
      load.force += (-(1.0 - left_of_force) * dot(old.force, direction)) * direction;
    load.force += force;
    if (has_pressure) load.pressure = pressure + left_of_pressure * old.pressure;
  }
  return loads;
}

}  // namespace pyroclast
