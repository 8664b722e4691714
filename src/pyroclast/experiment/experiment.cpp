#include "pyroclast/experiment/experiment.hpp"

#include <algorithm>
#include <cmath>

namespace pyroclast {

namespace {

/// Settling is looked at this often; its end needs no finer grain.
constexpr int kSettleSteps = 200;

double mean_displacement(const Mechanics<2>& mechanics, const std::vector<int>& gridpoints, int component) {
  double sum = 0.0;
  for (int g : gridpoints) sum += mechanics.displacement()[g][component];
  return sum / static_cast<double>(gridpoints.size());
}

double total_force(const Mechanics<2>& mechanics, const std::vector<int>& gridpoints, int component) {
  double sum = 0.0;
  for (int g : gridpoints) sum += mechanics.force()[g][component];
  return sum;
}

}  // namespace

const char* describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::completed:
      return "every stage was completed";
    case Outcome::stress_fallen:
      return "the stress fell below the stated fraction of the peak";
    case Outcome::interrupted:
      return "interrupted";
    case Outcome::not_settled:
      return "the body did not come to rest under its weight within the stated steps";
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
    const auto& state = mechanics.contacts()[i];
    const auto& h = state.history;
    const double length = contact.area / model.thickness;
    add(itz ? cracks.tension_am : cracks.tension_mm, h.tension_damage, length);
    add(itz ? cracks.shear_am : cracks.shear_mm, h.shear_damage, length);
    if (h.tension_damage > 0.0) {
      cracks.mean_opening += std::max(0.0, state.opening + h.closure) * length;
      cracked_length += length;
    }
  }
  if (cracked_length > 0.0) cracks.mean_opening /= cracked_length;
  return cracks;
}

Experiment::Experiment(const ConcreteModel& body, double width, double height, Mechanics<2>& mechanics,
                       std::vector<Stage> stages, const SamplingParameters& sampling, Observer& observer)
    : body_(body),
      width_(width),
      height_(height),
      mechanics_(mechanics),
      stages_(std::move(stages)),
      sampling_(sampling),
      observer_(observer) {
  for (int c : body.platen_contacts) mechanics_.break_contact(c);
  for (int g : body.bottom_support)
    for (int i : {0, 1}) mechanics_.prescribe_velocity(g, i, 0.0);
  for (int g : body.top_support) mechanics_.prescribe_velocity(g, 0, 0.0);
}

Outcome Experiment::run() {
  look();
  observer_.frame(*this, history_.back());
  for (stage_ = 0; stage_ < static_cast<int>(stages_.size()); ++stage_) {
    stage_first_step_ = mechanics_.steps();
    const Verdict end = std::visit(
        [&](const auto& stage) {
          begin(stage);
          while (true) {
            load(stage);
            mechanics_.advance(steps_to_next_look(stage));
            look();
            const Sample& now = history_.back();
            if (!std::isfinite(now.stress()) || !std::isfinite(now.energy.kinetic))
              return Verdict{true, true, Outcome::unstable};
            if (const Verdict verdict = judge(stage, now); verdict.over) return verdict;
            if (observer_.stop_requested()) return Verdict{true, true, Outcome::interrupted};
          }
        },
        stages_[stage_]);
    observer_.frame(*this, history_.back());
    if (end.last) return end.outcome;
  }
  return Outcome::completed;
}

void Experiment::look() {
  history_.push_back(measure());
  observer_.sample(*this, history_.back());
}

Sample Experiment::measure() const {
  Sample s;
  s.stage = stage_;
  s.step = mechanics_.steps();
  s.time = mechanics_.time();
  const double area = width_ * body_.model.thickness;
  const double shortening =
      mean_displacement(mechanics_, body_.bottom_face, 1) - mean_displacement(mechanics_, body_.top_face, 1);
  s.strain = (shortening - shortening_at_rest_) / height_;
  s.stress_top = total_force(mechanics_, body_.top_support, 1) / area;
  s.stress_bottom = -total_force(mechanics_, body_.bottom_support, 1) / area;
  const double widening =
      mean_displacement(mechanics_, body_.right_side, 0) - mean_displacement(mechanics_, body_.left_side, 0);
  s.lateral_strain = (widening - widening_at_rest_) / width_;
  s.unbalanced_ratio = mechanics_.unbalanced_ratio();
  s.energy = mechanics_.energy();
  const double elastic = s.energy.zones + s.energy.contacts;
  s.kinetic_over_strain = elastic > 0.0 ? std::abs(s.energy.kinetic) / elastic : 0.0;
  s.largest_jump = mechanics_.largest_relative_jump();
  s.cracks = count_cracks(mechanics_);
  return s;
}

void Experiment::begin(const SettleStage&) {
  for (int g : body_.top_support) mechanics_.release(g, 1);
}

int Experiment::steps_to_next_look(const SettleStage& stage) const {
  const std::int64_t left = stage.most_steps - (mechanics_.steps() - stage_first_step_);
  return static_cast<int>(std::clamp<std::int64_t>(left, 1, kSettleSteps));
}

Experiment::Verdict Experiment::judge(const SettleStage& stage, const Sample& now) {
  if (now.unbalanced_ratio < stage.unbalanced_ratio) {
    shortening_at_rest_ = now.strain * height_ + shortening_at_rest_;
    widening_at_rest_ = now.lateral_strain * width_ + widening_at_rest_;
    return {.over = true};
  }
  if (now.step - stage_first_step_ >= stage.most_steps)
    return {.over = true, .last = true, .outcome = Outcome::not_settled};
  return {};
}

void Experiment::begin(const CompressStage&) {
  next_frame_ = sampling_.frame_strain;
}

void Experiment::load(const CompressStage& stage) {
  const double elapsed = static_cast<double>(mechanics_.steps() - stage_first_step_) * mechanics_.time_step();
  const double share = stage.ramp_time > 0.0 ? std::min(1.0, elapsed / stage.ramp_time) : 1.0;
  // half a step of ramp ahead, so that the ramp leaves zero
  const double ahead =
      stage.ramp_time > 0.0 ? steps_to_next_look(stage) * mechanics_.time_step() / stage.ramp_time : 0.0;
  const double velocity = stage.velocity * std::min(1.0, share + ahead);
  for (int g : body_.top_support) mechanics_.prescribe_velocity(g, 1, -velocity);
}

int Experiment::steps_to_next_look(const CompressStage& stage) const {
  const double shortening_per_step = stage.velocity * mechanics_.time_step();
  const double steps = std::round(sampling_.history_strain * height_ / shortening_per_step);
  return static_cast<int>(std::clamp(steps, 1.0, 1e9));
}

Experiment::Verdict Experiment::judge(const CompressStage& stage, const Sample& now) {
  peak_stress_ = std::max(peak_stress_, now.stress());
  progress_ = std::clamp(now.strain / stage.stop_strain, 0.0, 1.0);
  if (now.strain >= stage.stop_strain) return {.over = true, .outcome = Outcome::completed};
  if (now.stress() < stage.stop_fraction * peak_stress_)
    return {.over = true, .last = true, .outcome = Outcome::stress_fallen};
  if (now.strain >= next_frame_) {
    observer_.frame(*this, now);
    next_frame_ += sampling_.frame_strain;
  }
  return {};
}

}  // namespace pyroclast
