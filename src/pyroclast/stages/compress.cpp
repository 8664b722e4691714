#include "pyroclast/stages/compress.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/compression_response.hpp"
#include "pyroclast/stages/load.hpp"

namespace pyroclast {

namespace {

/// Steps between two choices of a controlled velocity.
constexpr std::int64_t kStepsPerChoice = 50;
/// Change of the logarithm of a controlled velocity at a choice, over minus the logarithm of the excess.
constexpr double kGain = 0.1;
/// Fastest fall of a velocity over its fastest rise.
constexpr double kSlowDown = 4.0;
/// Strain between two points of the curve from which the results are read.
constexpr double kPointStrain = 1e-5;
/// Gap between platen and specimen, over the height, below which there is none.
constexpr double kNoGap = 1e-6;
constexpr double kMostSteps = 1e9;
/// Strain up to which a stage seeks its stress where the deck does not say.
constexpr double kLatestStrain = 0.02;
/// Strain at which a stress is probably reached.
constexpr double kExpectedStrain = 0.001;
/// Strain limit of a stage that ends at a strain of the test, which it reaches before.
constexpr double kNoStopStrain = 1.0;
/// Mean strain rate of a controlled velocity over its dissipation_rate, about: 0.8e-3 to 1.3e-3 were
/// measured.
constexpr double kStrainOfControl = 1.1e-3;

/// Reads the control of a velocity that changes between `velocity` and `fastest_velocity`.
VelocityControl read_velocity_control(const Section& s, const Compress::Keys& keys) {
  VelocityControl c;
  c.fastest =
      s.quantity("fastest_velocity", unit::velocity, Range::positive(),
                 "highest velocity; with this key the stage [chooses the velocity itself](../do/speed.md)");
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

/// Reads the end of the stage: a strain since its beginning, or a strain or stress of the test.
void read_end(const Section& s, Compress::Keys& keys) {
  constexpr Meaning kStrain =
      "strain since the beginning of the stage, up or down, at which it ends at the latest";
  const Range strains = Range::inside(0.0, 1.0).usually(0.0, 0.1);
  if (s.has("to_strain")) {
    keys.until = CompressUntil::strain;
    keys.to =
        s.number("to_strain", Range::inside(-1.0, 1.0).usually(-0.1, 0.1),
                 "the stage ends at this strain of the test: the platen moves down to a larger one, and "
                 "up to a smaller");
    keys.stop_strain = kNoStopStrain;
    if (s.has("to_stress")) s.error("to_stress", "either to_strain or to_stress; not both");
  } else if (s.has("to_stress")) {
    keys.until = CompressUntil::stress;
    keys.to = s.quantity("to_stress", unit::stress, Range::non_negative().usually(0.0, 200e6),
                         "the stage ends at this stress on the upper platen: the platen moves down to a "
                         "larger one, and up to a smaller");
    keys.stop_strain = s.number("stop_strain", strains, kLatestStrain, kStrain);
  } else {
    keys.stop_strain = s.number("stop_strain", strains, kStrain);
  }
}

std::unique_ptr<Stage> read_compress(const Section& s, const StageTables& tables) {
  Compress::Keys keys;
  keys.velocity = s.quantity("velocity", unit::velocity, Range::positive().usually(1e-6, 0.01),
                             "of the upper platen; the lowest one with fastest_velocity");
  keys.ramp_time = s.quantity("ramp_time", unit::time, Range::non_negative(),
                              "in which the platen reaches velocity; greater than 0 with fastest_velocity, "
                              "whose changes it bounds too");
  if (s.has("fastest_velocity"))
    keys.control = read_velocity_control(s, keys);
  else
    s.know({"unbalanced_ratio", "kinetic_over_strain", "platen_difference", "dissipation_rate"});
  read_end(s, keys);
  keys.stop_fraction = s.number(
      "stop_fraction_of_peak", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0,
      "the run ends when the stress has passed its peak, f_c, and fallen below this share of it; 0: never");
  if (tables.coupling_table) keys.rest = tables.coupling.platen_difference;
  keys.history_strain = tables.output.history_strain;
  keys.frame_strain = tables.output.frame_strain;
  return std::make_unique<Compress>(keys);
}

}  // namespace

StageKind compress_kind() {
  return {"compress", "drives the upper platen down, or up to unload", {}, read_compress};
}

void Compress::begin(Simulation& simulation) {
  Press& press = simulation.press();
  kept_.first_left = left(simulation);
  kept_.is_upwards = kept_.first_left < 0.0;
  kept_.wave_time = wave_time(simulation);
  const double gap = press.gap();
  if (kept_.is_upwards || gap < kNoGap * press.height()) {
    begin_loading(simulation);
    return;
  }
  press.control_by_motion(keys_.velocity);
  kept_.gap_steps_left =
      static_cast<std::int64_t>(whole_below(gap / (keys_.velocity * simulation.motion().time_step())));
  if (kept_.gap_steps_left == 0) begin_loading(simulation);
}

void Compress::close_gap(Simulation& simulation, int most_steps) {
  const auto steps = std::min<std::int64_t>(kept_.gap_steps_left, most_steps);
  simulation.motion().advance(static_cast<int>(steps));
  kept_.gap_steps_left -= steps;
  if (kept_.gap_steps_left == 0) begin_loading(simulation);
}

void Compress::begin_loading(Simulation& simulation) {
  simulation.press().begin_stage();
  // while a force that is held still acts: forces are those of the last step
  const CompressionPoint point = point_of(simulation.press(), simulation.motion());
  take_point(simulation, point);
  simulation.press().control_by_motion(0.0);
  kept_.is_loading = true;
  kept_.next_frame = keys_.frame_strain;
  kept_.dissipated = point.energy.dissipated.total();
}

/// Returns the steps in which the platen moves by a strain at its full velocity.
std::int64_t Compress::steps_in(const Simulation& simulation, double strain) const {
  const double shortening_per_step = keys_.velocity * simulation.motion().time_step();
  const double steps = std::round(strain * simulation.press().height() / shortening_per_step);
  return static_cast<std::int64_t>(std::clamp(steps, 1.0, kMostSteps));
}

void Compress::take_point(const Simulation& simulation, const CompressionPoint& point) {
  kept_.curve.add(point, simulation.motion().time());
  const double time = static_cast<double>(kept_.steps) * simulation.motion().time_step();
  if (time < kPassages * kept_.wave_time) return;
  kept_.peak.take(kept_.curve.strain.back(), kept_.curve.stress.back(), strength_rule(keys_.rest));
  kept_.largest_stress = std::max(kept_.largest_stress, kept_.curve.stress.back());
}

bool Compress::advance(Simulation& simulation, int most_steps) {
  if (!kept_.is_loading) {
    close_gap(simulation, most_steps);
    return false;
  }
  return keys_.control ? move_controlled(simulation, most_steps) : move_at_velocity(simulation, most_steps);
}

bool Compress::move_at_velocity(Simulation& simulation, int most_steps) {
  Motion& motion = simulation.motion();
  if (kept_.steps_left == 0) kept_.steps_left = steps_in(simulation, keys_.history_strain);
  if (kept_.steps_to_point == 0) {
    kept_.steps_to_point = steps_in(simulation, kPointStrain);
    // the velocity is that of the ramp one point ahead, so that it leaves zero
    const double ahead = keys_.ramp_time > 0.0 ? static_cast<double>(kept_.steps_to_point) *
                                                     motion.time_step() / keys_.ramp_time
                                               : 0.0;
    const double share = ramp_share(kept_.steps, motion.time_step(), keys_.ramp_time);
    simulation.press().move_platen(direction() * keys_.velocity * std::min(1.0, share + ahead));
  }
  const auto steps = std::min<std::int64_t>({kept_.steps_left, kept_.steps_to_point, most_steps});
  motion.advance(static_cast<int>(steps));
  kept_.steps += steps;
  kept_.steps_left -= steps;
  kept_.steps_to_point -= steps;
  if (kept_.steps_to_point == 0) take_point(simulation, point_of(simulation.press(), motion));
  return kept_.steps_left == 0;
}

/// Moves on towards the next look, as fast as the tolerances bear; returns true when the look is reached. A
/// change of the velocity shakes the body, so the velocity changes gently.
bool Compress::move_controlled(Simulation& simulation, int most_steps) {
  Motion& motion = simulation.motion();
  if (kept_.steps_left == 0) {
    choose_velocity(simulation);
    simulation.press().move_platen(direction() * kept_.velocity);
    kept_.steps_left = kStepsPerChoice;
  }
  const auto steps = std::min<std::int64_t>(kept_.steps_left, most_steps);
  motion.advance(static_cast<int>(steps));
  kept_.steps += steps;
  kept_.steps_left -= steps;
  if (kept_.steps_left > 0) return false;
  point_ = point_of(simulation.press(), motion);
  const auto came_by = [&](double& way, double strain) {
    way += kept_.velocity * (kStepsPerChoice * motion.time_step());
    if (way < strain * simulation.press().height()) return false;
    way = 0.0;
    return true;
  };
  if (came_by(kept_.way_to_point, kPointStrain)) take_point(simulation, *point_);
  return came_by(kept_.way, keys_.history_strain);
}

void Compress::choose_velocity(const Simulation& simulation) {
  const double time_step = simulation.motion().time_step();
  const double time = kStepsPerChoice * time_step;
  const double most = time / keys_.ramp_time;
  const double share = ramp_share(kept_.steps, time_step, keys_.ramp_time);
  if (share < 1.0) {
    kept_.velocity = keys_.velocity * std::min(1.0, share + 0.5 * most);
    return;
  }
  const CompressionPoint point = point_ ? *point_ : point_of(simulation.press(), simulation.motion());
  const double change = std::clamp(-kGain * std::log(excess(point, time)), -kSlowDown * most, most);
  kept_.velocity = std::clamp(kept_.velocity * std::exp(change), keys_.velocity, keys_.control->fastest);
}

/// Returns how far the motion is from the tolerances; above 1 it is out of them. Forces out of balance go
/// with the velocity, kinetic energy with its square.
/// \param time  time since the last call, s
double Compress::excess(const CompressionPoint& point, double time) {
  const VelocityControl& control = *keys_.control;
  const EnergyLedger& energy = point.energy;
  const double elastic = energy.elastic();
  const double power =
      (energy.dissipated.total() - std::exchange(kept_.dissipated, energy.dissipated.total())) / time;
  const double largest = std::max(kept_.largest_stress, point.stress());
  if (!(elastic > 0.0 && largest > 0.0)) return 1.0;  // the platen has not met the specimen yet
  return std::max({point.unbalanced_ratio / control.unbalanced_ratio,
                   std::sqrt(std::abs(energy.kinetic) / elastic / control.kinetic_over_strain),
                   std::abs(point.stress_top - point.stress_bottom) / largest / control.platen_difference,
                   power / elastic / control.dissipation_rate});
}

/// Returns the distance to the end of the stage, strain or Pa; negative upwards.
double Compress::left(const Simulation& simulation) const {
  const Press& press = simulation.press();
  switch (keys_.until) {
    case CompressUntil::strain:
      return keys_.to - press.strain();
    case CompressUntil::stress:
      return keys_.to - press.stress_top();
    case CompressUntil::stop_strain:
      break;
  }
  return keys_.stop_strain - press.stage_strain();
}

void Compress::look(const Simulation& simulation) {
  strain_seen_ = simulation.press().stage_strain();
  left_seen_ = left(simulation);
  stress_seen_ = simulation.press().stress();
}

Verdict Compress::judge(Simulation&) {
  if (direction() * *left_seen_ <= 0.0) return {.over = true};
  if (std::abs(strain_seen_) >= keys_.stop_strain)
    return {.over = true, .last = true, .outcome = Outcome::not_reached};
  if (kept_.peak.is_found() && stress_seen_ < keys_.stop_fraction * kept_.peak.size())
    return {.over = true, .last = true, .outcome = Outcome::stress_fallen};
  if (std::abs(strain_seen_) < kept_.next_frame) return {};
  kept_.next_frame += keys_.frame_strain;
  return {.frame = true};
}

double Compress::progress(const Simulation& simulation) const {
  if (!kept_.is_loading) return 0.0;
  const double now = left_seen_ ? *left_seen_ : left(simulation);
  return std::clamp(1.0 - now / kept_.first_left, 0.0, 1.0);
}

/// Returns the first row of the stage that is not before the peak; none without a peak.
std::optional<std::size_t> Compress::row_of_peak(const History& history, RowRange rows) const {
  if (!kept_.peak.is_found()) return std::nullopt;
  const auto strain = history.values("stage_strain", rows);
  const auto row = std::ranges::find_if(strain, [&](double s) { return s >= kept_.peak.driven(); });
  return row == strain.end() ? std::nullopt : std::optional<std::size_t>(row - strain.begin());
}

StageReport Compress::report(const History& history, RowRange rows, Outcome) const {
  const bool to_a_value = keys_.until != CompressUntil::stop_strain;
  const auto report_of = [&](bool is_upwards) {
    return compression_report(kept_.curve, {.is_upwards = is_upwards,
                                            .to_a_value = to_a_value,
                                            .waves_until = kPassages * kept_.wave_time,
                                            .rest = keys_.rest});
  };
  StageReport report = report_of(kept_.is_upwards);
  report.decided_at = row_of_peak(history, rows);
  if (to_a_value && kept_.curve.count() == 0) {  // the direction is not known yet
    const auto others = report_of(!kept_.is_upwards).results;
    report.results.insert(report.results.end(), others.begin(), others.end());
  }
  return report;
}

/// Returns the way that the platen will probably move, over the height.
double Compress::foreseen_strain() const {
  switch (keys_.until) {
    case CompressUntil::strain:
      return std::abs(keys_.to);
    case CompressUntil::stress:
      return std::min(keys_.stop_strain, kExpectedStrain);
    case CompressUntil::stop_strain:
      break;
  }
  return keys_.stop_strain;
}

/// Returns the steps that the platen will probably take for a way, m. A controlled velocity grows to the
/// velocity that cracks leave it, within its bounds.
double Compress::foreseen_steps(const Simulation& simulation, double way) const {
  const double time_step = simulation.motion().time_step();
  const double slowest = way / keys_.velocity + 0.5 * keys_.ramp_time;
  if (!keys_.control) return slowest / time_step;
  const double velocity =
      std::clamp(kStrainOfControl * keys_.control->dissipation_rate * simulation.press().height(),
                 keys_.velocity, keys_.control->fastest);
  const double growth = keys_.ramp_time * (0.5 + std::log(velocity / keys_.velocity));
  return std::min(way / velocity + growth, slowest) / time_step;
}

Forecast Compress::forecast(const Simulation& simulation, Foreseen&) const {
  const double strain = foreseen_strain();
  const double way = strain * simulation.press().height();
  return {.steps = foreseen_steps(simulation, way),
          .looks = strain / keys_.history_strain,
          .frames = strain / keys_.frame_strain + 1.0};
}

void Compress::visit_state(StateVisitor& visitor) {
  auto& [gap_steps_left, is_loading, is_upwards, first_left, wave_time, steps, steps_left, steps_to_point,
         velocity, way, way_to_point, dissipated, curve, peak, largest_stress, next_frame] =
      kept_;  // another member does not compile until it has a name here
  if (visitor.replaces()) {
    point_.reset();
    left_seen_.reset();
  }
  visitor.visit("gap_steps_left", gap_steps_left, state::within(0, kMostSteps));
  visitor.visit("is_loading", is_loading);
  visitor.visit("is_upwards", is_upwards);
  visitor.visit("first_left", first_left);
  visitor.visit("wave_time", wave_time);
  visitor.visit("steps", steps, state::count());
  visitor.visit("steps_left", steps_left, state::within(0, kMostSteps));
  visitor.visit("velocity", velocity);
  visitor.visit("way", way);
  visitor.visit("dissipated", dissipated);
  visitor.visit("steps_to_point", steps_to_point, state::within(0, kMostSteps));
  visitor.visit("way_to_point", way_to_point);
  visitor.visit("largest_stress", largest_stress);
  {
    const StateVisitor::Scope scope(visitor, "curve");
    curve.visit_state(visitor);
  }
  {
    const StateVisitor::Scope scope(visitor, "peak");
    peak.visit_state(visitor);
  }
  visitor.visit("next_frame", next_frame, state::number());
}

}  // namespace pyroclast
