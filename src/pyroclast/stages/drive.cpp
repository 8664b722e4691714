#include "pyroclast/stages/drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/stages/drive_checks.hpp"
#include "pyroclast/stages/known_results.hpp"

namespace pyroclast {

namespace {

/// Steps between two adjustments of loads and velocities.
constexpr std::int64_t kStepsPerAdjustment = 20;
/// Steps between two readings for peaks, whatever the rows of the history are.
constexpr std::int64_t kStepsPerPoint = 100;

}  // namespace

StageKind drive_kind() {
  return {"drive",
          "holds, moves or loads sets of the specimen or of bearings",
          {},
          [](const Section& s, const StageTables& tables) {
            return std::make_unique<Drive>(read_drive_keys(s, tables));
          }};
}

Drive::Drive(DriveKeys keys) : keys_(std::move(keys)), watch_(keys_) {
  if (keys_.control) control_.emplace(keys_);
  // sized before the stage begins, because a state may be read into them
  for (auto* of_action : {&kept_.velocity, &kept_.came, &kept_.farthest})
    of_action->resize(keys_.actions.size());
  for (const DriveAction& action : keys_.actions)
    if (action.is_load()) kept_.first_loads.emplace_back();
}

void Drive::check(const Simulation& simulation, Acting& acting) const {
  if (control_) control_->check(simulation);
  check_actions(keys_, simulation, acting);
}

void Drive::check_beside(const Drive& under_way, const Simulation& simulation,
                         const Supports& supports) const {
  check_actions_beside(keys_, under_way.keys_, simulation.model(), supports);
}

std::vector<std::string> Drive::sets() const {
  std::vector<std::string> names;
  for (const DriveAction& action : keys_.actions) names.push_back(action.set);
  return names;
}

double Drive::time(const Simulation& simulation) const {
  return static_cast<double>(kept_.steps) * simulation.motion().time_step();
}

std::int64_t Drive::steps_per_look(const Simulation& simulation) const {
  const double steps = keys_.look_interval / simulation.motion().time_step() / kStepsPerAdjustment;
  return kStepsPerAdjustment * std::max<std::int64_t>(1, std::llround(steps));
}

std::int64_t Drive::steps_per_adjustment(const Simulation& simulation) const {
  return control_ ? control_->steps_per_adjustment(simulation) : kStepsPerAdjustment;
}

std::int64_t Drive::duration_in_steps(const Simulation& simulation) const {
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(whole_above(keys_.duration / simulation.motion().time_step())));
}

/// Returns the number of steps for which the present loads and velocities act.
std::int64_t Drive::steps_to_come(const Simulation& simulation, std::int64_t interval) const {
  return std::min(interval, duration_in_steps(simulation) - (kept_.steps - kept_.steps % interval));
}

void Drive::begin(Simulation& simulation) {
  if (control_) control_->begin(simulation);
  watch_.begin(simulation);
  kept_.body = figures_of(simulation);
  for (const DriveAction& action : keys_.actions)
    if (action.kind == ActionKind::release)
      for (int c : action.components) simulation.release(action.set, c, action.place);
  for (const DriveAction& action : keys_.actions)
    if (action.kind == ActionKind::hold || action.kind == ActionKind::velocity)
      for (int c : action.components) simulation.hold(action.set, c, motion_of(action), action.place);
  LoadsBySet left;
  for (const auto& [set, load] : simulation.loads().all())
    if (const SetLoad rest = without_borne(simulation.model(), simulation.supports(), set, load);
        rest != load)
      left[set] = rest;
  if (!left.empty()) simulation.loads().set(left);
  kept_.first_loads.clear();
  for (const DriveAction& action : keys_.actions)
    if (action.is_load()) kept_.first_loads.push_back(simulation.loads().on(action.set));
  // loads that are there already must be exceeded before they count as driving on
  kept_.velocity.assign(keys_.actions.size(), 0.0);
  kept_.came.assign(keys_.actions.size(), 0.0);
  const LoadsBySet loads = loads_at(keys_, 0.0, load_factor(), before());
  for (std::size_t i = 0; i < keys_.actions.size(); ++i) kept_.farthest[i] = std::abs(came(i, loads, 0.0));
}

/// Returns the function that finds the load of a set when the stage began.
LoadBefore Drive::before() const {
  return [this](const std::string& set) {
    std::size_t i = 0;
    for (const DriveAction& action : keys_.actions) {
      if (!action.is_load()) continue;
      if (action.set == set) return kept_.first_loads[i];
      ++i;
    }
    return SetLoad{};
  };
}

/// Returns how far an action has come: a displacement, the force along its direction, or a pressure.
double Drive::came(std::size_t i, const LoadsBySet& loads, double interval) const {
  const DriveAction& action = keys_.actions[i];
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

/// Lets the loads and velocities of the middle of the steps to come act.
/// \param adjustment  steps between two adjustments
void Drive::act(Simulation& simulation, std::int64_t adjustment) {
  const double interval =
      static_cast<double>(steps_to_come(simulation, adjustment)) * simulation.motion().time_step();
  const double middle = time(simulation) + 0.5 * interval;
  LoadsBySet loads;
  if (control_) control_->steer(simulation, middle, adjustment, before(), loads);
  kept_.is_driven = control_ && control_->keys().rate != 0.0;
  for (const auto& [set, load] : loads_at(keys_, middle, load_factor(), before())) loads[set] = load;
  for (std::size_t i = 0; i < keys_.actions.size(); ++i) {
    const DriveAction& action = keys_.actions[i];
    if (action.kind == ActionKind::velocity) {
      kept_.velocity[i] = part_of(keys_, action, middle, load_factor());
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

void Drive::read(const Simulation& simulation) {
  if (control_) control_->read(simulation);
}

bool Drive::advance(Simulation& simulation, int most_steps) {
  const std::int64_t interval = steps_per_adjustment(simulation);
  if (kept_.steps % interval == 0) act(simulation, interval);
  const auto steps =
      std::min<std::int64_t>(steps_to_come(simulation, interval) - kept_.steps % interval, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.steps += steps;
  if (kept_.steps % kStepsPerPoint == 0) watch_.take_peaks(simulation, kept_.driven, kept_.is_driven);
  return kept_.steps % steps_per_look(simulation) == 0 || (control_ && control_->is_lost()) ||
         kept_.steps >= duration_in_steps(simulation);
}

/// Leaves the loads as they are at the end, holds what was moved where it is, and removes the pair of a
/// control.
void Drive::halt(Simulation& simulation) {
  LoadsBySet loads = loads_at(keys_, time(simulation), load_factor(), before());
  if (control_) control_->remove_pair(simulation, loads);
  simulation.loads().set(loads);
  for (const DriveAction& action : keys_.actions)
    if (action.kind == ActionKind::velocity) simulation.halt(action.set, action.components.front());
}

void Drive::look(const Simulation& simulation) {
  watch_.look(simulation);
  ratio_seen_ = simulation.motion().totals().unbalanced_ratio();
}

Verdict Drive::judge(Simulation& simulation) {
  Verdict verdict;
  const bool is_lost = control_ && control_->is_lost();
  if (control_) control_->look();
  const double now = time(simulation);
  verdict.over = watch_.judge(now, is_lost ? control_->keys().record : "");
  if (is_lost && !verdict.over) verdict = {.over = true, .last = true, .outcome = Outcome::control_lost};
  // The loads are those of the middle of the last steps, so a ramp may end before all of it acts.
  const double acted =
      now - 0.5 * static_cast<double>(steps_per_adjustment(simulation)) * simulation.motion().time_step();
  const bool ramps_are_over =
      std::ranges::all_of(keys_.actions, [&](const DriveAction& a) { return at_most(a.ramp_time, acted); });
  if (keys_.unbalanced_ratio && ramps_are_over && ratio_seen_ < *keys_.unbalanced_ratio) verdict.over = true;
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
  verdict.frame = watch_.has_fallen() || frames > kept_.frames;
  kept_.frames = std::max(kept_.frames, frames);
  return verdict;
}

double Drive::progress(const Simulation& simulation) const {
  return std::min(1.0, time(simulation) / keys_.duration);
}

StageReport Drive::report(const History& history, RowRange rows, Outcome outcome) const {
  StageReport report;
  const bool has_rows = !rows.empty();
  const double work = has_rows ? history.values("energy_loading_J", rows).back() - watch_.first_work() : 0.0;
  report.results = {{known::steps, kept_.steps},
                    {known::unbalanced_ratio, last_value(history, "unbalanced_ratio", rows)},
                    {known::loading_work, value_if(has_rows, work)}};
  const auto of_records =
      record_results(keys_.records, watch_.peaks(), keys_.results, kept_.body, history, rows);
  report.results.insert(report.results.end(), of_records.begin(), of_records.end());
  if (has_rows) report.lines = lines_of(keys_.results, of_records);
  report.warnings = missing_peaks(keys_.records, watch_.peaks(), keys_.results);
  if (control_) control_->add_to(report, work);
  if (outcome == Outcome::control_lost)
    report.warnings.push_back(
        fmt::format("the control of {} ran away: with a positive rate the forces of the stage must open it "
                    "where they grow (turn the direction, the rate, or set and other of the record), and its "
                    "stiffness must exceed that of the softening",
                    control_->keys().record));
  if (outcome == Outcome::not_reached || outcome == Outcome::not_settled)
    for (const std::string& unmet : watch_.describe_unmet())
      report.warnings.push_back("not met within the duration: " + unmet);
  if (outcome == Outcome::not_settled)
    report.warnings.push_back(fmt::format(
        "not met within the duration: the unbalanced ratio is not below {:g}", *keys_.unbalanced_ratio));
  return report;
}

Forecast Drive::forecast(const Simulation& simulation, Foreseen&) const {
  return {.steps = keys_.duration / simulation.motion().time_step(),
          .looks = keys_.duration / keys_.look_interval,
          .frames = keys_.duration / keys_.frame_interval + (watch_.has_leading() ? 1.0 : 0.0)};
}

std::vector<Column> Drive::columns() const {
  return control_ ? OpeningControl::columns() : std::vector<Column>{};
}

std::vector<double> Drive::values() const {
  return control_ ? control_->values() : std::vector<double>{};
}

void Drive::visit_state(StateVisitor& visitor) {
  auto& [steps, frames, first_loads, velocity, came, farthest, driven, is_driven, body] =
      kept_;  // another member does not compile until it has a name here
  visitor.visit("steps", steps, state::count());
  visitor.visit("frames", frames, state::count());
  std::vector<double> numbers;
  for (const SetLoad& load : first_loads)
    numbers.insert(numbers.end(), {load.force[0], load.force[1], load.force[2], load.pressure,
                                   load.is_follower ? 1.0 : 0.0});
  const auto loads = std::ranges::count_if(keys_.actions, &DriveAction::is_load);
  visitor.visit("first_loads", numbers, state::finite().of(5 * static_cast<std::size_t>(loads)));
  if (visitor.replaces()) {
    first_loads.clear();
    for (std::size_t i = 0; i + 4 < numbers.size(); i += 5)
      first_loads.push_back(
          {{{numbers[i], numbers[i + 1], numbers[i + 2]}}, numbers[i + 3], numbers[i + 4] != 0.0});
  }
  const StateRule of_each_action = state::finite().of(keys_.actions.size());
  visitor.visit("velocity", velocity, of_each_action);
  visitor.visit("came", came, of_each_action);
  visitor.visit("farthest", farthest, of_each_action);
  visitor.visit("driven", driven);
  visitor.visit("is_driven", is_driven);
  body.visit_state(visitor);
  watch_.visit_state(visitor);
  if (control_) control_->visit_state(visitor);
}

}  // namespace pyroclast
