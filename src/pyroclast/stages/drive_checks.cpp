#include "pyroclast/stages/drive_checks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/model/sets.hpp"

namespace pyroclast {

namespace {

/// Throws Error where a set has gridpoints of platens, which the press works.
void require_off_press(const Simulation& simulation, const DriveAction& action) {
  if (!simulation.has_press()) return;
  const Model& model = simulation.model();
  for (const char* platen : {"bottom_platen", "top_platen"})
    for (int g : model.set(action.set))
      if (std::ranges::find(model.set(platen), g) != model.set(platen).end())
        throw Error(fmt::format("{}: set \"{}\" has gridpoints of {}, which the press works", action.place,
                                action.set, platen));
}

/// Component of the motion of a gridpoint.
using HeldComponent = std::pair<int, int>;

/// Returns the names of the sets that hold a component of a gridpoint.
std::vector<std::string> holders_of(const Model& model, const Supports& supports, const HeldComponent& at) {
  std::vector<std::string> names;
  for (const auto& [name, members] : model.sets)
    if (supports.holds(name, at.second) && std::ranges::find(members, at.first) != members.end())
      names.push_back(name);
  return names;
}

/// Returns a gridpoint of a set that is held or driven along a force; none where the force moves all of them.
std::optional<HeldComponent> held_along(const Model& model, const Supports& supports, const std::string& set,
                                        const Vec<3>& force) {
  for (int g : model.set(set))
    for (int c = 0; c < model.dimension(); ++c)
      if (force[c] != 0.0 && supports.holds(g, c)) return HeldComponent{g, c};
  return std::nullopt;
}

/// Tells whether supports bear all of a pressure on a set.
/// \param at  set to a gridpoint there, where the part of the body has one
bool borne(const Model& model, const Supports& supports, const std::string& set,
           std::optional<HeldComponent>& at) {
  bool misses = false;
  for (const Face& face : faces_in(model, model.set(set)))
    for (const int g : face.gridpoints())
      for (int c = 0; c < model.dimension(); ++c) {
        if (std::abs(face.normal[c]) <= kParallel) continue;
        if (supports.holds(g, c))
          at = {g, c};
        else
          misses = true;
      }
  const bool bears = model.ranks().any(at.has_value());
  return !model.ranks().any(misses) && bears;
}

/// Throws Error where a part of a set that bears a force from before comes to be held along the force: the
/// force would lose the shares of that part.
void require_whole(const Model& model, const Supports& supports, const std::string& set,
                   const LastingLoad& lasting) {
  if (const auto at = held_along(model, supports, set, lasting.load.force))
    throw Error(fmt::format(
        "{0}: from here on a part of set \"{1}\" is held or driven along {2}, but a force along {2} acts on "
        "all of it ({3}): end the force in this stage, by one of 0 N without ramp_time, or hold or drive the "
        "whole set, which ends it",
        supports.place_of(at->first, at->second), set, "xyz"[at->second], lasting.place));
}

/// Describes a hold that bears a load, and the ways out.
/// \param first  first way out, and a comma; may be empty
std::string describe_hold(const std::vector<DriveAction>& actions, const Model& model,
                          const Supports& supports, const HeldComponent& at, const char* first = "") {
  const std::string place = supports.place_of(at.first, at.second);
  std::string ways;
  for (const std::string& holder : holders_of(model, supports, at)) {
    if (std::ranges::any_of(actions, [&](const DriveAction& a) {
          return a.set == holder && a.kind != ActionKind::release &&
                 std::ranges::find(a.components, at.second) != a.components.end();
        }))
      return fmt::format("({}): {}leave one of the two out", place, first);
    ways += fmt::format("{}set = \"{}\", release = [\"{}\"]", ways.empty() ? "" : " and ", holder,
                        "xyz"[at.second]);
  }
  return fmt::format("({}): {}let go of it in this stage, by a drive with {}", place, first, ways);
}

/// Throws Error where a force acts along a component of a gridpoint that is held or driven.
void require_free(const std::vector<DriveAction>& actions, const Model& model, const Supports& supports,
                  const std::string& set, const Vec<3>& force, const std::string& place) {
  if (const auto at = held_along(model, supports, set, force))
    throw Error(
        fmt::format("{}: a force acts along {} on set \"{}\", which has gridpoints that are held or "
                    "driven along {} {}",
                    place, "xyz"[at->second], set, "xyz"[at->second],
                    describe_hold(actions, model, supports, *at, "end the force by one of 0 N, or ")));
}

/// Throws Error where a load of 0, which ends a load that acts, finds none to end.
void require_effect(const DriveAction& action, const Acting& acting) {
  if (!action.is_load() || action.amount != 0.0) return;
  const auto found = acting.loads.find(action.set);
  const SetLoad load = found == acting.loads.end() ? SetLoad{} : found->second.load;
  const bool is_force = action.kind == ActionKind::force;
  if (is_force ? std::abs(dot(load.force, action.direction)) > kParallel * norm(load.force)
               : load.pressure != 0.0)
    return;
  const bool has_other = is_force ? load.pressure != 0.0 : norm(load.force) > 0.0;
  const std::string other = is_force ? "a pressure of 0 Pa ends one" : "a force of 0 N along it ends one";
  throw Error(fmt::format("{}: no {} acts on set \"{}\"{}, so that this ends nothing{}", action.place,
                          is_force ? "force" : "pressure", action.set,
                          is_force ? " along that direction" : "",
                          has_other ? fmt::format("; a {} does ({}), and {}", is_force ? "pressure" : "force",
                                                  found->second.place, other)
                                    : ""));
}

/// Throws Error where a set is to be held, driven or released twice along one component, or has pressures of
/// both sorts.
void require_consistent(const std::vector<DriveAction>& actions) {
  for (const DriveAction& one : actions)
    for (const DriveAction& other : actions) {
      if (&one >= &other || one.set != other.set) continue;
      for (int c : one.components)
        if (std::ranges::find(other.components, c) != other.components.end())
          throw Error(fmt::format(
              "{}: set \"{}\" is held, driven or released along {} twice in one stage, here and at {}",
              other.place, other.set, "xyz"[c], one.place));
      if (one.kind == ActionKind::pressure && other.kind == ActionKind::pressure &&
          one.is_follower != other.is_follower)
        throw Error(fmt::format(
            "{}: set \"{}\" has a pressure that follows the body and one that does not ({}); give one "
            "of them to another set with the same faces",
            other.place, other.set, one.place));
    }
}

/// Returns the place of the first load of a drive on a set.
const std::string& place_of_load(const std::vector<DriveAction>& actions, const std::string& set) {
  return std::ranges::find_if(actions, [&](const DriveAction& a) { return a.set == set && a.is_load(); })
      ->place;
}

/// Returns the loads of a drive at a time, s, from those that will act when it begins, as far as they can be
/// foreseen.
LoadsBySet loads_foreseen(const DriveKeys& keys, double time, const Acting& acting) {
  return loads_at(keys, time, 0.0, [&](const std::string& set) {
    const auto found = acting.loads.find(set);
    return found == acting.loads.end() ? SetLoad{} : found->second.load;
  });
}

}  // namespace

HeldMotion motion_of(const DriveAction& action) {
  if (action.kind == ActionKind::hold) return {};
  return {action.amount, action.ramp_time, action.factor.has_value()};
}

SetLoad without_borne(const Model& model, const Supports& supports, const std::string& set, SetLoad load) {
  std::optional<HeldComponent> at;
  if (load.pressure != 0.0 && borne(model, supports, set, at)) load.pressure = 0.0;
  for (int c = 0; c < model.dimension(); ++c) {
    const auto moves = [&](int g) { return !supports.holds(g, c); };
    if (!model.ranks().any(std::ranges::any_of(model.set(set), moves))) load.force[c] = 0.0;
  }
  return load;
}

void check_actions(const DriveKeys& keys, const Simulation& simulation, Acting& acting) {
  const Model& model = simulation.model();
  for (const DriveAction& action : keys.actions) {
    const auto found = model.sets.find(action.set);
    if (found == model.sets.end() || !model.ranks().any(!found->second.empty()))
      throw Error(fmt::format("{}: there is no set \"{}\"; there are {}", action.place, action.set,
                              names_of(model.sets)));
    require_off_press(simulation, action);
    if (action.kind == ActionKind::pressure && !model.ranks().any(!faces_in(model, found->second).empty()))
      throw Error(
          fmt::format("{}: a pressure acts on faces that meet no other block, but set \"{}\" has none",
                      action.place, action.set));
  }
  require_consistent(keys.actions);
  for (const DriveAction& action : keys.actions) require_effect(action, acting);
  for (const DriveAction& action : keys.actions)
    if (action.kind == ActionKind::release)
      for (int c : action.components) acting.supports.release(action.set, c, action.place);
  for (const DriveAction& action : keys.actions)
    if (action.kind == ActionKind::hold || action.kind == ActionKind::velocity)
      for (int c : action.components) acting.supports.hold(action.set, c, motion_of(action), action.place);
  for (auto& [set, lasting] : acting.loads) {
    lasting.load = without_borne(model, acting.supports, set, lasting.load);
    if (std::ranges::none_of(keys.actions,
                             [&, name = set](const DriveAction& a) { return a.set == name && a.is_load(); }))
      require_whole(model, acting.supports, set, lasting);
  }
  for (const DriveAction& action : keys.actions) {
    if (!action.is_load() || action.amount == 0.0) continue;
    std::optional<HeldComponent> at;
    if (action.kind == ActionKind::force)
      require_free(keys.actions, model, acting.supports, action.set, action.direction, action.place);
    else if (borne(model, acting.supports, action.set, at) && at)
      throw Error(
          fmt::format("{}: a pressure acts on set \"{}\", all of which is held or driven along it, so "
                      "that it moves nothing {}",
                      action.place, action.set, describe_hold(keys.actions, model, acting.supports, *at)));
  }
  for (const double time : {0.0, keys.duration})
    for (const auto& [set, load] : loads_foreseen(keys, time, acting))
      require_free(keys.actions, model, acting.supports, set, load.force, place_of_load(keys.actions, set));
  for (const auto& [set, load] : loads_foreseen(keys, keys.duration, acting))
    acting.loads[set] = {load, place_of_load(keys.actions, set)};
  if (keys.control) {
    const RecordParameters& record = simulation.record(keys.control->record).parameters();
    for (const std::string& set : {record.set, record.other})
      require_free(keys.actions, model, acting.supports, set, record.direction, keys.control->place);
  }
  for (const DriveAction& action : keys.actions)
    if (action.kind == ActionKind::velocity) acting.supports.halt(action.set, action.components.front());
}

void check_actions_beside(const DriveKeys& keys, const DriveKeys& under_way, const Model& model,
                          const Supports& supports) {
  const auto steers = [](const DriveAction& a) {
    return a.kind != ActionKind::hold && a.kind != ActionKind::release;
  };
  for (const DriveAction& other : under_way.actions) {
    if (!steers(other)) continue;
    const SetLoad load{.force = other.kind == ActionKind::force ? other.direction : Vec<3>{},
                       .pressure = other.kind == ActionKind::pressure ? 1.0 : 0.0};
    if (without_borne(model, supports, other.set, load) != load)
      throw Error(
          fmt::format("{}: the stage under way loads set \"{}\" ({}), which this would hold: end it first",
                      keys.actions.front().place, other.set, other.place));
    for (const DriveAction& own : keys.actions) {
      if (own.is_load() != other.is_load()) continue;
      const auto meets = [&](int g) {
        return std::ranges::find(model.set(own.set), g) != model.set(own.set).end();
      };
      const bool shares = !own.is_load() ? std::ranges::find(own.components, other.components.front()) !=
                                                   own.components.end() &&
                                               std::ranges::any_of(model.set(other.set), meets)
                                         : own.set == other.set;
      if (shares)
        throw Error(fmt::format("{}: the stage under way moves or loads set \"{}\" itself ({}): end it first",
                                own.place, other.set, other.place));
    }
  }
}

}  // namespace pyroclast
