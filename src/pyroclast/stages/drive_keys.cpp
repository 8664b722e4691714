#include "pyroclast/stages/drive_keys.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/material/curve_reader.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

namespace pyroclast {

namespace {

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

DriveAction read_action(const Section& s, double duration, int dimension, CurveReader& curves) {
  DriveAction a;
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

EndCondition read_until(const Section& s, const std::vector<RecordParameters>& records) {
  EndCondition u;
  const auto found = find_record(s, "record", "name of a [[record]]", records);
  u.place = fmt::format("{}: {}", s.where("record"), s.path());
  const std::pair<const char*, EndCondition::Kind> kinds[] = {
      {"above", EndCondition::Kind::above},
      {"below", EndCondition::Kind::below},
      {"share_of_peak", EndCondition::Kind::share_of_peak},
      {"rate_above", EndCondition::Kind::rate_above},
      {"rate_below", EndCondition::Kind::rate_below}};
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
    case EndCondition::Kind::above:
      u.value = s.quantity("above", unit, Range::any(), "the stage ends when the record is greater");
      break;
    case EndCondition::Kind::below:
      u.value = s.quantity("below", unit, Range::any(), "the stage ends when the record is less");
      break;
    case EndCondition::Kind::share_of_peak:
      u.value = s.number(
          "share_of_peak", Range::inside(0.0, 1.0),
          "the stage ends when the record's size has passed its [peak](../understand/theory.md#peaks), and "
          "fallen below this share of it");
      if (s.has("least_peak"))
        u.least_peak = s.quantity("least_peak", unit, Range::positive(),
                                  "a peak counts when it is greater; without this key, when the record is "
                                  "[beyond noise](../do/bodies.md#drives)");
      break;
    case EndCondition::Kind::rate_above:
      u.value = s.quantity("rate_above", rate, Range::positive(),
                           "the stage ends when the record has changed faster between two samples");
      break;
    case EndCondition::Kind::rate_below:
      u.value = s.quantity("rate_below", rate, Range::positive(),
                           "the stage ends when the record has changed more slowly between two samples");
      break;
  }
  return u;
}

ControlKeys read_control(const Section& s, const std::vector<RecordParameters>& records) {
  ControlKeys c;
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

}  // namespace

bool DriveKeys::loads() const {
  return std::ranges::any_of(actions, [](const DriveAction& a) {
    return a.kind != ActionKind::hold && a.kind != ActionKind::release;
  });
}

DriveKeys read_drive_keys(const Section& s, const StageTables& tables) {
  DriveKeys keys;
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
    const auto is_force = [](const DriveAction& a) { return a.kind == ActionKind::force; };
    if (s.ok() && std::ranges::none_of(keys.actions,
                                       [&](const DriveAction& a) { return is_force(a) && a.amount != 0.0; }))
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
  return keys;
}

}  // namespace pyroclast
