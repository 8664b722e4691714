#include "pyroclast/stages/opening_control.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/stages/known_results.hpp"

namespace pyroclast {

namespace {

/// Interval between two adjustments of the pair of forces, which is a spring whose force stays the same for
/// so long.
struct ControlInterval {
  std::int64_t steps;  ///< steps of an interval; they divide the steps between two looks
  double stable;       ///< largest (omega t)^2 at which the sets come to rest; t: time of an interval
};
/// Measured on the disc of 500 blocks: it came to rest at 5.2, 2.5 and 1.7, and shook without bound at 10,
/// 3.3 and 1.9.
constexpr std::array<ControlInterval, 3> kControlIntervals{{{5, 5.0}, {2, 2.0}, {1, 1.5}}};
/// Share that the pair may add to the largest load, and do of the work of the loads, without a warning.
constexpr double kLeftToPair = 0.05;
/// Distance from its course at which a controlled opening of rate 0 is lost, over the body's size.
constexpr double kLost = 0.01;

}  // namespace

void OpeningControl::check(const Simulation& simulation) const {
  if (const double most = largest_stiffness(simulation); keys().stiffness > most)
    throw Error(fmt::format(
        "{}: the pair of forces shakes its sets without bound: by their mass and the time step its "
        "stiffness must be at most {:.3g} GN/m; got {:.3g} GN/m",
        keys().place, 1e-9 * most, 1e-9 * keys().stiffness));
}

void OpeningControl::begin(const Simulation& simulation) {
  steps_per_adjustment_ = 0;
  simulation.record(keys().record).require_there(simulation, keys().place);
  read(simulation);
  kept_.first_opening = kept_.last_opening = opening_;
}

void OpeningControl::read(const Simulation& simulation) {
  opening_ = simulation.record(keys().record).read(simulation);
}

/// Returns the largest stiffness of the pair with which its sets come to rest, N/m: the pair then changes at
/// each step.
double OpeningControl::largest_stiffness(const Simulation& simulation) const {
  const double step = simulation.motion().time_step();
  return kControlIntervals.back().stable /
         (simulation.record(keys().record).mobility(simulation) * step * step);
}

std::int64_t OpeningControl::steps_per_adjustment(const Simulation& simulation) const {
  if (steps_per_adjustment_ > 0) return steps_per_adjustment_;
  const double share = keys().stiffness / largest_stiffness(simulation);
  steps_per_adjustment_ = kControlIntervals.back().steps;
  for (const auto& [steps, stable] : kControlIntervals)
    if (share * static_cast<double>(steps * steps) * kControlIntervals.back().stable <= stable) {
      steps_per_adjustment_ = steps;
      break;
    }
  return steps_per_adjustment_;
}

void OpeningControl::steer(const Simulation& simulation, double time, std::int64_t interval,
                           const LoadBefore& before, LoadsBySet& loads) {
  const Record& record = simulation.record(keys().record);
  kept_.pair_work += kept_.pair_force * (opening_ - kept_.last_opening);
  kept_.last_opening = opening_;
  const double behind = kept_.first_opening + keys().rate * time - opening_;
  kept_.pair_force = keys().stiffness * behind;
  const double whole = std::abs(keys().rate) * drive_.duration;
  kept_.is_lost = std::abs(behind) > (whole > 0.0 ? whole : kLost * simulation.body_size());
  const double step = static_cast<double>(interval) * simulation.motion().time_step();
  // the parts that bear the load now bear the pair beside it
  kept_.largest_with_pair =
      std::max(kept_.largest_with_pair, total_load(before) + std::abs(kept_.pair_force));
  kept_.load_factor += kept_.pair_force / unit_force() * step / keys().response_time;
  kept_.largest_factor = std::max(kept_.largest_factor, std::abs(kept_.load_factor));
  kept_.largest_load = std::max(kept_.largest_load, total_load(before));
  const RecordParameters& of = record.parameters();
  loads[of.other] = {.force = kept_.pair_force * of.direction};
  loads[of.set] = {.force = -kept_.pair_force * of.direction};
}

void OpeningControl::look() {
  kept_.largest_pair = std::max(kept_.largest_pair, std::abs(kept_.pair_force));
}

void OpeningControl::remove_pair(const Simulation& simulation, LoadsBySet& loads) const {
  const RecordParameters& record = simulation.record(keys().record).parameters();
  loads[record.set] = loads[record.other] = {};
}

/// Returns the force that the loaded sets bear together, with the forces from before: the largest in any of
/// their directions, N. Sets that are pulled apart bear it once.
double OpeningControl::total_load(const LoadBefore& before) const {
  std::map<std::string, Vec<3>> forces;
  for (const DriveAction& action : drive_.actions)
    if (action.kind == ActionKind::force)
      forces.try_emplace(action.set, before(action.set).force).first->second +=
          (kept_.load_factor * action.amount) * action.direction;
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
double OpeningControl::unit_force() const {
  double sum = 0.0;
  for (const DriveAction& action : drive_.actions)
    if (action.kind == ActionKind::force) sum += std::abs(action.amount);
  return sum;
}

std::vector<Column> OpeningControl::columns() {
  return {{"load_factor", "1", "share of the drives' loads that a [stages.control] lets act",
           ColumnRole::control, "load_factor"},
          {"control_force_N", "N", "force of the pair that makes the controlled opening grow",
           ColumnRole::control, "force"}};
}

void OpeningControl::add_to(StageReport& report, double work) const {
  const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
  const double peak = kept_.largest_load;
  const double of_peak = std::max(0.0, share(kept_.largest_with_pair, peak) - 1.0);
  const double of_work = share(std::abs(kept_.pair_work), std::abs(work));
  report.results.push_back({known::largest_load_factor, kept_.largest_factor});
  report.results.push_back({known::control_force, share(kept_.largest_pair, peak)});
  report.results.push_back({known::load_with_control, kept_.largest_with_pair});
  report.results.push_back({known::control_error, of_peak});
  report.results.push_back({known::control_work, of_work});
  report.lines.push_back(fmt::format(
      "control of {}: the largest load is {:.4g} N, and {:.4g} N with the force of the pair beside this "
      "({:+.2g} %); the pair bore up to {:.2g} % of that load, and did {:.2g} % of the work",
      keys().record, peak, kept_.largest_with_pair, 100.0 * of_peak, 100.0 * share(kept_.largest_pair, peak),
      100.0 * of_work));
  if (std::max(of_peak, of_work) > kLeftToPair)
    report.warnings.push_back(report.lines.back() + ": a slower rate leaves the pair less");
}

void OpeningControl::visit_state(StateVisitor& visitor) {
  auto& [first_opening, last_opening, load_factor, pair_force, largest_pair, largest_factor,
         largest_with_pair, largest_load, pair_work, is_lost] = kept_;  // a new member needs a name here
  if (visitor.replaces()) steps_per_adjustment_ = 0;
  visitor.visit("first_opening", first_opening);
  visitor.visit("last_opening", last_opening);
  visitor.visit("load_factor", load_factor);
  visitor.visit("pair_force", pair_force);
  visitor.visit("largest_pair", largest_pair);
  visitor.visit("largest_factor", largest_factor);
  visitor.visit("largest_with_pair", largest_with_pair);
  visitor.visit("largest_load", largest_load);
  visitor.visit("pair_work", pair_work);
  visitor.visit("is_lost", is_lost);
}

}  // namespace pyroclast
