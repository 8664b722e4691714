#include "pyroclast/stages/compress.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/compression_response.hpp"
#include "pyroclast/stages/load.hpp"

namespace pyroclast {

namespace {

/// A controlled velocity is chosen this often.
constexpr std::int64_t kStepsPerChoice = 50;
/// Change of the logarithm of a controlled velocity, from choice to choice, over that of its excess.
constexpr double kGain = 0.1;
/// A velocity may fall so much faster than rise.
constexpr double kSlowDown = 4.0;
/// Up to this share of the stop strain a stress that falls is no failure: the platen only meets the specimen.
constexpr double kFirstTouch = 0.1;
/// A gap between platen and specimen below this share of the height is none.
constexpr double kNoGap = 1e-6;
constexpr double kMostStepsPerLook = 1e9;
/// A controlled velocity takes about this share of the steps of the lowest one (validation/adaptive.md).
constexpr double kControlledShare = 0.2;

/// The velocity changes between `velocity` and `fastest_velocity`.
VelocityControl read_velocity_control(const Section& s, const Compress::Keys& keys) {
  VelocityControl c;
  c.fastest = s.quantity(
      "fastest_velocity", unit::velocity, Range::positive(),
      "highest velocity; with it the stage [chooses the velocity itself](deck.md#a-controlled-velocity)");
  if (s.ok() && c.fastest < keys.velocity) s.error("fastest_velocity", "must not be less than velocity");
  if (s.ok() && keys.ramp_time == 0.0)
    s.error("ramp_time", "must be greater than 0 with fastest_velocity: it bounds the acceleration");
  c.unbalanced_ratio =
      s.number("unbalanced_ratio", Range::positive(), "tolerance 1: unbalanced over applied forces");
  c.kinetic_over_strain =
      s.number("kinetic_over_strain", Range::positive(),
               "tolerance 2: kinetic over elastic energy; a run counts as quasi-static up to 0.01");
  c.platen_difference = s.number("platen_difference", Range::positive(),
                                 "tolerance 3: difference between the stresses on the platens over the "
                                 "largest stress so far; a run counts as quasi-static up to 0.02");
  c.dissipation_rate =
      s.quantity("dissipation_rate", unit::frequency, Range::positive(),
                 "tolerance 4: power that cracks, slip and crushing dissipate over elastic energy");
  return c;
}

std::unique_ptr<Stage> read_compress(const Section& s, const StageTables& tables) {
  Compress::Keys keys;
  keys.velocity = s.quantity("velocity", unit::velocity, Range::positive(),
                             "of the upper platen; the lowest one with fastest_velocity");
  keys.ramp_time = s.quantity(
      "ramp_time", unit::time, Range::non_negative(),
      "in which velocity is reached; greater than 0 with fastest_velocity, where it also bounds the changes");
  if (s.has("fastest_velocity"))
    keys.control = read_velocity_control(s, keys);
  else
    s.know({"unbalanced_ratio", "kinetic_over_strain", "platen_difference", "dissipation_rate"});
  keys.stop_strain =
      s.number("stop_strain", Range::inside(0.0, 1.0), "the stage ends at this strain since its beginning");
  keys.stop_fraction =
      s.number("stop_fraction_of_peak", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0,
               "the run ends when the stress has fallen below this share of its largest value");
  keys.history_strain = tables.output.history_strain;
  keys.frame_strain = tables.output.frame_strain;
  return std::make_unique<Compress>(keys);
}

}  // namespace

StageKind compress_kind() {
  return {"compress",
          "drives the upper platen down; strain counts from the beginning of the stage",
          {},
          read_compress};
}

void Compress::begin(Simulation& simulation) {
  Press<2>& press = simulation.press();
  const double gap = press.gap();
  if (gap < kNoGap * press.height()) {
    begin_loading(simulation);
    return;
  }
  press.control_by_motion(keys_.velocity);
  gap_steps_left_ = static_cast<std::int64_t>(gap / (keys_.velocity * simulation.mechanics().time_step()));
  if (gap_steps_left_ == 0) begin_loading(simulation);
}

void Compress::close_gap(Simulation& simulation, int most_steps) {
  const auto steps = std::min<std::int64_t>(gap_steps_left_, most_steps);
  simulation.mechanics().advance(static_cast<int>(steps));
  gap_steps_left_ -= steps;
  if (gap_steps_left_ == 0) begin_loading(simulation);
}

void Compress::begin_loading(Simulation& simulation) {
  simulation.press().begin_stage();
  simulation.press().control_by_motion(0.0);
  is_loading_ = true;
  next_frame_ = keys_.frame_strain;
  dissipated_ = simulation.mechanics().energy().dissipated.total();
}

std::int64_t Compress::steps_per_look(const Simulation& simulation) const {
  const double shortening_per_step = keys_.velocity * simulation.mechanics().time_step();
  const double steps = std::round(keys_.history_strain * simulation.press().height() / shortening_per_step);
  return static_cast<std::int64_t>(std::clamp(steps, 1.0, kMostStepsPerLook));
}

bool Compress::advance(Simulation& simulation, int most_steps) {
  if (!is_loading_) {
    close_gap(simulation, most_steps);
    return false;
  }
  return keys_.control ? move_controlled(simulation, most_steps) : move_at_velocity(simulation, most_steps);
}

bool Compress::move_at_velocity(Simulation& simulation, int most_steps) {
  Mechanics<2>& mechanics = simulation.mechanics();
  if (steps_left_ == 0) {
    steps_left_ = steps_per_look(simulation);
    // one look of ramp ahead, so that the ramp leaves zero
    const double ahead = keys_.ramp_time > 0.0
                             ? static_cast<double>(steps_left_) * mechanics.time_step() / keys_.ramp_time
                             : 0.0;
    const double share = ramp_share(steps_, mechanics.time_step(), keys_.ramp_time);
    simulation.press().drive(keys_.velocity * std::min(1.0, share + ahead));
  }
  const auto steps = std::min<std::int64_t>(steps_left_, most_steps);
  mechanics.advance(static_cast<int>(steps));
  steps_ += steps;
  steps_left_ -= steps;
  return steps_left_ == 0;
}

/// Moves by the strain between two looks, as fast as the tolerances bear. A velocity that changes shakes the
/// body, so it does that gently.
bool Compress::move_controlled(Simulation& simulation, int most_steps) {
  Mechanics<2>& mechanics = simulation.mechanics();
  if (steps_left_ == 0) {
    choose_velocity(simulation);
    simulation.press().drive(velocity_);
    steps_left_ = kStepsPerChoice;
  }
  const auto steps = std::min<std::int64_t>(steps_left_, most_steps);
  mechanics.advance(static_cast<int>(steps));
  steps_ += steps;
  steps_left_ -= steps;
  if (steps_left_ > 0) return false;
  way_ += velocity_ * (kStepsPerChoice * mechanics.time_step());
  if (way_ < keys_.history_strain * simulation.press().height()) return false;
  way_ = 0.0;
  return true;
}

void Compress::choose_velocity(const Simulation& simulation) {
  const double time_step = simulation.mechanics().time_step();
  const double time = kStepsPerChoice * time_step;
  const double most = time / keys_.ramp_time;
  const double share = ramp_share(steps_, time_step, keys_.ramp_time);
  if (share < 1.0) {
    velocity_ = keys_.velocity * std::min(1.0, share + 0.5 * most);
    return;
  }
  const double change = std::clamp(-kGain * std::log(excess(simulation, time)), -kSlowDown * most, most);
  velocity_ = std::clamp(velocity_ * std::exp(change), keys_.velocity, keys_.control->fastest);
}

/// How far the motion is from the tolerances: above 1, out of them. Forces out of balance go with the
/// velocity, kinetic energy with its square.
/// \param time  since the last call, s
double Compress::excess(const Simulation& simulation, double time) {
  const VelocityControl& control = *keys_.control;
  const EnergyLedger energy = simulation.mechanics().energy();
  const double elastic = energy.zones + energy.contacts;
  const double power =
      (energy.dissipated.total() - std::exchange(dissipated_, energy.dissipated.total())) / time;
  const double top = simulation.press().stress_top(), bottom = simulation.press().stress_bottom();
  const double largest = std::max(peak_stress_, 0.5 * (top + bottom));
  if (!(elastic > 0.0 && largest > 0.0)) return 1.0;  // the platen has not met the specimen yet
  return std::max({simulation.mechanics().unbalanced_ratio() / control.unbalanced_ratio,
                   std::sqrt(std::abs(energy.kinetic) / elastic / control.kinetic_over_strain),
                   std::abs(top - bottom) / largest / control.platen_difference,
                   power / elastic / control.dissipation_rate});
}

Verdict Compress::judge(Simulation& simulation) {
  const double stress = simulation.press().stress(), strain = simulation.press().stage_strain();
  peak_stress_ = std::max(peak_stress_, stress);
  if (strain >= keys_.stop_strain) return {.over = true};
  if (strain > kFirstTouch * keys_.stop_strain && stress < keys_.stop_fraction * peak_stress_)
    return {.over = true, .last = true, .outcome = Outcome::stress_fallen};
  if (strain < next_frame_) return {};
  next_frame_ += keys_.frame_strain;
  return {.frame = true};
}

double Compress::progress(const Simulation& simulation) const {
  return is_loading_ ? std::clamp(simulation.press().stage_strain() / keys_.stop_strain, 0.0, 1.0) : 0.0;
}

StageReport Compress::report(const History& history, RowRange rows, Outcome) const {
  StageReport report;
  const CompressionRows test = compression_rows(history, rows);
  const auto response = compression_response(test);
  if (!response) return report;
  const QuasiStaticReport inertia = quasi_static_report(test);
  const auto or_none = [](const std::optional<double>& value, double factor) {
    return value ? Result::Value(factor * *value) : Result::Value();
  };
  report.results = {
      {"E_GPa", or_none(response->modulus, 1e-9)},
      {"f_c_MPa", response->strength * 1e-6},
      {"strain_at_peak", response->strain_at_peak},
      {"strain_ic", or_none(response->inelastic_strain, 1.0)},
      {"peak_passed", response->peak_passed},
      {"quasi_static", inertia.to_peak},
      {"quasi_static_after_peak", inertia.after_peak},
      {"kinetic_over_elastic_to_peak", inertia.kinetic_to_peak},
      {"kinetic_over_elastic_after_peak", inertia.kinetic_after_peak},
      {"platen_difference_over_f_c_to_peak", inertia.difference_to_peak},
      {"platen_difference_over_f_c_after_peak", inertia.difference_after_peak},
  };
  report.lines.push_back(
      fmt::format("f_c {:.2f} MPa at strain {:.5f}", response->strength * 1e-6, response->strain_at_peak));
  if (response->modulus)
    report.lines.push_back(
        fmt::format("E {:.2f} GPa, eps_ic {:.5f}", *response->modulus * 1e-9, *response->inelastic_strain));
  report.lines.push_back(inertia.to_peak ? "quasi-static up to the peak" : "NOT quasi-static up to the peak");
  if (!response->peak_passed)
    report.warnings.emplace_back(
        "the stress never fell after its largest value, so f_c is only what was reached");
  if (!inertia.to_peak)
    report.warnings.push_back(fmt::format(
        "not quasi-static up to the peak: kinetic over elastic energy up to {:.1e}, "
        "platen stresses differ by up to {:.1f} % of f_c; load more slowly or take a shorter time step",
        inertia.kinetic_to_peak, 100.0 * inertia.difference_to_peak));
  return report;
}

Forecast Compress::forecast(const Simulation& simulation, Foreseen&) const {
  const double way = keys_.stop_strain * simulation.press().height();
  const double slowest = (way / keys_.velocity + 0.5 * keys_.ramp_time) / simulation.mechanics().time_step();
  return {.steps = keys_.control ? kControlledShare * slowest : slowest,
          .looks = keys_.stop_strain / keys_.history_strain,
          .frames = keys_.stop_strain / keys_.frame_strain + 1.0};
}

void Compress::visit_state(StateVisitor& visitor) {
  visitor.visit("gap_steps_left", gap_steps_left_);
  visitor.visit("is_loading", is_loading_);
  visitor.visit("steps", steps_);
  visitor.visit("steps_left", steps_left_);
  visitor.visit("velocity", velocity_);
  visitor.visit("way", way_);
  visitor.visit("dissipated", dissipated_);
  visitor.visit("peak_stress", peak_stress_);
  visitor.visit("next_frame", next_frame_);
}

}  // namespace pyroclast
