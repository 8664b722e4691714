#include "pyroclast/simulation/loop/exchange.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Steps between two checks whether the body rests.
constexpr std::int64_t kCyclesPerCheck = 50;
/// Checks from one look at the cracks under the pressure of pore water, and at pieces that fly, to the next.
constexpr std::int64_t kChecksPerLookAtCracks = 4;
/// Sinking of a platen within the stated cycles, over the failure strain, below which it is not running away.
constexpr double kSlowSinking = 0.1;
/// Share of `platen_difference`, on the face of a block, below which forces out of balance count as none
/// without platens.
constexpr double kAsGoodAsNone = 0.1;
/// Way over the height below which the specimen touches the lower platen already.
constexpr double kTouches = 1e-7;
/// Steps of an even motion: one there, and one that halts.
constexpr std::int64_t kEvenSteps = 2;
/// Mean cycles of an exchange over the least, in a run; measured are 1.0 to 1.5
/// (validation/transient_heating.csv).
constexpr double kCyclesOverLeast = 1.3;

/// Returns how far the body has given way to its loads, as a strain.
double shortening(const Simulation& simulation) {
  return simulation.has_press() ? simulation.press().specimen_strain() : simulation.loads().give();
}

/// Returns the force by which the body as a whole is out of equilibrium, as a stress on its section, Pa.
double imbalance(const Simulation& simulation) {
  if (!simulation.has_press()) {
    return norm(simulation.motion().totals().net_force()) / simulation.area_across(simulation.body_size());
  }
  const Press& press = simulation.press();
  return std::abs(press.stress_top() - press.stress_bottom());
}

}  // namespace

const char* name(PlatenControl control) {
  return control == PlatenControl::force ? "force" : "fixed";
}

void Exchange::begin(Simulation& simulation) const {
  if (!simulation.has_press()) return;
  Press& press = simulation.press();
  if (coupling_.platen == PlatenControl::fixed) {
    press.control_by_motion(0.0);
  } else {
    press.control_by_force();
  }
}

void Exchange::hand_over(Simulation& simulation) {
  kept_.number = simulation.count_exchange();
  kept_.cycles = 0;
  kept_.converged = false;
  kept_.is_handed_over = true;
  simulation.hand_over();
}

void Exchange::move_evenly_first(const Press::EvenMotion& motion) {
  kept_.even_motion = motion;
  kept_.even_steps_left = kEvenSteps;
}

/// Takes one step of the even motion; returns true when no step was left.
bool Exchange::move_evenly(Simulation& simulation) {
  if (kept_.even_steps_left == 0) return true;
  Press& press = simulation.press();
  press.move_evenly(kept_.even_motion, kept_.even_steps_left == kEvenSteps ? 1.0 : 0.0, platen_follows());
  simulation.motion().advance(1);
  if (--kept_.even_steps_left == 0) press.end_even_motion(platen_follows());
  return false;
}

/// Begins an even motion that sets a hovering body down. The motion also halts the body, so that only the
/// contact with the platen is left to settle.
void Exchange::set_down(const Press& press) {
  if (press.stress_held() > 0.0) return;  // the force moves the body fast enough
  const Press::EvenMotion motion = press.to_touch();
  if (press.way(motion) > kTouches * press.height()) move_evenly_first(motion);
}

bool Exchange::advance(Simulation& simulation, int most_steps) {
  if (!go_on(simulation, most_steps)) return false;
  simulation.let_pieces_go();
  return true;
}

bool Exchange::begins() const {
  return kept_.is_handed_over && !kept_.is_cut_short && kept_.even_steps_left == 0;
}

void Exchange::read_start(const Simulation& simulation) {
  if (!begins()) return;
  strain_at_start_ = simulation.has_press() ? shortening(simulation) : 0.0;
  ways_at_start_ = simulation.loads().ways();
}

bool Exchange::go_on(Simulation& simulation, int most_steps) {
  if (!move_evenly(simulation)) return false;
  const bool may_fail = platen_follows();
  if (begins()) {
    simulation.loads().mark(ways_at_start_);
    kept_.strain_before = kept_.last_strain = strain_at_start_;
  }
  kept_.is_handed_over = kept_.is_cut_short = false;
  const std::int64_t done = kept_.cycles % coupling_.most_cycles;
  const std::int64_t to_check =
      std::min(coupling_.most_cycles - done, kCyclesPerCheck - done % kCyclesPerCheck);
  const auto steps = std::min<std::int64_t>(to_check, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.cycles += steps;
  if (steps < to_check) return false;
  const auto [now, is_supported, is_still] = read(simulation);
  kept_.ran_away = may_fail && now - kept_.strain_before > coupling_.failure_strain;
  if (kept_.ran_away) return true;
  const bool looks_at_cracks = kept_.cycles % (kChecksPerLookAtCracks * kCyclesPerCheck) == 0;
  if (looks_at_cracks && (simulation.cracks_outrun_water() || simulation.pieces_fly())) {
    kept_.is_cut_short = true;
    return true;
  }
  if (kept_.cycles >= coupling_.least_cycles) {
    kept_.converged = is_supported && is_still;
    if (kept_.converged) return true;
    if (!is_supported && platen_follows()) set_down(simulation.press());
  }
  if (kept_.cycles % coupling_.most_cycles != 0) return false;
  if (!may_fail || !(now - kept_.last_strain > kSlowSinking * coupling_.failure_strain)) return true;
  kept_.last_strain = now;
  return false;
}

Exchange::Seen Exchange::read(const Simulation& simulation) const {
  return simulation.ranks().together([&] {
    Seen seen{shortening(simulation)};
    if (kept_.cycles < coupling_.least_cycles) return seen;
    seen.is_supported = !simulation.has_press() || simulation.press().is_supported();
    seen.is_still = is_still(simulation);
    return seen;
  });
}

/// Tells whether the body is at rest. Takes all sums before it decides, see Ranks::together.
bool Exchange::is_still(const Simulation& simulation) const {
  const MotionTotals& totals = simulation.motion().totals();
  const double out_of_balance = imbalance(simulation), ratio = totals.unbalanced_ratio();
  const double mean_force = simulation.has_press() ? 0.0 : totals.mean_unbalanced_force();
  if (out_of_balance >= coupling_.platen_difference) return false;
  if (ratio < coupling_.unbalanced_ratio) return true;
  // A body that expands freely bears no forces to compare with. Forces that are out of balance at each block
  // alike, as where all of the body still grows, add up over the body.
  const double block = simulation.numbers().block_size;
  return !simulation.has_press() &&
         mean_force * (simulation.body_size() / block) <
             kAsGoodAsNone * coupling_.platen_difference * simulation.area_across(block);
}

std::vector<Column> Exchange::columns() {
  return {{"exchange", "1", "number of the exchange of temperatures in the run, from 1", ColumnRole::exchange,
           "exchange"},
          {"cycles", "1", "steps that the exchange took", ColumnRole::exchange, "cycles"},
          {"converged", "1", "1 where the body came to rest, else 0", ColumnRole::exchange, "converged"}};
}

std::vector<double> Exchange::values() const {
  return {static_cast<double>(kept_.number), static_cast<double>(kept_.cycles), kept_.converged ? 1.0 : 0.0};
}

double Exchange::expected_cycles() const {
  const auto least = static_cast<double>(std::max(coupling_.least_cycles, kCyclesPerCheck));
  return std::min(kCyclesOverLeast * least, static_cast<double>(coupling_.most_cycles));
}

void Exchange::visit_state(StateVisitor& visitor) {
  auto& [number, cycles, converged, ran_away, is_handed_over, is_cut_short, even_steps_left, even_motion,
         strain_before, last_strain] = kept_;  // another member does not compile until it has a name here
  visitor.visit("exchange", number, state::count());
  visitor.visit("cycles", cycles, state::count());
  visitor.visit("converged", converged);
  visitor.visit("ran_away", ran_away);
  visitor.visit("is_handed_over", is_handed_over);
  visitor.visit("is_cut_short", is_cut_short);
  visitor.visit("even_steps_left", even_steps_left, state::within(0, kEvenSteps));
  visitor.visit("even_axial", even_motion.axial);
  visitor.visit("even_lateral", even_motion.lateral);
  visitor.visit("even_lift", even_motion.lift);
  for (std::size_t d = 0; d < even_motion.tilt.size(); ++d)
    visitor.visit(fmt::format("even_tilt_{}", d), even_motion.tilt[d]);
  visitor.visit("even_platen_lift", even_motion.platen_lift);
  visitor.visit("strain_before", strain_before);
  visitor.visit("last_strain", last_strain);
}

}  // namespace pyroclast
