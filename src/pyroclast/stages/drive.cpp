#include "pyroclast/stages/drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/rounding.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

namespace pyroclast {

namespace {

/// Steps between two adjustments of loads and velocities.
constexpr std::int64_t kStepsPerAdjustment = 20;
/// Interval between two adjustments of a control's pair of forces, which is a spring whose force stays the
/// same for so long.
struct ControlInterval {
  std::int64_t steps;  ///< steps of an interval; they divide the steps between two looks
  double stable;       ///< largest (omega t)^2 at which the sets come to rest; t: time of an interval
};
/// Measured on the disc of 500 blocks: it came to rest at 5.2, 2.5 and 1.7, and shook without bound at 10,
/// 3.3 and 1.9.
constexpr std::array<ControlInterval, 3> kControlIntervals{{{5, 5.0}, {2, 2.0}, {1, 1.5}}};
/// Share that the pair may add to the largest load, and do of the work of the loads, without a warning.
constexpr double kLeftToPair = 0.05;
/// Largest noise with which a peak counts, over the recorded values; less where less is to fall from the
/// peak.
constexpr double kMostNoise = 0.1;
/// Share of its peak below which a record is behind the peak; the next peak is greater by as much.
constexpr double kBehindPeak = 1.0 - PeakRule().fall;
/// Steps between two readings for peaks, whatever the rows of the history are.
constexpr std::int64_t kStepsPerPoint = 100;
/// Distance from its course at which a controlled opening of rate 0 is lost, over the body's size.
constexpr double kLost = 0.01;
/// Difference below which directions of forces are parallel or at right angles.
constexpr double kParallel = 1e-9;
/// Numbers of rows and frames of a stage where the deck does not say.
constexpr double kLooks = 200.0, kFrames = 10.0;

const std::vector<Choice<int>> kComponents{
    {"x", 0, "to the right"}, {"y", 1, "upwards"}, {"z", 2, "to the back of a solid"}};

/// Returns a component, and 0 after an error where the body does not have it.
int in_body(int component, int dimension, const Section& s, const char* key) {
  if (component < dimension) return component;
  s.error(key, "must be \"x\" or \"y\": a body in the plane has no z");
  return 0;
}

std::vector<int> read_components(const Section& s, const char* key, int dimension, Meaning meaning) {
  std::vector<int> components;
  for (const std::string& word : s.texts(key, meaning)) {
    const auto known = std::ranges::find(kComponents, word, &Choice<int>::word);
    if (known == kComponents.end())
      s.error(key, fmt::format("must be a list of \"x\", \"y\" and in a solid \"z\"; got \"{}\"", word));
    else
      components.push_back(in_body(known->value, dimension, s, key));
  }
  return components;
}

/// Returns the direction of a force, a unit vector; two numbers are along x and y. Records an error where
/// there is no such direction.
Vec<3> read_force_direction(const Section& s, int dimension) {
  const auto components =
      s.numbers("direction", Range::any(), "of the force, as [x, y], or in a solid [x, y, z]");
  if (components.empty()) return {};
  if (components.size() != 2 && std::ssize(components) != dimension) {
    s.error("direction",
            dimension == 2 ? "must be two numbers, [x, y]" : "must be two or three numbers, [x, y, z]");
    return {};
  }
  Vec<3> direction{};
  std::ranges::copy(components, direction.c.begin());
  if (norm(direction) > 0.0) return direction * (1.0 / norm(direction));
  s.error("direction", "has no length");
  return {};
}

/// Returns the kind of an action. Records an error where not exactly one key gives it.
std::optional<ActionKind> kind_of(const Section& s) {
  const std::pair<const char*, ActionKind> kinds[] = {{"hold", ActionKind::hold},
                                                      {"release", ActionKind::release},
                                                      {"velocity", ActionKind::velocity},
                                                      {"force", ActionKind::force},
                                                      {"pressure", ActionKind::pressure}};
  std::optional<ActionKind> chosen;
  for (const auto& [key, kind] : kinds) {
    if (!s.has(key)) continue;
    if (chosen) s.error(key, "one of hold, release, velocity, force and pressure; not two in one table");
    chosen = kind;
  }
  if (!chosen) s.error("one of hold, release, velocity, force and pressure is needed");
  return chosen;
}

Drive::Action read_action(const Section& s, double duration, int dimension, CurveReader& curves) {
  Drive::Action a;
  a.set = s.text("set", "set of gridpoints that move or bear the load; see [Sets](../do/bodies.md#sets)");
  a.place = fmt::format("{}: {}", s.where("set"), s.path());
  const auto kind = kind_of(s);
  s.know(
      {"hold", "release", "velocity", "force", "pressure", "direction", "follower", "ramp_time", "factor"});
  const auto read_hold = [&] {
    return read_components(s, "hold", dimension, "components of the motion that are held from now on");
  };
  const auto read_release = [&] {
    return read_components(s, "release", dimension, "components that move freely from now on");
  };
  const auto read_along = [&](Meaning meaning) {
    return in_body(s.choice("direction", kComponents, meaning), dimension, s, "direction");
  };
  const auto read_change = [&] {
    a.ramp_time = s.quantity("ramp_time", unit::time, Range::non_negative(), 0.0,
                             "time in which the value changes evenly from the earlier to the new one");
    if (s.ok() && !at_most(a.ramp_time, duration))
      s.error("ramp_time",
              "must end within the duration of the stage: else the stated value is never reached");
    if (s.has("factor"))
      a.factor = curves.read(s, "factor", unit::dimensionless, Range::any(),
                             "of the value, over the time since the stage began");
  };
  if (!kind) return a;
  a.kind = *kind;
  switch (*kind) {
    case ActionKind::hold:
      a.components = read_hold();
      break;
    case ActionKind::release:
      a.components = read_release();
      break;
    case ActionKind::velocity:
      a.amount = s.quantity("velocity", unit::velocity, Range::any().usually(-0.1, 0.1),
                            "of that component, which is held in its place when the stage ends");
      a.components = {read_along("component of the motion that is given")};
      read_change();
      break;
    case ActionKind::force: {
      a.amount =
          s.quantity("force", unit::force, Range::any(),
                     "in all, for the thickness of the specimen; shared out by the faces of each gridpoint");
      a.direction = read_force_direction(s, dimension);
      read_change();
      break;
    }
    case ActionKind::pressure:
      a.amount = s.quantity("pressure", unit::stress, Range::any(),
                            "on the faces of the set that meet no other block; positive against the body");
      a.is_follower =
          s.flag("follower", false,
                 "whether the pressure stays normal to the faces as they turn; else it keeps its direction");
      read_change();
      break;
  }
  return a;
}

Drive::Until read_until(const Section& s, const std::vector<RecordParameters>& records) {
  Drive::Until u;
  const auto found = find_record(s, "record", "name of a [[record]]", records);
  u.place = fmt::format("{}: {}", s.where("record"), s.path());
  const std::pair<const char*, Drive::Until::Kind> kinds[] = {
      {"above", Drive::Until::Kind::above},
      {"below", Drive::Until::Kind::below},
      {"share_of_peak", Drive::Until::Kind::share_of_peak},
      {"rate_above", Drive::Until::Kind::rate_above},
      {"rate_below", Drive::Until::Kind::rate_below}};
  s.know({"above", "below", "share_of_peak", "rate_above", "rate_below"});
  if (!found) {
    s.know({"least_peak"});
    return u;
  }
  u.record = found->name;
  int stated = 0;
  for (const auto& [key, kind] : kinds) {
    if (!s.has(key)) continue;
    ++stated;
    u.kind = kind;
  }
  if (stated != 1)
    s.error("one of above, below, share_of_peak, rate_above and rate_below is needed, and one alone");
  const Unit& unit = unit_of(found->kind);
  const Unit& rate = rate_unit_of(found->kind);
  switch (u.kind) {
    case Drive::Until::Kind::above:
      u.value = s.quantity("above", unit, Range::any(), "the stage ends when the record is greater");
      break;
    case Drive::Until::Kind::below:
      u.value = s.quantity("below", unit, Range::any(), "the stage ends when the record is less");
      break;
    case Drive::Until::Kind::share_of_peak:
      u.value = s.number(
          "share_of_peak", Range::inside(0.0, 1.0),
          "the stage ends when the record's size has passed its [peak](../understand/theory.md#peaks), and "
          "fallen below this share of it");
      if (s.has("least_peak"))
        u.least_peak = s.quantity("least_peak", unit, Range::positive(),
                                  "a peak counts when it is greater; without this key, when the record is "
                                  "[beyond noise](../do/bodies.md#drives)");
      break;
    case Drive::Until::Kind::rate_above:
      u.value = s.quantity("rate_above", rate, Range::positive(),
                           "the stage ends when the record has changed faster between two samples");
      break;
    case Drive::Until::Kind::rate_below:
      u.value = s.quantity("rate_below", rate, Range::positive(),
                           "the stage ends when the record has changed more slowly between two samples");
      break;
  }
  return u;
}

Drive::Control read_control(const Section& s, const std::vector<RecordParameters>& records) {
  Drive::Control c;
  c.record = s.text("record", "the controlled [[record]], of kind opening");
  c.place = fmt::format("{}: {}", s.where("record"), s.path());
  const auto found = std::ranges::find(records, c.record, &RecordParameters::name);
  if (s.ok() && (found == records.end() || found->kind != RecordKind::opening))
    s.error("record", "must be the name of a [[record]] of kind opening");
  c.rate = s.quantity("rate", unit::velocity, Range::any(), "at which the record grows");
  c.stiffness =
      s.quantity("stiffness", unit::stiffness, Range::positive(),
                 "of the pair of forces that holds the opening: some four times the steepest softening");
  c.response_time = s.quantity(
      "response_time", unit::time, Range::positive(),
      "in which the loads take over the force of the pair: longer than waves need through the body");
  return c;
}

std::unique_ptr<Stage> read_drive(const Section& s, const StageTables& tables) {
  Drive::Keys keys;
  keys.duration =
      s.quantity("duration", unit::time, Range::positive(), "after which the stage ends at the latest");
  CurveReader curves(tables.folder, time_axis(), {0.0, keys.duration}, fire_curves());
  for (const Section& own : s.sections("drives", "sets that are held, moved or loaded, any number"))
    keys.actions.push_back(read_action(own, keys.duration, tables.dimension, curves));
  for (const Section& own :
       s.optional_sections("until", "conditions of which the first that is met ends the stage"))
    keys.until.push_back(read_until(own, tables.records));
  if (const auto own = s.optional_section("control",
                                          "an opening whose growth is given: the forces of the stage follow "
                                          "from it; see [Control](../do/bodies.md#control)")) {
    keys.control = read_control(*own, tables.records);
    const auto is_force = [](const Drive::Action& a) { return a.kind == ActionKind::force; };
    if (s.ok() && std::ranges::none_of(
                      keys.actions, [&](const Drive::Action& a) { return is_force(a) && a.amount != 0.0; }))
      own->error("needs a force among the drives of the stage, which it multiplies, and not one of 0 N");
    for (const Section& drive : s.sections("drives"))
      for (const char* key : {"ramp_time", "factor"})
        if (drive.has("force") && drive.has(key))
          drive.error(key,
                      "has no effect on a force that [stages.control] multiplies: the opening says how fast");
  }
  if (s.has("unbalanced_ratio"))
    keys.unbalanced_ratio =
        s.number("unbalanced_ratio", Range::positive().usually(1e-8, 0.01),
                 "the stage ends when all ramps have ended and the body rests: unbalanced over "
                 "applied forces are below this");
  keys.look_interval = s.quantity("look_interval", unit::time, Range::positive(), keys.duration / kLooks,
                                  "between two rows of history.csv; without this key 1/200 of the duration");
  keys.frame_interval = s.quantity("frame_interval", unit::time, Range::positive(), keys.duration / kFrames,
                                   "between two frames of the fields; without this key 1/10 of the duration; "
                                   "one more follows each peak of the first force, or stress");
  keys.records = tables.records;
  keys.results = read_record_results(s, tables.records, tables.has_thickness);
  return std::make_unique<Drive>(std::move(keys));
}

}  // namespace

StageKind drive_kind() {
  return {"drive", "holds, moves or loads sets of the specimen or of bearings", {}, read_drive};
}

Drive::Drive(Keys keys) : keys_(std::move(keys)) {
  // sized before the stage begins, because a state may be read into them
  for (auto* of_action : {&kept_.velocity, &kept_.came, &kept_.farthest})
    of_action->resize(keys_.actions.size());
  kept_.last.resize(keys_.until.size());
  kept_.peaks.resize(keys_.until.size());
  kept_.record_peaks.resize(keys_.records.size());
  for (const Action& action : keys_.actions)
    if (!is_motion(action)) kept_.first_loads.emplace_back();
  for (const RecordKind kind : {RecordKind::force, RecordKind::stress})
    if (const auto first = std::ranges::find(keys_.records, kind, &RecordParameters::kind);
        !leading_ && first != keys_.records.end())
      leading_ = first->name;
}

namespace {

/// Throws Error where a set has gridpoints of platens, which the press works.
void require_off_press(const Simulation& simulation, const Drive::Action& action) {
  if (!simulation.has_press()) return;
  const Model& model = simulation.model();
  for (const char* platen : {"bottom_platen", "top_platen"})
    for (int g : model.set(action.set))
      if (std::ranges::find(model.set(platen), g) != model.set(platen).end())
        throw Error(fmt::format("{}: set \"{}\" has gridpoints of {}, which the press works", action.place,
                                action.set, platen));
}

/// Returns the thickness of a body, of a solid its extent along z without bearings, m.
double thickness_of(const Model& model) {
  if (model.dimension() == 2) return model.thickness;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int g : model.set("specimen")) {
    low = std::min(low, model.place(g)[2]);
    high = std::max(high, model.place(g)[2]);
  }
  return high - low;
}

HeldMotion motion_of(const Drive::Action& action) {
  if (action.kind == ActionKind::hold) return {};
  return {action.amount, action.ramp_time, action.factor.has_value()};
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

/// Returns a gridpoint of a set along which supports bear a pressure; none where they do not bear all of it.
std::optional<HeldComponent> borne(const Model& model, const Supports& supports, const std::string& set) {
  std::optional<HeldComponent> any;
  for (const Face& face : faces_in(model, model.set(set)))
    for (const int g : face.gridpoints())
      for (int c = 0; c < model.dimension(); ++c) {
        if (std::abs(face.normal[c]) <= kParallel) continue;
        if (!supports.holds(g, c)) return std::nullopt;
        any = {g, c};
      }
  return any;
}

/// Returns a load that acted before supports took hold, without the parts that they bear from now on: a
/// pressure whose faces are all held along their normals, and a force along the components along which all
/// of its set is held.
SetLoad without_borne(const Model& model, const Supports& supports, const std::string& set, SetLoad load) {
  if (load.pressure != 0.0 && borne(model, supports, set)) load.pressure = 0.0;
  for (int c = 0; c < model.dimension(); ++c)
    if (std::ranges::all_of(model.set(set), [&](int g) { return supports.holds(g, c); })) load.force[c] = 0.0;
  return load;
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

bool is_same(const SetLoad& a, const SetLoad& b) {
  return a.force == b.force && a.pressure == b.pressure;
}

}  // namespace

/// Returns the largest stiffness of a control's pair with which its sets come to rest, N/m: the pair then
/// changes at each step.
double Drive::largest_stiffness(const Simulation& simulation, const Control& control) {
  const double step = simulation.motion().time_step();
  return kControlIntervals.back().stable /
         (simulation.record(control.record).mobility(simulation) * step * step);
}

void Drive::check(const Simulation& simulation, Acting& acting) const {
  const Model& model = simulation.model();
  if (keys_.control)
    if (const double most = largest_stiffness(simulation, *keys_.control); keys_.control->stiffness > most)
      throw Error(
          fmt::format("{}: the pair of forces shakes its sets without bound: by their mass and the time "
                      "step its stiffness must be at most {:.3g} GN/m; got {:.3g} GN/m",
                      keys_.control->place, 1e-9 * most, 1e-9 * keys_.control->stiffness));
  for (const Action& action : keys_.actions) {
    const auto found = model.sets.find(action.set);
    if (found == model.sets.end() || found->second.empty())
      throw Error(fmt::format("{}: there is no set \"{}\"; there are {}", action.place, action.set,
                              names_of(model.sets)));
    require_off_press(simulation, action);
    if (action.kind == ActionKind::pressure && faces_in(model, action.set_of(model)).empty())
      throw Error(
          fmt::format("{}: a pressure acts on faces that meet no other block, but set \"{}\" has none",
                      action.place, action.set));
  }
  require_consistent();
  for (const Action& action : keys_.actions) require_effect(action, acting);
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::release)
      for (int c : action.components) acting.supports.release(action.set, c, action.place);
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::hold || action.kind == ActionKind::velocity)
      for (int c : action.components) acting.supports.hold(action.set, c, motion_of(action), action.place);
  for (auto& [set, lasting] : acting.loads) {
    lasting.load = without_borne(model, acting.supports, set, lasting.load);
    if (std::ranges::none_of(keys_.actions,
                             [&, name = set](const Action& a) { return a.set == name && !is_motion(a); }))
      require_whole(model, acting.supports, set, lasting);
  }
  for (const Action& action : keys_.actions) {
    if (is_motion(action) || action.amount == 0.0) continue;
    if (action.kind == ActionKind::force)
      require_free(model, acting.supports, action.set, action.direction, action.place);
    else if (const auto at = borne(model, acting.supports, action.set))
      throw Error(fmt::format(
          "{}: a pressure acts on set \"{}\", all of which is held or driven along it, so "
          "that it moves nothing {}",
          action.place, action.set, describe_hold(model, acting.supports, at->first, at->second)));
  }
  for (const double time : {0.0, keys_.duration})
    for (const auto& [set, load] : loads_foreseen(time, acting))
      require_free(model, acting.supports, set, load.force, place_of_load(set));
  for (const auto& [set, load] : loads_foreseen(keys_.duration, acting))
    acting.loads[set] = {load, place_of_load(set)};
  if (keys_.control) {
    const RecordParameters& record = simulation.record(keys_.control->record).parameters();
    for (const std::string& set : {record.set, record.other})
      require_free(model, acting.supports, set, record.direction, keys_.control->place);
  }
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::velocity) acting.supports.halt(action.set, action.components.front());
}

/// Describes a hold that bears a load, and the ways out.
/// \param first  first way out, and a comma; may be empty
std::string Drive::describe_hold(const Model& model, const Supports& supports, int gridpoint, int component,
                                 const char* first) const {
  const std::string place = supports.place_of(gridpoint, component);
  std::string ways;
  for (const std::string& holder : holders_of(model, supports, {gridpoint, component})) {
    if (std::ranges::any_of(keys_.actions, [&](const Action& a) {
          return a.set == holder && a.kind != ActionKind::release &&
                 std::ranges::find(a.components, component) != a.components.end();
        }))
      return fmt::format("({}): {}leave one of the two out", place, first);
    ways += fmt::format("{}set = \"{}\", release = [\"{}\"]", ways.empty() ? "" : " and ", holder,
                        "xyz"[component]);
  }
  return fmt::format("({}): {}let go of it in this stage, by a drive with {}", place, first, ways);
}

/// Throws Error where a force acts along a component of a gridpoint that is held or driven.
void Drive::require_free(const Model& model, const Supports& supports, const std::string& set,
                         const Vec<3>& force, const std::string& place) const {
  if (const auto at = held_along(model, supports, set, force))
    throw Error(fmt::format(
        "{}: a force acts along {} on set \"{}\", which has gridpoints that are held or "
        "driven along {} {}",
        place, "xyz"[at->second], set, "xyz"[at->second],
        describe_hold(model, supports, at->first, at->second, "end the force by one of 0 N, or ")));
}

/// Throws Error where a load of 0, which ends a load that acts, finds none to end.
void Drive::require_effect(const Action& action, const Acting& acting) const {
  if (is_motion(action) || action.amount != 0.0) return;
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
void Drive::require_consistent() const {
  for (const Action& one : keys_.actions)
    for (const Action& other : keys_.actions) {
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

std::vector<std::string> Drive::sets() const {
  std::vector<std::string> names;
  for (const Action& action : keys_.actions) names.push_back(action.set);
  return names;
}

void Drive::check_beside(const Drive& under_way, const Simulation& simulation,
                         const Supports& supports) const {
  const auto steers = [](const Action& a) {
    return a.kind != ActionKind::hold && a.kind != ActionKind::release;
  };
  const Model& model = simulation.model();
  for (const Action& other : under_way.keys_.actions) {
    if (!steers(other)) continue;
    const SetLoad load{.force = other.kind == ActionKind::force ? other.direction : Vec<3>{},
                       .pressure = other.kind == ActionKind::pressure ? 1.0 : 0.0};
    if (!is_same(without_borne(model, supports, other.set, load), load))
      throw Error(
          fmt::format("{}: the stage under way loads set \"{}\" ({}), which this would hold: end it first",
                      keys_.actions.front().place, other.set, other.place));
    for (const Action& own : keys_.actions) {
      if (is_motion(own) != is_motion(other)) continue;
      const auto meets = [&](int g) {
        return std::ranges::find(model.set(own.set), g) != model.set(own.set).end();
      };
      const bool shares = is_motion(own) ? std::ranges::find(own.components, other.components.front()) !=
                                                   own.components.end() &&
                                               std::ranges::any_of(model.set(other.set), meets)
                                         : own.set == other.set;
      if (shares)
        throw Error(fmt::format("{}: the stage under way moves or loads set \"{}\" itself ({}): end it first",
                                own.place, other.set, other.place));
    }
  }
}

bool Drive::loads() const {
  return std::ranges::any_of(keys_.actions, [](const Action& a) {
    return a.kind == ActionKind::velocity || a.kind == ActionKind::force || a.kind == ActionKind::pressure;
  });
}

double Drive::time(const Simulation& simulation) const {
  return static_cast<double>(kept_.steps) * simulation.motion().time_step();
}

std::int64_t Drive::steps_in(const Simulation& simulation, double interval) const {
  const double steps = interval / simulation.motion().time_step() / kStepsPerAdjustment;
  return kStepsPerAdjustment * std::max<std::int64_t>(1, std::llround(steps));
}

void Drive::begin(Simulation& simulation) {
  Motion& motion = simulation.motion();
  kept_.velocity.assign(keys_.actions.size(), 0.0);
  if (keys_.control)
    kept_.first_opening = kept_.last_opening = simulation.record(keys_.control->record).read(simulation);
  kept_.came.assign(keys_.actions.size(), 0.0);
  kept_.farthest.assign(keys_.actions.size(), 0.0);
  kept_.record_peaks.assign(keys_.records.size(), {});
  kept_.peaks.assign(keys_.until.size(), {});
  kept_.last.clear();
  for (const Until& until : keys_.until)
    kept_.last.push_back(simulation.record(until.record).read(simulation));
  const EnergyLedger energy = motion.totals().energy();
  kept_.first_work = energy.loading;
  kept_.most_kinetic = std::abs(energy.kinetic);
  const Vec<3> weight =
      motion.totals().total_weight(gridpoint_set(simulation.model(), simulation.model().set("specimen")));
  kept_.body = {thickness_of(simulation.model()), norm(weight)};
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::release)
      for (int c : action.components) simulation.release(action.set, c, action.place);
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::hold || action.kind == ActionKind::velocity)
      for (int c : action.components) simulation.hold(action.set, c, motion_of(action), action.place);
  ChangedLoads left;
  for (const auto& [set, load] : simulation.loads().all())
    if (const SetLoad rest = without_borne(simulation.model(), simulation.supports(), set, load);
        !is_same(rest, load))
      left[set] = rest;
  if (!left.empty()) simulation.loads().set(left);
  kept_.first_loads.clear();
  for (const Action& action : keys_.actions)
    if (!is_motion(action)) kept_.first_loads.push_back(simulation.loads().on(action.set));
  // loads that are there already must be exceeded before they count as driving on
  const auto loads = loads_at(0.0);
  for (std::size_t i = 0; i < keys_.actions.size(); ++i) kept_.farthest[i] = std::abs(came(i, loads, 0.0));
}

/// Returns the share of an action's ramp that is over.
double Drive::share(const Action& action, double time) const {
  return action.ramp_time > 0.0 ? std::min(1.0, time / action.ramp_time) : 1.0;
}

/// Returns the velocity or load of an action at a time, without the load from before the stage. A controlled
/// force is added to all of that load.
double Drive::part(const Action& action, double time) const {
  if (keys_.control && action.kind == ActionKind::force) return kept_.load_factor * action.amount;
  const double factor = action.factor ? (*action.factor)(std::min(time, keys_.duration)) : 1.0;
  return share(action, time) * factor * action.amount;
}

/// Returns the loads of the sets that the stage loads: all that it states for a set adds up. A load from
/// before ends along the directions that are stated, evenly over the longest of their ramps, and stays across
/// them.
/// \param before  function that returns the load of a set when the stage began
template <class Before>
std::map<std::string, SetLoad> Drive::loads_at(double time, Before before) const {
  std::map<std::string, SetLoad> loads;
  for (const Action& first : keys_.actions) {
    if (is_motion(first) || loads.contains(first.set)) continue;
    const SetLoad old = before(first.set);
    SetLoad& load = loads[first.set] = old;
    double left_of_force = 1.0, left_of_pressure = 1.0, pressure = 0.0;
    Vec<3> force{};
    std::vector<Vec<3>> along;  // directions of forces, orthonormal
    bool has_pressure = false;
    for (const Action& action : keys_.actions) {
      if (action.set != first.set) continue;
      if (action.kind == ActionKind::force) {
        force += part(action, time) * action.direction;
        if (keys_.control) continue;
        left_of_force =
            std::min(left_of_force, 1.0 - share(longest_ramp(first.set, ActionKind::force), time));
        Vec<3> rest = action.direction;
        for (const Vec<3>& known : along) rest += -dot(rest, known) * known;
        if (norm(rest) > kParallel) along.push_back((1.0 / norm(rest)) * rest);
      } else if (action.kind == ActionKind::pressure) {
        pressure += part(action, time);
        left_of_pressure = 1.0 - share(longest_ramp(first.set, ActionKind::pressure), time);
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

/// Returns the loads at a time, from those that acted when the stage began.
std::map<std::string, SetLoad> Drive::loads_at(double time) const {
  return loads_at(time, [&](const std::string& set) { return first_load(set); });
}

/// Returns the action with the longest ramp among the loads of one kind on a set.
const Drive::Action& Drive::longest_ramp(const std::string& set, ActionKind kind) const {
  const Action* longest = nullptr;
  for (const Action& action : keys_.actions)
    if (action.set == set && action.kind == kind &&
        (longest == nullptr || action.ramp_time > longest->ramp_time))
      longest = &action;
  return *longest;
}

/// Returns the loads at a time, from those that will act when the stage begins, as far as they can be
/// foreseen.
std::map<std::string, SetLoad> Drive::loads_foreseen(double time, const Acting& acting) const {
  return loads_at(time, [&](const std::string& set) {
    const auto found = acting.loads.find(set);
    return found == acting.loads.end() ? SetLoad{} : found->second.load;
  });
}

/// Returns the place of the first load of the stage on a set.
const std::string& Drive::place_of_load(const std::string& set) const {
  return std::ranges::find_if(keys_.actions, [&](const Action& a) { return a.set == set && !is_motion(a); })
      ->place;
}

SetLoad Drive::first_load(const std::string& set) const {
  std::size_t i = 0;
  for (const Action& action : keys_.actions) {
    if (is_motion(action)) continue;
    if (action.set == set) return kept_.first_loads[i];
    ++i;
  }
  return {};
}

/// Returns how far an action has come: a displacement, the force along its direction, or a pressure.
double Drive::came(std::size_t i, const std::map<std::string, SetLoad>& loads, double interval) const {
  const Action& action = keys_.actions[i];
  switch (action.kind) {
    case ActionKind::velocity:
      return kept_.came[i] + kept_.velocity[i] * interval;
    case ActionKind::force:
      return dot(loads.at(action.set).force, action.direction);
    case ActionKind::pressure:
      return loads.at(action.set).pressure;
    default:
      return 0.0;
  }
}

/// Sets the pair of forces that holds the opening on its course, and changes the loads until the pair has
/// nothing left to do.
void Drive::steer(const Simulation& simulation, double time, std::int64_t interval, ChangedLoads& loads) {
  const Control& control = *keys_.control;
  const Record& record = simulation.record(control.record);
  const double opening = record.read(simulation);
  kept_.pair_work += kept_.pair_force * (opening - kept_.last_opening);
  kept_.last_opening = opening;
  const double behind = kept_.first_opening + control.rate * time - opening;
  kept_.pair_force = control.stiffness * behind;
  const double whole = std::abs(control.rate) * keys_.duration;
  kept_.is_lost = std::abs(behind) > (whole > 0.0 ? whole : kLost * simulation.body_size());
  const double step = static_cast<double>(interval) * simulation.motion().time_step();
  // the parts that bear the load now bear the pair beside it
  kept_.largest_with_pair =
      std::max(kept_.largest_with_pair, total_load(kept_.load_factor) + std::abs(kept_.pair_force));
  kept_.load_factor += kept_.pair_force / unit_force() * step / control.response_time;
  kept_.largest_factor = std::max(kept_.largest_factor, std::abs(kept_.load_factor));
  kept_.largest_load = std::max(kept_.largest_load, total_load(kept_.load_factor));
  const RecordParameters& of = record.parameters();
  loads[of.other] = {.force = kept_.pair_force * of.direction};
  loads[of.set] = {.force = -kept_.pair_force * of.direction};
}

/// Returns the force that the loaded sets bear together at a factor of the controlled forces, with the forces
/// from before: the largest in any of their directions, N. Sets that are pulled apart bear it once.
double Drive::total_load(double factor) const {
  std::map<std::string, Vec<3>> forces;
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::force)
      forces.try_emplace(action.set, first_load(action.set).force).first->second +=
          (factor * action.amount) * action.direction;
  double most = 0.0;
  for (const auto& [set, along] : forces) {
    if (!(norm(along) > 0.0)) continue;
    double sum = 0.0;
    for (const auto& [other, force] : forces) sum += std::max(0.0, dot(force, along) / norm(along));
    most = std::max(most, sum);
  }
  return most;
}

/// Sums all forces of the stage at a factor of 1, N. By this sum a force of the pair becomes a change of the
/// factor.
double Drive::unit_force() const {
  double sum = 0.0;
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::force) sum += std::abs(action.amount);
  return sum;
}

std::int64_t Drive::steps_per_adjustment(const Simulation& simulation) const {
  if (!keys_.control) return kStepsPerAdjustment;
  const double share = keys_.control->stiffness / largest_stiffness(simulation, *keys_.control);
  for (const auto& [steps, stable] : kControlIntervals)
    if (share * static_cast<double>(steps * steps) * kControlIntervals.back().stable <= stable) return steps;
  return kControlIntervals.back().steps;
}

std::int64_t Drive::duration_in_steps(const Simulation& simulation) const {
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(whole_above(keys_.duration / simulation.motion().time_step())));
}

/// Returns the number of steps for which the present loads and velocities act.
std::int64_t Drive::steps_to_come(const Simulation& simulation, std::int64_t interval) const {
  return std::min(interval, duration_in_steps(simulation) - (kept_.steps - kept_.steps % interval));
}

/// Lets the loads and velocities of the middle of the steps to come act.
/// \param adjustment  steps between two adjustments
void Drive::act(Simulation& simulation, std::int64_t adjustment) {
  const double interval =
      static_cast<double>(steps_to_come(simulation, adjustment)) * simulation.motion().time_step();
  const double middle = time(simulation) + 0.5 * interval;
  ChangedLoads loads;
  if (keys_.control) steer(simulation, middle, adjustment, loads);
  kept_.is_driven = keys_.control && keys_.control->rate != 0.0;
  for (const auto& [set, load] : loads_at(middle)) loads[set] = load;
  for (std::size_t i = 0; i < keys_.actions.size(); ++i) {
    const Action& action = keys_.actions[i];
    if (action.kind == ActionKind::velocity) {
      kept_.velocity[i] = part(action, middle);
      simulation.drive(action.set, action.components.front(), kept_.velocity[i]);
    }
    kept_.came[i] = came(i, loads, interval);
    if (std::abs(kept_.came[i]) <= kept_.farthest[i]) continue;
    kept_.farthest[i] = std::abs(kept_.came[i]);
    kept_.is_driven = true;
  }
  simulation.loads().set(loads);
  if (kept_.is_driven) kept_.driven += interval;
}

/// Takes the values of the records into their peaks. An unloading by command is no fall from a peak: nothing
/// counts until the body is driven farther than ever.
void Drive::take_peaks(const Simulation& simulation) {
  kept_.is_beyond_noise = kept_.is_beyond_noise || is_beyond_noise(kMostNoise, simulation);
  std::vector<double> values;
  for (const RecordParameters& record : keys_.records)
    values.push_back(simulation.record(record.name).read(simulation));
  for (std::size_t i = 0; i < values.size(); ++i)
    kept_.record_peaks[i].take(i, kept_.driven, kept_.is_driven && kept_.is_beyond_noise,
                               simulation.motion().time(), values);
  for (std::size_t i = 0; i < keys_.until.size(); ++i) {
    const Until& until = keys_.until[i];
    if (until.kind != Until::Kind::share_of_peak || !kept_.is_driven) continue;
    const double size = std::abs(simulation.record(until.record).read(simulation));
    const double most_noise = std::min(kMostNoise, 1.0 - until.value);
    if (kept_.peaks[i].size() > 0.0 ||
        (until.least_peak ? size > *until.least_peak : is_beyond_noise(most_noise, simulation)))
      kept_.peaks[i].take(kept_.driven, size, rule_of_records(kept_.peaks[i]));
  }
}

bool Drive::advance(Simulation& simulation, int most_steps) {
  const std::int64_t interval = steps_per_adjustment(simulation);
  if (kept_.steps % interval == 0) act(simulation, interval);
  const auto steps =
      std::min<std::int64_t>(steps_to_come(simulation, interval) - kept_.steps % interval, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.steps += steps;
  if (kept_.steps % kStepsPerPoint == 0) take_peaks(simulation);
  return kept_.steps % steps_in(simulation, keys_.look_interval) == 0 || kept_.is_lost ||
         kept_.steps >= duration_in_steps(simulation);
}

/// Tells whether noise is below a share of what records show of the stage. Forces go with the root of an
/// energy. So the kinetic energy, at any call so far, must be below the square of that share of the work of
/// the loads. A stage that loads nothing shakes nothing.
bool Drive::is_beyond_noise(double share, const Simulation& simulation) {
  const EnergyLedger energy = simulation.motion().totals().energy();
  kept_.most_kinetic = std::max(kept_.most_kinetic, std::abs(energy.kinetic));
  return !loads() || kept_.most_kinetic <= share * share * std::abs(energy.loading - kept_.first_work);
}

bool Drive::is_met(std::size_t condition, const Simulation& simulation) {
  const Until& until = keys_.until[condition];
  double& last = kept_.last[condition];
  const double value = simulation.record(until.record).read(simulation);
  const double rate = std::abs(value - last) / (time(simulation) - kept_.last_look);
  last = value;
  // a record that ran away from its control passes any value
  if (kept_.is_lost && until.record == keys_.control->record) return false;
  switch (until.kind) {
    case Until::Kind::above:
      return value > until.value;
    case Until::Kind::below:
      return value < until.value;
    case Until::Kind::share_of_peak:
      return kept_.peaks[condition].is_found() &&
             std::abs(value) < until.value * kept_.peaks[condition].size();
    case Until::Kind::rate_above:
      return rate > until.value;
    case Until::Kind::rate_below:
      return rate < until.value;
  }
  return false;
}

/// Tells whether the leading record has just come down from a peak that has no frame yet.
bool Drive::has_fallen(const Simulation& simulation) {
  if (!leading_) return false;
  const double size = std::abs(simulation.record(*leading_).read(simulation));
  if (kept_.leading_peak == 0.0 && !is_beyond_noise(kMostNoise, simulation)) return false;
  kept_.leading_peak = std::max(kept_.leading_peak, size);
  if (size >= kBehindPeak * kept_.leading_peak || kept_.framed_peak >= kBehindPeak * kept_.leading_peak)
    return false;
  kept_.framed_peak = kept_.leading_peak;
  return true;
}

/// Leaves the loads as they are at the end, holds what was moved where it is, and removes the pair.
void Drive::halt(Simulation& simulation) {
  ChangedLoads loads = loads_at(time(simulation));
  if (keys_.control) {
    const RecordParameters& record = simulation.record(keys_.control->record).parameters();
    loads[record.set] = loads[record.other] = {};
  }
  simulation.loads().set(loads);
  for (const Action& action : keys_.actions)
    if (action.kind == ActionKind::velocity) simulation.halt(action.set, action.components.front());
}

Verdict Drive::judge(Simulation& simulation) {
  Verdict verdict;
  kept_.largest_pair = std::max(kept_.largest_pair, std::abs(kept_.pair_force));
  const double now = time(simulation);
  for (std::size_t i = 0; i < keys_.until.size(); ++i)
    if (is_met(i, simulation)) {
      verdict.over = true;
      if (keys_.until[i].kind == Until::Kind::share_of_peak)
        for (RecordPeak& peak : kept_.record_peaks) peak.end();
    }
  kept_.last_look = now;
  // The loads are those of the middle of the last steps, so a ramp may end before all of it acts.
  const double acted =
      now - 0.5 * static_cast<double>(steps_per_adjustment(simulation)) * simulation.motion().time_step();
  if (kept_.is_lost && !verdict.over)
    verdict = {.over = true, .last = true, .outcome = Outcome::control_lost};
  const bool ramps_are_over =
      std::ranges::all_of(keys_.actions, [&](const Action& a) { return at_most(a.ramp_time, acted); });
  if (keys_.unbalanced_ratio && ramps_are_over &&
      simulation.motion().totals().unbalanced_ratio() < *keys_.unbalanced_ratio)
    verdict.over = true;
  if (!verdict.over && kept_.steps >= duration_in_steps(simulation)) {
    verdict.over = true;
    if (keys_.unbalanced_ratio) {
      verdict.last = true;
      verdict.outcome = Outcome::not_settled;
    } else if (!keys_.until.empty()) {
      verdict.outcome = Outcome::not_reached;
    }
  }
  if (verdict.over) halt(simulation);
  const auto frames = static_cast<std::int64_t>(whole_below(now / keys_.frame_interval));
  verdict.frame = has_fallen(simulation) || frames > kept_.frames;
  kept_.frames = std::max(kept_.frames, frames);
  return verdict;
}

double Drive::progress(const Simulation& simulation) const {
  return std::min(1.0, time(simulation) / keys_.duration);
}

/// Describes a condition that was not met, and where its record stood at the end.
std::string Drive::describe_unmet(std::size_t condition) const {
  const Until& until = keys_.until[condition];
  const auto record = std::ranges::find(keys_.records, until.record, &RecordParameters::name);
  const double factor = column_over_si(record->kind);
  const std::string unit = column_of(*record).unit;
  const double last = factor * kept_.last[condition];
  switch (until.kind) {
    case Until::Kind::above:
      return fmt::format("{} is {:.4g} {}, not above {:.4g}", until.record, last, unit, factor * until.value);
    case Until::Kind::below:
      return fmt::format("{} is {:.4g} {}, not below {:.4g}", until.record, last, unit, factor * until.value);
    case Until::Kind::share_of_peak:
      if (!kept_.peaks[condition].is_found())
        return fmt::format("{} had no peak; it is {:.4g} {}", until.record, last, unit);
      return fmt::format("{} is {:.4g} {}, not below {:g} of its peak, {:.4g}", until.record, last, unit,
                         until.value, factor * kept_.peaks[condition].size());
    case Until::Kind::rate_above:
      return fmt::format("{} did not change faster than {:.4g} {}/s", until.record, factor * until.value,
                         unit);
    case Until::Kind::rate_below:
      return fmt::format("{} did not change more slowly than {:.4g} {}/s", until.record, factor * until.value,
                         unit);
  }
  return {};
}

StageReport Drive::report(const History& history, RowRange rows, Outcome outcome) const {
  StageReport report;
  const bool has_rows = !rows.empty();
  const double work = has_rows ? history.values("energy_loading_J", rows).back() - kept_.first_work : 0.0;
  report.results = {
      {"steps", kept_.steps, ResultOf::computation},
      {"unbalanced_ratio", last_value(history, "unbalanced_ratio", rows), ResultOf::computation},
      {"loading_work_J", value_if(has_rows, work), ResultOf::computation}};
  const auto of_records =
      record_results(keys_.records, kept_.record_peaks, keys_.results, kept_.body, history, rows);
  report.results.insert(report.results.end(), of_records.begin(), of_records.end());
  if (has_rows) report.lines = lines_of(keys_.results, of_records);
  report.warnings = missing_peaks(keys_.records, kept_.record_peaks, keys_.results);
  if (keys_.control) add_control(report, work);
  if (outcome == Outcome::control_lost)
    report.warnings.push_back(
        fmt::format("the control of {} ran away: with a positive rate the forces of the stage must open it "
                    "where they grow "
                    "(turn the direction, the rate, or set and other of the record), and its stiffness must "
                    "exceed that of "
                    "the softening",
                    keys_.control->record));
  if (outcome == Outcome::not_reached || outcome == Outcome::not_settled) {
    for (std::size_t i = 0; i < keys_.until.size(); ++i)
      report.warnings.push_back(fmt::format("not met within the duration: {}", describe_unmet(i)));
    if (outcome == Outcome::not_settled)
      report.warnings.push_back(fmt::format(
          "not met within the duration: the unbalanced ratio is not below {:g}", *keys_.unbalanced_ratio));
  }
  return report;
}

/// Reports the pair's part of the test. The largest load and the largest of load and pair together bound the
/// strength: where a part fails under both, its own peak may come before that of the load. Where single
/// contacts give way at once the pair catches the body, for moments.
///
/// \param work  work of the stage's loads, J
void Drive::add_control(StageReport& report, double work) const {
  const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
  const double peak = kept_.largest_load;
  const double of_peak = std::max(0.0, share(kept_.largest_with_pair, peak) - 1.0);
  const double of_work = share(std::abs(kept_.pair_work), std::abs(work));
  report.results.push_back({"largest_load_factor", kept_.largest_factor});
  report.results.push_back(
      {"control_force_over_peak", share(kept_.largest_pair, peak), ResultOf::computation});
  report.results.push_back({"largest_load_with_control_N", kept_.largest_with_pair});
  report.results.push_back({"control_error_of_largest_load", of_peak, ResultOf::computation});
  report.results.push_back({"control_work_over_loading_work", of_work, ResultOf::computation});
  report.lines.push_back(fmt::format(
      "control of {}: the largest load is {:.4g} N, and {:.4g} N with the force of the pair beside this "
      "({:+.2g} %); the pair bore up to {:.2g} % of that load, and did {:.2g} % of the work",
      keys_.control->record, peak, kept_.largest_with_pair, 100.0 * of_peak,
      100.0 * share(kept_.largest_pair, peak), 100.0 * of_work));
  if (std::max(of_peak, of_work) > kLeftToPair)
    report.warnings.push_back(report.lines.back() + ": a slower rate leaves the pair less");
}

Forecast Drive::forecast(const Simulation& simulation, Foreseen&) const {
  const double steps = keys_.duration / simulation.motion().time_step();
  return {.steps = steps,
          .looks = keys_.duration / keys_.look_interval,
          .frames = keys_.duration / keys_.frame_interval + (leading_ ? 1.0 : 0.0)};
}

std::vector<Column> Drive::columns() const {
  if (!keys_.control) return {};
  std::vector<Column> columns;
  for (const ColumnInfo& info : control_columns()) columns.push_back({info.name, info.unit});
  return columns;
}

std::vector<ColumnInfo> Drive::control_columns() {
  return {{"load_factor", "1", "share of the drives' loads that a [stages.control] lets act"},
          {"control_force_N", "N", "force of the pair that makes the controlled opening grow"}};
}

std::vector<double> Drive::values() const {
  if (!keys_.control) return {};
  return {kept_.load_factor, kept_.pair_force};
}

void Drive::visit_state(StateVisitor& visitor) {
  auto& [steps, frames, first_loads, velocity, came, farthest, driven, is_driven, is_lost, is_beyond_noise,
         record_peaks, peaks, last, leading_peak, framed_peak, last_look, first_opening, last_opening,
         load_factor, pair_force, largest_pair, largest_factor, largest_with_pair, largest_load, pair_work,
         first_work, most_kinetic, body] = kept_;  // another member does not compile until it has a name here
  visitor.visit("first_opening", first_opening);
  visitor.visit("load_factor", load_factor);
  visitor.visit("pair_force", pair_force);
  visitor.visit("largest_pair", largest_pair);
  visitor.visit("largest_factor", largest_factor);
  visitor.visit("largest_load", largest_load);
  visitor.visit("largest_with_pair", largest_with_pair);
  visitor.visit("pair_work", pair_work);
  visitor.visit("last_opening", last_opening);
  visitor.visit("steps", steps, state::count());
  visitor.visit("frames", frames, state::count());
  {
    std::vector<double> numbers;
    for (const SetLoad& load : first_loads)
      numbers.insert(numbers.end(), {load.force[0], load.force[1], load.force[2], load.pressure,
                                     load.is_follower ? 1.0 : 0.0});
    const auto loads = std::ranges::count_if(keys_.actions, [](const Action& a) { return !is_motion(a); });
    visitor.visit("first_loads", numbers, state::finite().of(5 * static_cast<std::size_t>(loads)));
    if (visitor.replaces()) {
      first_loads.clear();
      for (std::size_t i = 0; i + 4 < numbers.size(); i += 5)
        first_loads.push_back(
            {{{numbers[i], numbers[i + 1], numbers[i + 2]}}, numbers[i + 3], numbers[i + 4] != 0.0});
    }
  }
  const StateRule of_each_action = state::finite().of(keys_.actions.size());
  visitor.visit("velocity", velocity, of_each_action);
  visitor.visit("last", last, state::finite().of(keys_.until.size()));
  visitor.visit("came", came, of_each_action);
  visitor.visit("farthest", farthest, of_each_action);
  visitor.visit("driven", driven);
  visitor.visit("is_driven", is_driven);
  visitor.visit("is_lost", is_lost);
  visitor.visit("is_beyond_noise", is_beyond_noise);
  const auto visit_all = [&](const char* name, auto& all, auto... more) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const StateVisitor::Scope scope(visitor, fmt::format("{}[{}]", name, i));
      all[i].visit_state(visitor, more...);
    }
  };
  visit_all("record_peaks", record_peaks, keys_.records.size());
  visit_all("peaks", peaks);
  visitor.visit("leading_peak", leading_peak);
  visitor.visit("framed_peak", framed_peak);
  visitor.visit("last_look", last_look);
  visitor.visit("first_work", first_work);
  visitor.visit("most_kinetic", most_kinetic);
  body.visit_state(visitor);
}

}  // namespace pyroclast
