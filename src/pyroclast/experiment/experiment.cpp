#include "pyroclast/experiment/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pyroclast/experiment/coupling.hpp"

namespace pyroclast {

namespace {

/// Settling is looked at this often; its end needs no finer grain.
constexpr int kSettleSteps = 200;
/// The force of a ramp is adjusted this often.
constexpr int kRampSteps = 20;
/// The unbalanced ratio is looked at this often after an exchange of temperatures, and while the platen's
/// velocity is controlled.
constexpr int kCyclesPerCheck = 50;
/// Change of the logarithm of a controlled velocity, from check to check, over that of its excess.
constexpr double kGain = 0.1;
/// A velocity may fall so much faster than rise.
constexpr double kSlowDown = 4.0;
/// A platen that sinks by less than this share of the failure strain within the stated cycles is not running
/// away.
constexpr double kSlowSinking = 0.1;
/// Up to this share of the stop strain a stress that falls is no failure.
constexpr double kFirstTouch = 0.1;
/// A gap between platen and specimen below this share of the height is none.
constexpr double kNoGap = 1e-6;
/// Temperatures, K, and shares of a duration that differ by less are the same.
constexpr double kSameTemperature = 1e-6, kSameTime = 1e-9;

double mean_displacement(const Mechanics<2>& mechanics, const std::vector<int>& gridpoints, int component) {
  double sum = 0.0;
  for (int g : gridpoints) sum += mechanics.displacement(g)[component];
  return sum / static_cast<double>(gridpoints.size());
}

double mean_position(const Model<2>& model, const std::vector<int>& gridpoints, int component) {
  double sum = 0.0;
  for (int g : gridpoints) sum += model.position[g][component];
  return sum / static_cast<double>(gridpoints.size());
}

double total_force(const Mechanics<2>& mechanics, const std::vector<int>& gridpoints, int component) {
  double sum = 0.0;
  for (int g : gridpoints) sum += mechanics.force(g)[component];
  return sum;
}

}  // namespace

const char* describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::completed:
      return "every stage was completed";
    case Outcome::stress_fallen:
      return "the stress fell below the stated fraction of the peak";
    case Outcome::ran_away:
      return "the specimen failed: the upper platen ran away";
    case Outcome::interrupted:
      return "interrupted";
    case Outcome::not_settled:
      return "the body did not come to rest within the stated steps";
    case Outcome::unstable:
      return "the motion became unstable (a result is not finite)";
  }
  return "";
}

Cracks count_cracks(const Mechanics<2>& mechanics) {
  Cracks cracks;
  const auto& model = mechanics.model();
  double cracked_length = 0.0;
  const auto add = [](CrackCount& count, double damage, double length) {
    if (damage <= 0.0) return;
    ++count.softening;
    if (damage >= 1.0) ++count.broken;
    count.length += length;
  };
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& contact = model.contacts[i];
    if (contact.interface != aggregate_mortar && contact.interface != mortar_mortar) continue;
    const bool itz = contact.interface == aggregate_mortar;
    const auto h = mechanics.contact_history(i);
    const double length = contact.area / model.thickness;
    add(itz ? cracks.tension_am : cracks.tension_mm, h.tension_damage, length);
    add(itz ? cracks.shear_am : cracks.shear_mm, h.shear_damage, length);
    if (h.tension_damage > 0.0) {
      cracks.mean_opening += std::max(0.0, mechanics.opening(i) + h.closure) * length;
      cracked_length += length;
    }
  }
  if (cracked_length > 0.0) cracks.mean_opening /= cracked_length;
  return cracks;
}

Experiment::Experiment(Simulation& simulation, std::vector<Stage> stages, const SamplingParameters& sampling,
                       Observer& observer)
    : body_(simulation.body),
      materials_(simulation.materials),
      heating_(simulation.heat),
      width_(simulation.specimen.width),
      height_(simulation.specimen.height),
      mechanics_(*simulation.mechanics),
      field_(*simulation.field),
      stages_(std::move(stages)),
      sampling_(sampling),
      observer_(observer) {
  for (int c : body_.platen_contacts) mechanics_.break_contact(c);
  for (int g : body_.bottom_support)
    for (int i : {0, 1}) mechanics_.prescribe_velocity(g, i, 0.0);
  for (int g : body_.top_support) mechanics_.prescribe_velocity(g, 0, 0.0);
}

Outcome Experiment::run() {
  look();
  observer_.frame(*this, history_.back());
  for (stage_ = 0; stage_ < static_cast<int>(stages_.size()); ++stage_) {
    stage_first_step_ = mechanics_.steps();
    stage_first_strain_ = axial_strain();
    stage_first_stress_ = stress_held_;
    heat_ = {.time = heat_.time};
    progress_ = 0.0;
    const Verdict end = std::visit(
        [&](const auto& stage) {
          begin(stage);
          while (true) {
            load(stage);
            move(stage);
            look();
            const Sample& now = history_.back();
            if (!std::isfinite(now.stress()) || !std::isfinite(now.energy.kinetic))
              return Verdict{true, true, Outcome::unstable};
            if (const Verdict verdict = judge(stage, now); verdict.over) return verdict;
            if (stop_asked()) return Verdict{true, true, Outcome::interrupted};
          }
        },
        stages_[stage_]);
    observer_.frame(*this, history_.back());
    if (end.last) return end.outcome;
  }
  return Outcome::completed;
}

bool Experiment::stop_asked() {
  stop_asked_ = stop_asked_ || observer_.stop_requested();
  return stop_asked_;
}

void Experiment::look() {
  history_.push_back(measure());
  observer_.sample(*this, history_.back());
}

double Experiment::axial_strain() const {
  const double shortening =
      mean_displacement(mechanics_, body_.bottom_face, 1) - mean_displacement(mechanics_, body_.top_face, 1);
  return (shortening - shortening_at_rest_) / height_;
}

double Experiment::specimen_strain() const {
  const double shortening =
      mean_displacement(mechanics_, body_.bottom_side, 1) - mean_displacement(mechanics_, body_.top_side, 1);
  return (shortening - specimen_shortening_at_rest_) / height_;
}

double Experiment::lateral_strain() const {
  const double widening =
      mean_displacement(mechanics_, body_.right_side, 0) - mean_displacement(mechanics_, body_.left_side, 0);
  return (widening - widening_at_rest_) / width_;
}

double Experiment::stress_top() const {
  double applied = 0.0;
  for (int g : body_.top_support) applied += mechanics_.applied_force(g)[1];
  return (total_force(mechanics_, body_.top_support, 1) - applied) / (width_ * body_.model.thickness);
}

double Experiment::stress_bottom() const {
  return -total_force(mechanics_, body_.bottom_support, 1) / (width_ * body_.model.thickness);
}

bool Experiment::at_rest(const Coupling& c) const {
  return std::abs(stress_top() - stress_bottom()) < c.platen_difference &&
         mechanics_.unbalanced_ratio() < c.unbalanced_ratio;
}

Sample Experiment::measure() const {
  Sample s;
  s.stage = stage_;
  s.step = mechanics_.steps();
  s.time = mechanics_.time();
  s.heat = heat_;
  s.heat.mean = field_.mean();
  s.heat.minimum = field_.minimum();
  s.heat.maximum = field_.maximum();
  s.strain = axial_strain();
  s.stage_strain = s.strain - stage_first_strain_;
  s.specimen_strain = specimen_strain();
  s.stress_top = stress_top();
  s.stress_bottom = stress_bottom();
  s.lateral_strain = lateral_strain();
  s.unbalanced_ratio = mechanics_.unbalanced_ratio();
  s.energy = mechanics_.energy();
  const double elastic = s.energy.zones + s.energy.contacts;
  s.kinetic_over_strain = elastic > 0.0 ? std::abs(s.energy.kinetic) / elastic : 0.0;
  s.largest_jump = mechanics_.largest_relative_jump();
  s.cracks = count_cracks(mechanics_);
  return s;
}

/// Share of a ramp that is over, 0 to 1.
double Experiment::ramp_share(double ramp_time) const {
  const double elapsed = static_cast<double>(mechanics_.steps() - stage_first_step_) * mechanics_.time_step();
  return ramp_time > 0.0 ? std::min(1.0, elapsed / ramp_time) : 1.0;
}

// Settling

void Experiment::begin(const SettleStage&) {
  for (int g : body_.top_support) mechanics_.release(g, 1);
}

int Experiment::steps_to_next_look(const SettleStage& stage) const {
  const std::int64_t left = stage.most_steps - (mechanics_.steps() - stage_first_step_);
  return static_cast<int>(std::clamp<std::int64_t>(left, 1, kSettleSteps));
}

void Experiment::move(const SettleStage& stage) {
  mechanics_.advance(steps_to_next_look(stage));
}

Experiment::Verdict Experiment::judge(const SettleStage& stage, const Sample& now) {
  if (now.unbalanced_ratio < stage.unbalanced_ratio) {
    shortening_at_rest_ += now.strain * height_;
    specimen_shortening_at_rest_ += now.specimen_strain * height_;
    widening_at_rest_ += now.lateral_strain * width_;
    return {.over = true};
  }
  if (now.step - stage_first_step_ >= stage.most_steps)
    return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

// A force on the platen

void Experiment::hold_force(double stress) {
  const double force = stress * width_ * body_.model.thickness;
  const auto share = static_cast<double>(body_.top_support.size());
  for (int g : body_.top_support) mechanics_.apply_force(g, {{0.0, -force / share}});
  stress_held_ = stress;
}

void Experiment::control_by_force() {
  mechanics_.untie();
  for (int g : body_.top_support) mechanics_.release(g, 1);
  mechanics_.tie(body_.top_support, 1);
}

void Experiment::control_by_motion(double velocity) {
  mechanics_.untie();
  hold_force(0.0);
  for (int g : body_.top_support) mechanics_.prescribe_velocity(g, 1, -velocity);
}

void Experiment::begin(const LoadStage&) {
  control_by_force();
}

void Experiment::load(const LoadStage& stage) {
  const double ahead =
      stage.ramp_time > 0.0 ? 0.5 * kRampSteps * mechanics_.time_step() / stage.ramp_time : 0.0;
  const double share = std::min(1.0, ramp_share(stage.ramp_time) + ahead);
  hold_force(stage_first_stress_ + share * (stage.stress - stage_first_stress_));
}

void Experiment::move(const LoadStage& stage) {
  for (int i = 0; i < kSettleSteps; i += kRampSteps) {
    load(stage);
    mechanics_.advance(kRampSteps);
  }
}

Experiment::Verdict Experiment::judge(const LoadStage& stage, const Sample& now) {
  progress_ = ramp_share(stage.ramp_time);
  if (progress_ < 1.0) return {};
  if (now.unbalanced_ratio < stage.unbalanced_ratio) return {.over = true};
  const double after_ramp =
      static_cast<double>(now.step - stage_first_step_) - stage.ramp_time / mechanics_.time_step();
  if (after_ramp >= static_cast<double>(stage.most_steps))
    return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

// Compression

/// Brings the upper platen back to ends that it left, or that left it, while the temperature changed.
void Experiment::close_gap(double velocity) {
  const double gap = (specimen_strain() - axial_strain()) * height_;
  if (gap < kNoGap * height_) return;
  control_by_motion(velocity);
  const auto steps = static_cast<std::int64_t>(gap / (velocity * mechanics_.time_step()));
  for (std::int64_t done = 0; done < steps && !stop_asked(); done += kSettleSteps)
    mechanics_.advance(static_cast<int>(std::min<std::int64_t>(kSettleSteps, steps - done)));
  stage_first_strain_ = axial_strain();
  stage_first_step_ = mechanics_.steps();
}

void Experiment::begin(const CompressStage& stage) {
  close_gap(stage.velocity);
  control_by_motion(0.0);
  next_frame_ = sampling_.frame_strain;
  peak_stress_ = 0.0;
  velocity_ = 0.0;
  dissipated_ = mechanics_.energy().dissipated.total();
}

void Experiment::load(const CompressStage& stage) {
  if (stage.control) return;  // move_controlled
  // half a step of ramp ahead, so that the ramp leaves zero
  const double ahead =
      stage.ramp_time > 0.0 ? steps_to_next_look(stage) * mechanics_.time_step() / stage.ramp_time : 0.0;
  const double velocity = stage.velocity * std::min(1.0, ramp_share(stage.ramp_time) + ahead);
  for (int g : body_.top_support) mechanics_.prescribe_velocity(g, 1, -velocity);
}

int Experiment::steps_to_next_look(const CompressStage& stage) const {
  const double shortening_per_step = stage.velocity * mechanics_.time_step();
  const double steps = std::round(sampling_.history_strain * height_ / shortening_per_step);
  return static_cast<int>(std::clamp(steps, 1.0, 1e9));
}

void Experiment::move(const CompressStage& stage) {
  if (stage.control)
    move_controlled(stage);
  else
    mechanics_.advance(steps_to_next_look(stage));
}

/// How far the motion is from the tolerances: above 1, out of them. Forces out of balance go with the
/// velocity, kinetic energy with its square.
/// \param time  since the last call, s
double Experiment::excess(const VelocityControl& control, double time) {
  const EnergyLedger energy = mechanics_.energy();
  const double elastic = energy.zones + energy.contacts;
  const double power =
      (energy.dissipated.total() - std::exchange(dissipated_, energy.dissipated.total())) / time;
  const double top = stress_top(), bottom = stress_bottom();
  const double largest = std::max(peak_stress_, 0.5 * (top + bottom));
  if (!(elastic > 0.0 && largest > 0.0)) return 1.0;  // the platen has not met the specimen yet
  return std::max({mechanics_.unbalanced_ratio() / control.unbalanced_ratio,
                   std::sqrt(std::abs(energy.kinetic) / elastic / control.kinetic_over_strain),
                   std::abs(top - bottom) / largest / control.platen_difference,
                   power / elastic / control.dissipation_rate});
}

/// Moves by the strain between two looks, as fast as the tolerances bear. A velocity that changes shakes the
/// body, so it does that gently.
void Experiment::move_controlled(const CompressStage& stage) {
  const double time = kCyclesPerCheck * mechanics_.time_step();
  const double most = time / stage.ramp_time;
  for (double way = 0.0; way < sampling_.history_strain * height_ && !stop_asked(); way += velocity_ * time) {
    const double share = ramp_share(stage.ramp_time);
    if (share < 1.0) {
      velocity_ = stage.velocity * std::min(1.0, share + 0.5 * most);
    } else {
      const double change =
          std::clamp(-kGain * std::log(excess(*stage.control, time)), -kSlowDown * most, most);
      velocity_ = std::clamp(velocity_ * std::exp(change), stage.velocity, stage.control->fastest);
    }
    for (int g : body_.top_support) mechanics_.prescribe_velocity(g, 1, -velocity_);
    mechanics_.advance(kCyclesPerCheck);
  }
}

Experiment::Verdict Experiment::judge(const CompressStage& stage, const Sample& now) {
  peak_stress_ = std::max(peak_stress_, now.stress());
  progress_ = std::clamp(now.stage_strain / stage.stop_strain, 0.0, 1.0);
  if (now.stage_strain >= stage.stop_strain) return {.over = true, .outcome = Outcome::completed};
  // not while the platen is only meeting the specimen
  if (now.stage_strain > kFirstTouch * stage.stop_strain && now.stress() < stage.stop_fraction * peak_stress_)
    return {.over = true, .last = true, .outcome = Outcome::stress_fallen};
  if (now.stage_strain >= next_frame_) {
    observer_.frame(*this, now);
    next_frame_ += sampling_.frame_strain;
  }
  return {};
}

// Changing temperature

void Experiment::begin_heating(const Coupling& coupling) {
  if (coupling.platen == PlatenControl::fixed) {
    control_by_motion(0.0);
  } else {
    control_by_force();
    hold_force(stress_held_);
  }
  last_interval_ = temperature_interval(field_.mean());
  last_change_ = 0.0;
}

/// Which of the even intervals between frames a temperature lies in.
double Experiment::temperature_interval(double temperature) const {
  return std::floor((temperature + kSameTemperature) / sampling_.frame_temperature);
}

/// Hands the field's temperatures to the mechanics.
void Experiment::exchange() {
  heat_.exchange = ++exchanges_;
  mechanics_.set_properties(properties_at(body_.model, materials_, field_));
}

/// Steps until the body rests at its temperatures, or the stated cycles are used up. A specimen that is being
/// crushed then gets more of them, until it stops or the platen has run away. The specimen's own ends tell,
/// for a platen without load may have left them.
void Experiment::cycle(const Coupling& coupling) {
  const double before = specimen_strain();
  const bool may_fail = coupling.platen == PlatenControl::force;
  double last = before;
  heat_.cycles = 0;
  heat_.converged = false;
  while (!stop_asked()) {
    const auto left = coupling.most_cycles - heat_.cycles % coupling.most_cycles;
    const auto steps = static_cast<int>(std::min<std::int64_t>(left, kCyclesPerCheck));
    mechanics_.advance(steps);
    heat_.cycles += steps;
    const double now = specimen_strain();
    ran_away_ = may_fail && now - before > coupling.failure_strain;
    if (ran_away_) return;
    heat_.converged = heat_.cycles >= coupling.least_cycles && at_rest(coupling);
    if (heat_.converged) return;
    if (steps < left) continue;
    if (!may_fail || !(now - last > kSlowSinking * coupling.failure_strain)) return;
    last = now;
  }
}

Experiment::Verdict Experiment::judge_coupling(const Sample& now) {
  if (ran_away_) return {.over = true, .last = true, .outcome = Outcome::ran_away};
  if (progress_ >= 1.0) return {.over = true};
  const double interval = temperature_interval(now.heat.mean);
  if (interval != last_interval_) observer_.frame(*this, now);
  last_interval_ = interval;
  return {};
}

void Experiment::begin(const HeatStage& stage) {
  stage_first_temperature_ = field_.mean();
  begin_heating(stage.coupling);
}

/// Change of the specimen's free thermal strain between two temperatures: the least and the greatest of its
/// solids, or none.
Interval Experiment::free_strain_change(double from, double to) const {
  Interval change{0.0, 0.0};
  for (const auto m : {aggregate_material, mortar_material}) {
    const Curve& strain = materials_.solids[m].thermal_strain;
    const double solid = strain(to) - strain(from);
    change = {std::min(change.lower, solid), std::max(change.upper, solid)};
  }
  return change;
}

/// Moves the body to where it will come to rest at its new temperature, as far as its last change foretells:
/// evenly strained in both directions, with the platen that lies on it. Contacts keep their jumps. What is
/// left to the motion is what differs from place to place; without this the body would have to push itself
/// to its new size, and its inertia would press on the lower platen. Takes two steps, and leaves the body at
/// rest.
void Experiment::strain_evenly(const MeanStrain& strain, bool platen_follows) {
  const auto& model = body_.model;
  const Vec<2> corner = model.position[body_.bottom_side.front()];
  const double bottom = corner[1];
  const double middle =
      0.5 * (mean_position(model, body_.left_side, 0) + mean_position(model, body_.right_side, 0));
  std::vector<int> specimen, platen;
  for (int b = 0; b < model.block_count(); ++b) {
    const bool is_platen = model.block_material[b] == platen_material;
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g)
      if (!is_platen)
        specimen.push_back(g);
      else if (platen_follows && model.position[g][1] > bottom + 0.5 * height_)
        platen.push_back(g);
  }
  for (const double speed : {1.0 / mechanics_.time_step(), 0.0}) {
    for (int g : specimen) {
      const Vec<2>& x = model.position[g];
      mechanics_.prescribe_velocity(g, 0, speed * strain.lateral * (x[0] - middle));
      mechanics_.prescribe_velocity(g, 1, speed * strain.axial * (x[1] - bottom));
    }
    for (int g : platen) mechanics_.prescribe_velocity(g, 1, speed * strain.axial * height_);
    mechanics_.advance(1);
  }
  for (int g : specimen)
    for (int i : {0, 1}) mechanics_.release(g, i);
  for (int g : platen) mechanics_.release(g, 1);
}

void Experiment::load(const HeatStage& stage) {
  const double now = field_.mean();
  const double left = std::abs(stage.to - now);
  const double change = std::min(stage.coupling.increment, left);
  const bool last = left <= stage.coupling.increment + kSameTemperature;
  field_.set_uniform(last ? stage.to : now + std::copysign(change, stage.to - now));
  heat_.time += change / stage.rate;
  const MeanStrain strain{-specimen_strain(), lateral_strain()};
  exchange();
  if (!stage.coupling.predictor) return;
  if (last_change_ > 0.0) {
    const auto [least, greatest] = free_strain_change(now, field_.mean());
    const auto foreseen = [&](double after, double before) {
      return std::clamp((after - before) * change / last_change_, least, greatest);
    };
    strain_evenly(
        {foreseen(strain.axial, last_strain_.axial), foreseen(strain.lateral, last_strain_.lateral)},
        stage.coupling.platen == PlatenControl::force);
  }
  last_strain_ = strain;
  last_change_ = change;
}

Experiment::Verdict Experiment::judge(const HeatStage& stage, const Sample& now) {
  const double way = std::abs(stage.to - stage_first_temperature_);
  progress_ = way > 0.0 ? std::abs(now.heat.mean - stage_first_temperature_) / way : 1.0;
  if (std::abs(now.heat.mean - stage.to) < kSameTemperature) progress_ = 1.0;
  return judge_coupling(now);
}

void Experiment::begin(const ExposeStage& stage) {
  stage_first_temperature_ = field_.mean();
  exposure_began_ = field_.time();
  field_.begin_exposure(temperature_range(heating_, exposure_began_ + stage.duration));
  begin_heating(stage.coupling);
}

void Experiment::load(const ExposeStage& stage) {
  field_.advance(stage.coupling.increment, exposure_began_ + stage.duration);
  heat_.time = field_.time();
  exchange();
}

Experiment::Verdict Experiment::judge(const ExposeStage& stage, const Sample& now) {
  progress_ = (now.heat.time - exposure_began_) / stage.duration;
  if (progress_ > 1.0 - kSameTime) progress_ = 1.0;
  return judge_coupling(now);
}

}  // namespace pyroclast
