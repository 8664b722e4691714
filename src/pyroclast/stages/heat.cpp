#include "pyroclast/stages/heat.hpp"

#include <algorithm>
#include <cmath>

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

namespace {

std::unique_ptr<Stage> read_heat_stage(const Section& s, const StageTables& tables) {
  Heat::Keys keys;
  keys.to = s.quantity("to", unit::temperature, Range::at_least(absolute_zero).usually(-50.0, 1300.0),
                       "temperature at the end");
  keys.rate = s.quantity("rate", unit::heating_rate, Range::positive().usually(1e-4, 10.0),
                         "change of the temperature over the time, up or down");
  keys.exchange = read_exchange(s, tables);
  return std::make_unique<Heat>(keys);
}

/// Bounds of the change of the specimen's strain between two temperatures, along the load and across it.
struct StrainChange {
  Interval axial{0.0, 0.0}, lateral{0.0, 0.0};
};

/// Returns bounds that hold no change and the changes of all materials: their free thermal strain, and this
/// strain with the creep under a stress on the platens.
StrainChange strain_change(const Simulation& simulation, double stress, double from, double to) {
  const auto widen = [](Interval& change, double strain) {
    change = {std::min(change.lower, strain), std::max(change.upper, strain)};
  };
  const HottestTemperatures& hottest = simulation.hottest();
  StrainChange change;
  for (const BlockMaterial& material : simulation.materials().block_materials) {
    if (material.is_of_bearing) continue;
    const double thermal =
        material.free_strain(to, hottest.of_body(to)) - material.free_strain(from, hottest.of_body(from));
    for (Interval* direction : {&change.axial, &change.lateral}) widen(*direction, thermal);
    if (!material.creep) continue;
    const CreepIncrement creep = material.creep->between(hottest.of_body(kReferenceTemperature), to);
    const double along = creep.compliance * stress;
    widen(change.axial, thermal + along);
    widen(change.lateral, thermal - creep.poisson * along);
  }
  return change;
}

}  // namespace

StageKind heat_kind() {
  return {"heat",
          "changes the temperature of the whole specimen evenly, up or down; needs a uniform field",
          {.exchanges = true, .field = FieldChoice::uniform},
          read_heat_stage};
}

void Heat::begin_change(Simulation&) {
  last_change_ = 0.0;
}

void Heat::read_before_change(const Simulation& simulation) {
  if (!coupling().predictor) return;
  const Press& press = simulation.press();
  strain_ = {.axial = -press.specimen_strain(), .lateral = press.lateral_strain()};
  stress_ = -press.stress();
}

/// Changes the temperature and hands it over. The predictor moves the body to where it will come to rest at
/// its new temperature, as far as its last change foretells. Only the differences from place to place are
/// left to the motion.
bool Heat::change(Simulation& simulation, Exchange& exchange, int) {
  TemperatureField& field = simulation.field();
  const double now = field.mean();
  const double left = std::abs(keys_.to - now);
  const double change = std::min(coupling().increment, left);
  const bool last = left <= coupling().increment + kSameTemperature;
  field.set_uniform(last ? keys_.to : now + std::copysign(change, keys_.to - now));
  simulation.set_heating_time(simulation.heating_time() + change / keys_.rate);
  const StrainChange possible =
      coupling().predictor ? strain_change(simulation, stress_, now, field.mean()) : StrainChange();
  exchange.hand_over(simulation);
  if (coupling().predictor) {
    if (last_change_ > 0.0) {
      const auto foreseen = [&](double after, double before, const Interval& bounds) {
        return std::clamp((after - before) * change / last_change_, bounds.lower, bounds.upper);
      };
      exchange.move_evenly_first(
          {.axial = foreseen(strain_.axial, last_strain_.axial, possible.axial),
           .lateral = foreseen(strain_.lateral, last_strain_.lateral, possible.lateral)});
    }
    last_strain_ = strain_;
    last_change_ = change;
  }
  return true;
}

double Heat::progress(const Simulation& simulation) const {
  const double mean = simulation.field().mean();
  const double way = std::abs(keys_.to - first_temperature());
  if (std::abs(mean - keys_.to) < kSameTemperature || way == 0.0) return 1.0;
  return std::abs(mean - first_temperature()) / way;
}

double Heat::foreseen_change(Foreseen& foreseen) const {
  const double change = std::abs(keys_.to - foreseen.temperature);
  foreseen.temperature = keys_.to;
  return change;
}

void Heat::visit_change(StateVisitor& visitor) {
  visitor.visit("last_strain_axial", last_strain_.axial);
  visitor.visit("last_strain_lateral", last_strain_.lateral);
  visitor.visit("last_change", last_change_);
}

}  // namespace pyroclast
