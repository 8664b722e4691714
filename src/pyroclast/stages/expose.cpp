#include "pyroclast/stages/expose.hpp"

#include <algorithm>
#include <limits>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

/// Change of the mean temperature over the change to the hottest boundary, about.
constexpr double kMeanChange = 0.5;

constexpr StageNeeds kExposeNeeds{
    .exchanges = true, .field = FieldChoice::computed, .frames_in_time = FramesInTime::optional};

std::unique_ptr<Stage> read_expose(const Section& s, const StageTables& tables) {
  Expose::Keys keys;
  keys.duration = s.quantity("duration", unit::time, Range::positive(), "time for which the boundaries act");
  keys.frame_interval = tables.output.frame_interval;
  keys.exchange = read_exchange(s, tables);
  if (keys.exchange.coupling.predictor)
    (s.is_table("coupling") ? *s.optional_section("coupling") : *tables.coupling_table)
        .error("predictor", "is for stages of kind \"heat\": it takes the temperature as uniform");
  return std::make_unique<Expose>(keys);
}

}  // namespace

StageKind expose_kind() {
  return {"expose", "lets heat flow by the boundaries of [heat], and the body follow; needs conduction",
          kExposeNeeds, read_expose};
}

StageNeeds Expose::needs() const {
  return kExposeNeeds;
}

void Expose::begin_change(Simulation& simulation) {
  began_ = simulation.field().time();
  next_frame_ = next_multiple(keys_.frame_interval, began_);
  simulation.begin_exposure(began_ + keys_.duration);
}

bool Expose::change(Simulation& simulation, Exchange& exchange, int) {
  if (!flow_.flows()) {
    simulation.show_cracks();
    flow_.begin(coupling().increment,
                earliest({began_ + keys_.duration, next_frame_, simulation.next_exchange_of_water()}));
  }
  if (!flow_.advance(simulation.field())) return false;
  simulation.follow_heat();
  exchange.hand_over(simulation);
  return true;
}

std::optional<double> Expose::frames_in_time() const {
  if (keys_.frame_interval == std::numeric_limits<double>::infinity()) return std::nullopt;
  return keys_.duration / keys_.frame_interval;
}

bool Expose::frame_time_came(const Simulation& simulation) {
  if (simulation.heating_time() < next_frame_) return false;
  next_frame_ = next_multiple(keys_.frame_interval, simulation.heating_time());
  return true;
}

double Expose::progress(const Simulation& simulation) const {
  const double end = began_ + keys_.duration, time = simulation.heating_time();
  return at_most(end, time) ? 1.0 : (time - began_) / keys_.duration;
}

double Expose::foreseen_change(Foreseen& foreseen) const {
  const double change = foreseen.hottest - foreseen.temperature;
  foreseen.temperature += kMeanChange * change;
  return change;
}

void Expose::visit_change(StateVisitor& visitor) {
  visitor.visit("began", began_);
  visitor.visit("next_frame", next_frame_, state::number());
  flow_.visit_state(visitor);
}

}  // namespace pyroclast
