#include "pyroclast/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/simulation/body_on_ranks.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"
#include "pyroclast/simulation/skeleton.hpp"
#include "pyroclast/simulation/watching/items.hpp"

namespace pyroclast {

namespace {

TemperatureField make_field(const Model& model, const std::vector<BlockMaterial>& block_materials,
                            const HeatConditions& heat, bool loses_blocks,
                            const std::shared_ptr<Team>& team) {
  if (heat.uniform) return {model, heat.initial};
  const Interval initial{heat.initial, heat.initial};  // each exposure widens it
  return {model, make_conduction(model, block_materials, heat, initial, team, loses_blocks)};
}

/// Throws Error: a slit parts a contact whose law holds it together.
[[noreturn]] void refuse_slit(const specimen::Notch& slit, const std::string& interface,
                              const std::string& law) {
  throw Error(
      fmt::format("{}{} is a slit through contacts of {}, which the law \"{}\" never parts: give "
                  "[contacts.{}] a law that knows damage, or the notch a width",
                  slit.place.empty() ? "" : slit.place + ": ", slit.name, interface, law, interface));
}

std::unique_ptr<Motion> make_motion_at(const Model& model, const ConcreteMaterials& materials,
                                       const TemperatureField& field, const HottestTemperatures& hottest,
                                       const std::optional<PorePressures>& water,
                                       const MechanicsParameters& parameters,
                                       const std::shared_ptr<Team>& team) {
  std::vector<double> densities;
  for (const auto& material : materials.block_materials)
    densities.push_back(material.density(kReferenceTemperature));
  return make_motion(model, densities, properties_at(model, materials, field, hottest, water), parameters,
                     team);
}

std::unique_ptr<Model> required(std::unique_ptr<Model> model) {
  if (!model || model->block_count() == 0) throw Error("a body without blocks cannot be simulated");
  if (model->dimension() != 2 && model->thickness != 1.0)
    throw Error(fmt::format("the thickness of a body in space is {}, but it must be 1", model->thickness));
  return model;
}

/// Returns the gap of each contact of a part as its owner has it: a part has contacts between foreign blocks,
/// which do not move here.
std::vector<ContactGap> of_owners(const Model& part, const std::vector<ContactGap>& gaps) {
  struct OfContact {
    int contact;
    ContactGap gap;
  };
  std::vector<OfContact> own;
  const ContactsByChunk by_chunk = contacts_by_chunk(part);
  for (auto [i, last] = by_chunk.chunks.own(); i < last; ++i) {
    const int contact = by_chunk.contacts[i];
    own.push_back({part.part->contact[contact], gaps[contact]});
  }
  auto all = part.ranks().collect(own);
  std::ranges::sort(all, {}, &OfContact::contact);
  std::vector<ContactGap> result;
  for (const int contact : part.part->contact)
    result.push_back(std::ranges::lower_bound(all, contact, {}, &OfContact::contact)->gap);
  return result;
}

SpecimenNumbers required(SpecimenNumbers numbers, const std::vector<BlockMaterial>& block_materials) {
  if (numbers.fraction.size() > block_materials.size())
    throw Error(fmt::format("the specimen has shares of {} phases, but there are {} materials of blocks",
                            numbers.fraction.size(), block_materials.size()));
  if (!(numbers.size > 0.0 && numbers.block_size > 0.0 && numbers.mean_size > 0.0))
    throw Error("the sizes of a specimen and of its blocks must be greater than 0");
  return numbers;
}

}  // namespace

bool follows_composition(const std::vector<BlockMaterial>& block_materials, const MovingBody& moving) {
  return moving.strain_of_concrete || any_creeps(block_materials);
}

ConcreteMaterials make_materials(const std::vector<BlockMaterial>& block_materials, const MovingBody& moving,
                                 const SpecimenNumbers& specimen) {
  auto materials = make_concrete(block_materials, moving.contacts, specimen.mean_size, specimen.block_size);
  materials.on_cooling = moving.on_cooling;
  materials.has_found_contacts = moving.mechanics.found.is_on;
  if (follows_composition(block_materials, moving))
    follow_composition(materials, moving.contacts, moving.strain_of_concrete, specimen.fraction,
                       specimen.mean_size, specimen.dimension);
  if (moving.stress_free && !moving.stress_free->is_field())
    set_stress_free(materials, moving.stress_free->temperatures.front());
  return materials;
}

Simulation::Simulation(MadeSpecimen specimen, double thickness,
                       const std::vector<BlockMaterial>& block_materials,
                       const std::vector<SetParameters>& sets, const HeatConditions& heat,
                       const std::vector<ProbePosition>& probes, const std::vector<RecordParameters>& records,
                       const std::optional<MovingBody>& moving, std::shared_ptr<Team> team,
                       std::shared_ptr<Ranks> ranks)
    : Simulation(make_body(specimen, thickness, sets, moving), block_materials, heat, probes, records, moving,
                 std::move(team), std::move(ranks)) {
  specimen_ = std::move(specimen);
}

Simulation::Simulation(SpecimenBody body, const std::vector<BlockMaterial>& block_materials,
                       const HeatConditions& heat, const std::vector<ProbePosition>& probes,
                       const std::vector<RecordParameters>& records, const std::optional<MovingBody>& moving,
                       std::shared_ptr<Team> team, std::shared_ptr<Ranks> ranks)
    : team_(std::move(team)),
      told_(std::move(body.told)),
      model_(part_of_rank(required(std::move(body.model)), ranks, heat, block_materials,
                          foreign_blocks(moving))),
      numbers_(required(std::move(body.numbers), block_materials)),
      heat_(with_specimen(heat, block_materials, numbers_.fraction, numbers_.mean_size)),
      field_(make_field(*model_, block_materials, heat_, moving && moving->spalling, team_)) {
  if (heat_.moisture)
    moisture_ =
        std::make_unique<MoistureField>(*model_, block_materials, numbers_, *heat_.moisture, heat_.initial);
  for (const auto& probe : probes) probes_.emplace_back(*model_, probe);
  if (!moving) {
    materials_.block_materials = block_materials;
    for (const RecordParameters& record : records) records_.emplace_back(*model_, false, record);
    show_cracks();
    return;
  }
  materials_ = make_materials(block_materials, *moving, numbers_);
  std::vector<double> stress_free;
  if (moving->stress_free && moving->stress_free->is_field())
    stress_free = stress_free_gridpoints(*moving->stress_free, *model_, numbers_.mean_size);
  hottest_ = HottestTemperatures(*model_, materials_, field_, stress_free);
  const auto water = moisture_ ? moisture_->pressures(nullptr) : std::nullopt;
  motion_ = make_motion_at(*model_, materials_, field_, hottest_, water, moving->mechanics, team_);
  for (const specimen::Notch& notch : body.notches)
    if (const auto parted = model_->contact_sets.find(notch.name); parted != model_->contact_sets.end())
      for (int contact : parted->second)
        if (!motion_->break_contact(contact)) {
          const int interface = model_->joint(contact).interface;
          refuse_slit(notch, model_->interface_names[interface], materials_.contacts[interface].law->name);
        }
  begin_moving(moving->velocities);
  show_cracks();
  supports_ = std::make_unique<Supports>(*model_);
  for (const PlaneOfSymmetry& plane : model_->symmetry) drive(plane.set(), plane.component, 0.0);
  loads_ = std::make_unique<Loads>(*motion_, body_size());
  for (const RecordParameters& record : records) records_.emplace_back(*model_, true, record);
  if (moving->spalling)
    spalling_ = std::make_unique<Spalling>(*model_, block_materials, heat_, *moving->spalling);
  if (body.between_platens) press_ = std::make_unique<Press>(*motion_, *body.between_platens);
}

/// Gives sets their velocities at the start; where a gridpoint is in several, the last one counts.
void Simulation::begin_moving(const std::vector<StartVelocity>& velocities) {
  if (velocities.empty()) return;
  std::vector<Vec<3>> of_gridpoints(static_cast<std::size_t>(model_->gridpoint_count()));
  for (const StartVelocity& start : velocities) {
    const auto set = model_->sets.find(start.set);
    if (set == model_->sets.end())
      throw Error(fmt::format("{}: there is no set \"{}\"; there are {}", start.deck_place, start.set,
                              names_of(model_->sets)));
    for (const int g : set->second) of_gridpoints[g] = start.velocity;
  }
  motion_->begin_moving(of_gridpoints);
}

std::vector<std::string> Simulation::warnings_of_specimen() const {
  if (!specimen_ && !told_) return {};
  std::string line;
  if (moves()) line = skeleton(*model_, specimen_ ? stones(*specimen_) : told_->stone, materials_.contacts);
  if (!ranks().is_first()) return {};
  auto lines = specimen_ ? warnings(*specimen_) : told_->warnings;
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

const Record& Simulation::record(std::string_view name) const {
  for (const Record& record : records_)
    if (record.parameters().name == name) return record;
  throw Error(fmt::format("there is no record \"{}\"", name));
}

void Simulation::set_zero() {
  if (press_) press_->set_zero();
  for (Record& record : records_) record.set_zero(*this);
}

void Simulation::hold(const std::string& set, int component, const HeldMotion& motion,
                      const std::string& place) {
  require_there(set, place);
  supports_->hold(set, component, motion, place);
  drive(set, component, 0.0);
}

void Simulation::drive(const std::string& set, int component, double velocity) {
  for (int g : model_->set(set)) motion_->constraints().prescribe_velocity(g, component, velocity);
}

void Simulation::halt(const std::string& set, int component) {
  supports_->halt(set, component);
  drive(set, component, 0.0);
}

void Simulation::release(const std::string& set, int component, const std::string& place) {
  supports_->release(set, component, place);
  for (int g : model_->set(set))
    if (!supports_->holds(g, component)) motion_->constraints().release(g, component);
}

const char* Simulation::coupling_of_heat() const {
  return cracks_hinder_heat() ? "two-way, staggered: heat meets the cracks that the last exchange left"
                              : "one-way: the body follows its temperatures, and cracks do not hinder heat";
}

void Simulation::show_cracks() {
  if (moisture_ && moves()) moisture_->show_cracks(*motion_);
  if (!cracks_hinder_heat()) return;
  auto gaps = contact_gaps(*model_, heat_.cracks->gaps, motion_.get());
  if (model_->ranks().count() > 1) gaps = of_owners(*model_, gaps);
  field_.set_gaps(std::move(gaps));
}

void Simulation::remove(const std::vector<int>& blocks) {
  field_.remove(blocks);
  if (moisture_) moisture_->remove(blocks);
}

/// Keeps the temperatures as they are before the first piece leaves; they go on without the loss.
void Simulation::keep_unspalled() {
  if (unspalled_ || field_.is_uniform() || spalling_->rule().bars.empty()) return;
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { field_.visit_state(visitor); });
  unspalled_ =
      std::make_unique<TemperatureField>(make_field(*model_, materials_.block_materials, heat_, true, team_));
  copy.put([&](StateVisitor& visitor) { unspalled_->visit_state(visitor); });
}

void Simulation::let_pieces_go() {
  if (!spalling_) return;
  for (Spall& spall : spalling_->find(*motion_, field_, moisture_.get())) {
    std::vector<bool> leaves(static_cast<std::size_t>(model_->block_count()));
    for (const int block : spall.blocks) leaves[block] = true;
    for (const auto& [set, load] : loads_->all())
      for (const int g : model_->set(set))
        if (leaves[model_->block_of(g)])
          throw Error(
              fmt::format("block {} leaves the body at {:g} s of heating, but the load on the set "
                          "\"{}\" acts on it: load other sets, or leave [spalling] out",
                          model_->block_of(g), heating_time_, set));
    spall.heating_time = heating_time_;
    keep_unspalled();
    motion_->remove(spall.blocks);
    remove(spall.blocks);
    spalling_->note(std::move(spall));
  }
}

/// Throws Error where a gridpoint of a set has left the body.
void Simulation::require_there(const std::string& set, const std::string& place) const {
  if (!spalling_) return;
  for (const int g : model_->set(set))
    if (const int block = model_->block_of(g); is_gone(block))
      throw Error(fmt::format("{}: block {} of the set \"{}\" has left the body", place, block, set));
}

bool Simulation::cracks_outrun_water() {
  if (!moisture_ || !moisture_->is_outrun_by_cracks(*motion_)) return false;
  moisture_->hurry();
  return true;
}

void Simulation::follow_heat() {
  heating_time_ = field_.time();
  if (moisture_) moisture_->follow(field_);
  if (unspalled_) unspalled_->advance(std::numeric_limits<double>::infinity(), heating_time_);
}

void Simulation::begin_exposure(double until) {
  const Interval range = temperature_range(heat_, until);
  field_.begin_exposure(range);
  if (unspalled_) unspalled_->begin_exposure(range);
}

/// Hands the properties of materials to the mechanics, at the temperatures and pore pressures that there are.
void Simulation::hand_over(const ConcreteMaterials& materials) {
  const auto water = moisture_ ? moisture_->pressures(motion_.get()) : std::nullopt;
  earlier_ = motion_->set_properties(
      properties_at(*model_, materials, field_, hottest_, water, std::exchange(earlier_, {})));
  hottest_.note_exchange(field_);
}

double Simulation::pressure_over_strength(int contact) const {
  const double pressure = moisture_ ? moisture_->borne_pressure(nullptr, contact) : 0.0;
  if (pressure == 0.0 || is_gone(model_->block_of(model_->joint(contact).a)) ||
      damage_in_tension(*motion_, contact) > 0.0)
    return 0.0;
  const double now = field_.contacts()[contact];
  const auto strength = materials_.contacts[model_->joint(contact).interface].tensile_strength(
      now, materials_.property_temperature(now, hottest_.of_contact(contact, now)));
  return strength > 0.0 ? pressure / *strength : 0.0;
}

void Simulation::set_materials(ConcreteMaterials materials) {
  hand_over(materials);
  materials_ = std::move(materials);
}

void Simulation::visit_state(StateVisitor& visitor) {
  visitor.visit("heating_time", heating_time_);
  visitor.visit("exchanges", exchanges_, state::count());
  if (spalling_) {
    const StateVisitor::Scope scope(visitor, "spalling");
    spalling_->visit_state(visitor);
    if (visitor.replaces() && has_lost_blocks()) {
      keep_unspalled();
      for (const Spall& spall : spalling_->spalls()) remove(spall.blocks);
    }
    if (unspalled_) {
      const StateVisitor::Scope of_field(visitor, "unspalled");
      unspalled_->visit_state(visitor);
    }
  }
  {
    const StateVisitor::Scope scope(visitor, "field");
    field_.visit_state(visitor);
  }
  if (moisture_) {
    const StateVisitor::Scope scope(visitor, "moisture");
    moisture_->visit_state(visitor);
  }
  {
    const StateVisitor::Scope scope(visitor, "records");
    for (Record& record : records_) record.visit_state(visitor);
  }
  if (!moves()) return;
  {
    const StateVisitor::Scope scope(visitor, "hottest");
    hottest_.visit_state(visitor);
  }
  {
    const StateVisitor::Scope scope(visitor, "mechanics");
    motion_->visit_state(visitor);
  }
  {
    const StateVisitor::Scope scope(visitor, "loads");
    loads_->visit_state(visitor);
  }
  {
    const StateVisitor::Scope scope(visitor, "supports");
    supports_->visit_state(visitor);
  }
  if (!press_) return;
  const StateVisitor::Scope scope(visitor, "press");
  press_->visit_state(visitor);
}

double estimate_modulus(const Model& model, const ConcreteMaterials& materials, double temperature,
                        int axis) {
  const auto volumes = model.zone_volumes();
  const auto blocks = zone_blocks(model);
  double volume = 0.0, compliance = 0.0;
  constexpr int kShares = 2;  // volume, compliance
  in_slices(
      Item::zone, model, kShares,
      [&](int zone, double* share) {
        if (model.is_of_bearing(blocks[zone])) return;
        const BlockMaterial& material = materials.block_materials[model.block_material[blocks[zone]]];
        share[0] = volumes[zone];
        share[1] = volumes[zone] / material.young(temperature);
      },
      [&](std::int64_t, const std::vector<double>& shares) {
        for (std::size_t i = 0; i < shares.size(); i += kShares) {
          volume += shares[i];
          compliance += shares[i + 1];
        }
      });
  in_slices(
      Item::contact, model, 1,
      [&](int number, double* share) {
        const Joint& c = model.joint(number);
        if (model.is_of_bearing(c)) return;
        const ContactMaterial& contact = materials.contacts[c.interface];
        auto k = contact.at(temperature).stiffness();
        const double factor = contact.stiffness_between(c.block_size);
        k.normal *= factor;
        k.shear *= factor;
        const Vec<3> n = model.normal(number);
        const double normal = n[axis] * n[axis];  // traction over stress, along the normal
        double tangential = 0.0;                  // and along the face, squared
        for (int other = 0; other < 3; ++other)
          if (other != axis) tangential += n[axis] * n[other] * (n[axis] * n[other]);
        *share = c.area * (normal * normal / k.normal + tangential / k.shear);
      },
      [&](std::int64_t, const std::vector<double>& shares) {
        for (const double share : shares) compliance += share;
      });
  return model.ranks().of(0, volume / compliance);
}

double wave_time(const Simulation& simulation) {
  const Press& press = simulation.press();
  const double modulus =
      estimate_modulus(simulation.model(), simulation.materials(), simulation.field().mean(), press.axis());
  const double mass = simulation.motion().totals().total_moving_mass(press.specimen());
  return press.height() * std::sqrt(mass / press.volume() / modulus);
}

}  // namespace pyroclast
