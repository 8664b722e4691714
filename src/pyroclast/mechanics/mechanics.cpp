#include "pyroclast/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <omp.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Working memory of one thread for a step.
template <int Dim>
FlatArray<double> scratch_for(const Layout<Dim>& layout) {
  return FlatArray<double>(2 * Dim * kLanes * static_cast<std::size_t>(layout.most_rows));
}

}  // namespace

template <int Dim>
BodyProperties by_interface(const Model<Dim>& model, std::vector<ZoneProperties> zones,
                            std::vector<ContactProperties> interfaces) {
  BodyProperties p{std::move(zones), std::move(interfaces), {}};
  p.of_contact.reserve(model.contacts.size());
  for (const auto& c : model.contacts) p.of_contact.push_back(c.interface);
  return p;
}

template <int Dim>
Mechanics<Dim>::Mechanics(const Model<Dim>& model, const std::vector<double>& densities,
                          BodyProperties properties, const MechanicsParameters<Dim>& parameters)
    : model_(model),
      parameters_(parameters),
      properties_(std::move(properties)),
      geometry_(zone_geometry(model)),
      layout_(std::make_unique<const Layout<Dim>>(model, parameters.layout)),
      step_(step_functions<Dim>(parameters.instructions)) {
  if (Dim != 2 && parameters.kinematics == Kinematics::finite)
    throw Error("kinematics = finite: contact frames that turn are made for 2D only; use small");
  place_model();
  place_properties();
  compute_stiffness();
  set_masses(densities);
  sweep(1, Pass::measure);
  // nothing has acted yet
  for (int row = 0; row < layout_->gridpoint_rows; ++row) state_.force.row(row) = {};
}

/// Puts what does not change in its places.
template <int Dim>
void Mechanics<Dim>::place_model() {
  StepState<Dim>& s = state_;
  s.layout = layout_.get();
  s.gravity = parameters_.gravity;
  s.local_damping = parameters_.local_damping;
  s.viscous_damping = parameters_.viscous_damping;
  s.damping_form = parameters_.damping_form;
  s.kinematics = parameters_.kinematics;
  s.thickness = model_.thickness;
  const int rows = layout_->gridpoint_rows;
  s.position = RowVectors<Dim>(rows);
  s.velocity = RowVectors<Dim>(rows);
  s.force = RowVectors<Dim>(rows);
  s.stiffness = RowVectors<Dim>(rows);
  s.displacement = FlatArray<Vec<Dim>>(static_cast<std::size_t>(rows) * kLanes);
  s.step_over_mass = FlatArray<double>(static_cast<std::size_t>(rows) * kLanes);
  const auto contact_slots = static_cast<std::size_t>(layout_->contact_rows()) * kLanes;
  s.history = FlatArray<HistoryRow<Dim>>(contact_slots / kLanes);
  s.loss = FlatArray<LossRow>(contact_slots / kLanes);
  s.losing = FlatArray<std::uint8_t>(contact_slots / kLanes);
  s.contact_force = FlatArray<Vec<Dim>>(contact_slots);
  if (s.kinematics == Kinematics::finite) s.turning_force = FlatArray<Vec<Dim>>(contact_slots);
  s.constraints_of_bundle.assign(layout_->bundles.size(), -1);
  made_constraints_.assign(layout_->bundles.size(), -1);
  s.bundle_sums.resize(layout_->bundles.size());
  s.face_sums.resize(layout_->faces.size());

  s.gathered_position = FlatArray<Vec<Dim>>(s.displacement.size());
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    s.position.set(layout_->gridpoint_slot[g], model_.position[g]);
    s.gathered_position[layout_->gridpoint_slot[g]] = model_.position[g];
  }
  for (const Bundle& bundle : layout_->bundles)
    for (int lane = 0; lane < kLanes; ++lane) {
      if (bundle.block_in(lane) >= 0) continue;
      // the shape of the first, without stiffness
      for (int i = 0; i < bundle.rows; ++i)
        s.position.set(slot_of(bundle.first_row + i, lane), s.position[slot_of(bundle.first_row + i, 0)]);
    }
}

/// Puts zone and contact parameters in their places.
template <int Dim>
void Mechanics<Dim>::place_properties() {
  StepState<Dim>& s = state_;
  const auto same = [](const ZoneProperties& a, const ZoneProperties& b) {
    return a.lambda == b.lambda && a.mu == b.mu && a.thermal_strain == b.thermal_strain;
  };
  s.by_bundle = true;
  for (int b = 0; b < model_.block_count() && s.by_bundle; ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      s.by_bundle = s.by_bundle && same(properties_.zones[z], properties_.zones[model_.block_zones[b]]);
  const std::size_t rows = s.by_bundle ? layout_->bundles.size() : layout_->zone_rows;
  if (s.zone_properties.size() != rows) s.zone_properties = FlatArray<ZonePropertyRow>(rows);
  const auto place = [&](std::size_t row, int lane, const ZoneProperties& p) {
    s.zone_properties[row].lambda[lane] = p.lambda;
    s.zone_properties[row].mu[lane] = p.mu;
    s.zone_properties[row].thermal_strain[lane] = p.thermal_strain;
  };
  if (s.by_bundle) {
    for (std::size_t b = 0; b < rows; ++b)
      for (int lane = 0; lane < kLanes; ++lane)
        if (const int block = layout_->bundles[b].block_in(lane); block >= 0)
          place(b, lane, properties_.zones[model_.block_zones[block]]);
  } else {
    for (int z = 0; z < model_.zone_count(); ++z)
      place(layout_->zone_slot[z] / kLanes, layout_->zone_slot[z] % kLanes, properties_.zones[z]);
  }
  place_contact_properties();
}

template <int Dim>
void Mechanics<Dim>::place_contact_properties() {
  StepState<Dim>& s = state_;
  s.contact_constants.clear();
  for (const auto& p : properties_.contacts) s.contact_constants.emplace_back(p);
  s.set_of_faces.assign(layout_->faces.size(), -1);
  s.one_set.assign(layout_->faces.size(), 1);
  bool one_set = true;
  for (int c = 0; c < model_.contact_count(); ++c) {
    const int row = layout_->contact_slot[c] / kLanes / Dim;
    const int set = properties_.of_contact[c];
    if (s.set_of_faces[row] < 0) s.set_of_faces[row] = set;
    if (s.set_of_faces[row] != set) s.one_set[row] = 0;
    one_set = one_set && s.one_set[row] != 0;
  }
  if (one_set) return;
  if (s.contact_constants_rows.empty())
    s.contact_constants_rows = FlatArray<ContactConstantsRow>(layout_->contact_rows());
  const auto place = [&](int row, int lane, const ContactConstants& constants) {
    int i = 0;
    for_each_number(constants,
                    [&](double value) { s.contact_constants_rows[row].number[i++][lane] = value; });
  };
  for (int row = 0; row < Dim * layout_->face_rows(); ++row)  // for idle lanes
    for (int lane = 0; lane < kLanes; ++lane)
      place(row, lane, s.contact_constants[s.set_of_faces[row / Dim]]);
  for (int c = 0; c < model_.contact_count(); ++c)
    place(layout_->contact_slot[c] / kLanes, layout_->contact_slot[c] % kLanes,
          s.contact_constants[properties_.of_contact[c]]);
}

/// k_gp of Eq. (9): for every gridpoint the largest sum of |stiffness| over a row of the assembled matrix,
/// zones and contacts. By Gershgorin's theorem no natural frequency exceeds sqrt(k_gp / m), so the step is
/// safe for any shape.
template <int Dim>
void Mechanics<Dim>::compute_stiffness() {
  FlatArray<double> scratch = scratch_for(*layout_);
  step_.sum_stiffness(state_, scratch.data());
  stiffness_.resize(model_.position.size());
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    const Vec<Dim> row = state_.stiffness[layout_->gridpoint_slot[g]];
    stiffness_[g] = *std::max_element(row.c.begin(), row.c.end());
  }
}

template <int Dim>
void Mechanics<Dim>::set_masses(const std::vector<double>& densities) {
  gravity_mass_.assign(model_.position.size(), 0.0);
  for (int b = 0; b < model_.block_count(); ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      for (int g : model_.zones[z])
        gravity_mass_[g] += densities[model_.block_material[b]] * geometry_.volume[z] / (Dim + 1);
  for (double m : gravity_mass_) real_mass_ += m;
  if (norm(parameters_.gravity) > 0.0) {
    state_.real_mass = FlatArray<double>(state_.displacement.size());
    for (int g = 0; g < model_.gridpoint_count(); ++g)
      state_.real_mass[layout_->gridpoint_slot[g]] = gravity_mass_[g];
  }

  if (parameters_.mass == MassChoice::real) {
    mass_ = gravity_mass_;
    moving_mass_ = real_mass_;
    state_.time_step = real_mass_limit().step;
    set_step_over_mass();
  } else {
    scale_masses();
  }
}

/// Density scaling: the mass with which each gridpoint's own limit is the common step.
template <int Dim>
void Mechanics<Dim>::scale_masses() {
  state_.time_step = parameters_.time_step;
  const double half = 0.5 * time_step() / parameters_.safety;
  mass_.resize(stiffness_.size());
  moving_mass_ = 0.0;
  for (std::size_t g = 0; g < mass_.size(); ++g) {
    const double mass = stiffness_[g] * (1.0 + parameters_.local_damping) * half * half;
    // of the half step begun with the old mass; nothing moves yet when the first masses are made
    const Vec<Dim> v = velocity(static_cast<int>(g));
    begun_mass_scaling_ += 0.5 * (mass - mass_[g]) * dot(v, v);
    mass_[g] = mass;
    moving_mass_ += mass;
  }
  set_step_over_mass();
}

template <int Dim>
void Mechanics<Dim>::set_step_over_mass() {
  std::fill(state_.step_over_mass.begin(), state_.step_over_mass.end(), 1.0);  // idle ones never move
  for (std::size_t g = 0; g < mass_.size(); ++g)
    state_.step_over_mass[layout_->gridpoint_slot[g]] = time_step() / mass_[g];
}

template <int Dim>
void Mechanics<Dim>::set_properties(BodyProperties properties) {
  // The ledger counts the work of forces by the trapezoidal rule. So the change is made at the displacements
  // of the last step's forces, and the half step already begun with the old ones is made good.
  const EnergyLedger before = energy();
  const double held_before = before.zones + before.contacts + before.dissipated.total();
  properties_ = std::move(properties);
  place_properties();
  const std::vector<Vec<Dim>> next(state_.displacement.begin(), state_.displacement.end());
  const auto old_force = force();
  const double begun = steps_ > 0 ? time_step() : 0.0;
  for (std::size_t slot = 0; slot < next.size(); ++slot)
    state_.displacement[slot] -= state_.velocity[static_cast<int>(slot)] * begun;
  sweep(1, Pass::measure);
  std::copy(next.begin(), next.end(), state_.displacement.begin());

  const EnergyLedger after = energy();
  heat_ += after.zones + after.contacts + after.dissipated.total() - held_before;
  for (int g = 0; g < model_.gridpoint_count(); ++g)
    begun_heat_ -= 0.5 * begun * dot(force(g) - old_force[g], velocity(g));

  compute_stiffness();
  if (parameters_.mass == MassChoice::scaled) {
    scale_masses();
  } else if (const double limit = real_mass_limit().step / parameters_.safety;
             limit < time_step() * (1.0 - 1e-9)) {
    throw Error(fmt::format(
        "the body got stiffer at its new temperature: the time step {:.3g} s of its real mass is not stable "
        "any more (now {:.3g} s); start from a smaller safety, or scale the mass",
        time_step(), limit));
  }
}

template <int Dim>
TimeStepLimit Mechanics<Dim>::real_mass_limit() const {
  // Local damping multiplies a force that opposes motion by up to 1 + lambda, which acts as stiffness.
  TimeStepLimit limit{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t g = 0; g < stiffness_.size(); ++g) {
    const double step = parameters_.safety * 2.0 *
                        std::sqrt(gravity_mass_[g] / (stiffness_[g] * (1.0 + parameters_.local_damping)));
    if (step < limit.step) limit = {step, static_cast<int>(g)};
  }
  return limit;
}

template <int Dim>
int Mechanics<Dim>::bundle_of(int gridpoint) const {
  return layout_->bundle_of_block[model_.block_of(gridpoint)];
}

/// Those of the gridpoint's bundle, made when there are none yet.
template <int Dim>
Constraints<Dim>& Mechanics<Dim>::constraints_of(int gridpoint) {
  const int b = bundle_of(gridpoint);
  int& index = made_constraints_[b];
  if (index < 0) {
    index = static_cast<int>(state_.constraints.size());
    const int rows = layout_->bundles[b].rows;
    Constraints<Dim> free;
    free.prescribed_velocity = RowVectors<Dim>(rows);
    free.applied = RowVectors<Dim>(rows);
    free.prescribed.resize(rows);
    state_.constraints.push_back(std::move(free));
  }
  state_.constraints_of_bundle[b] = index;
  return state_.constraints[index];
}

/// A bundle that nothing holds, drives or loads any more takes the shorter way through a step.
template <int Dim>
void Mechanics<Dim>::drop_if_free(int b) {
  const int index = made_constraints_[b];
  if (index < 0) return;
  const auto& constraints = state_.constraints[index];
  if (!constraints.ties.empty()) return;
  for (int row = 0; row < layout_->bundles[b].rows; ++row)
    for (int i = 0; i < Dim; ++i) {
      if (constraints.prescribed[row][i] != 0) return;
      for (double force : constraints.applied.row(row).c[i])
        if (force != 0.0) return;
    }
  state_.constraints_of_bundle[b] = -1;
}

/// Slot counted from the first of its bundle.
template <int Dim>
int Mechanics<Dim>::slot_in_bundle(int gridpoint) const {
  const Bundle& bundle = layout_->bundles[bundle_of(gridpoint)];
  return layout_->gridpoint_slot[gridpoint] - slot_of(bundle.first_row, 0);
}

template <int Dim>
void Mechanics<Dim>::prescribe_velocity(int gridpoint, int component, double velocity) {
  auto& constraints = constraints_of(gridpoint);
  const int slot = slot_in_bundle(gridpoint);
  auto& bits = constraints.prescribed[slot / kLanes][component];
  bits = static_cast<std::uint8_t>(bits | (1U << slot % kLanes));
  constraints.prescribed_velocity.row(slot / kLanes).c[component][slot % kLanes] = velocity;
}

template <int Dim>
void Mechanics<Dim>::release(int gridpoint, int component) {
  if (made_constraints_[bundle_of(gridpoint)] < 0) return;
  const int slot = slot_in_bundle(gridpoint);
  auto& bits = constraints_of(gridpoint).prescribed[slot / kLanes][component];
  bits = static_cast<std::uint8_t>(bits & ~(1U << slot % kLanes));
  drop_if_free(bundle_of(gridpoint));
}

template <int Dim>
void Mechanics<Dim>::tie(std::vector<int> gridpoints, int component) {
  Tie tie{component, {}};
  double mass = 0.0, momentum = 0.0;
  for (int g : gridpoints) {
    tie.slots.push_back(layout_->gridpoint_slot[g]);
    mass += mass_[g];
    momentum += mass_[g] * velocity(g)[component];
  }
  for (int slot : tie.slots) state_.velocity.row(slot / kLanes).c[component][slot % kLanes] = momentum / mass;
  constraints_of(gridpoints.front()).ties.push_back(std::move(tie));
}

template <int Dim>
void Mechanics<Dim>::untie() {
  for (auto& constraints : state_.constraints) constraints.ties.clear();
  for (std::size_t b = 0; b < made_constraints_.size(); ++b) drop_if_free(static_cast<int>(b));
}

template <int Dim>
void Mechanics<Dim>::apply_force(int gridpoint, const Vec<Dim>& force) {
  constraints_of(gridpoint).applied.set(slot_in_bundle(gridpoint), force);
  drop_if_free(bundle_of(gridpoint));
}

template <int Dim>
void Mechanics<Dim>::break_contact(int contact) {
  const int slot = layout_->contact_slot[contact];
  state_.history[slot / kLanes].tension_damage[slot % kLanes] = 1.0;
  state_.history[slot / kLanes].shear_damage[slot % kLanes] = 1.0;
}

template <int Dim>
void Mechanics<Dim>::advance(int steps) {
  if (steps <= 0) return;
  heat_ += std::exchange(begun_heat_, 0.0);
  mass_scaling_ += std::exchange(begun_mass_scaling_, 0.0);
  if (steps > 1) sweep(steps - 1, Pass::move);
  sweep(1, Pass::move_and_measure);
  steps_ += steps;
}

template <int Dim>
void Mechanics<Dim>::sweep(int steps, Pass pass) {
  const int threads = omp_get_max_threads();
  if (static_cast<int>(shares_.size()) != threads) shares_ = share_out(*layout_, threads);
  const bool measure = pass != Pass::move;
#pragma omp parallel num_threads(threads)
  {
    FlatArray<double> scratch = scratch_for(*layout_);
    const Share& share = shares_[omp_get_thread_num()];
    for (int i = 0; i < steps; ++i) {
      for (const auto& faces : share.crossing) step_.update_faces(state_, faces.first, faces.last, measure);
#pragma omp barrier
      for (const auto& stride : share.strides) {
        step_.update_faces(state_, stride.faces.first, stride.faces.last, measure);
        step_.move_bundles(state_, stride.bundles.first, stride.bundles.last, pass, scratch.data());
      }
#pragma omp barrier
    }
  }
}

// The state in the order of the model

template <int Dim>
Vec<Dim> Mechanics<Dim>::displacement(int gridpoint) const {
  return state_.displacement[layout_->gridpoint_slot[gridpoint]];
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::velocity(int gridpoint) const {
  return state_.velocity[layout_->gridpoint_slot[gridpoint]];
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::force(int gridpoint) const {
  return state_.force[layout_->gridpoint_slot[gridpoint]];
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::applied_force(int gridpoint) const {
  const int index = made_constraints_[bundle_of(gridpoint)];
  return index < 0 ? Vec<Dim>{} : state_.constraints[index].applied[slot_in_bundle(gridpoint)];
}

/// That the last forces belong to.
template <int Dim>
Vec<Dim> Mechanics<Dim>::displacement_of_force(int gridpoint) const {
  return displacement(gridpoint) - velocity(gridpoint) * (steps_ > 0 ? time_step() : 0.0);
}

template <int Dim>
SymmetricTensor<Dim> Mechanics<Dim>::stress(int zone) const {
  std::array<Vec<Dim>, Dim + 1> u;
  for (int n = 0; n <= Dim; ++n) u[n] = displacement_of_force(model_.zones[zone][n]);
  const auto& p = properties_.zones[zone];
  Rotation<double> rotation;
  const auto strain = mechanical_strain<Dim>(geometry_.gradient[zone], 1.0, u, p.thermal_strain,
                                             parameters_.kinematics, rotation);
  return rotated<Dim>(rotation, zone_stress<Dim>(p, strain));
}

template <int Dim>
ContactFrame<Dim> Mechanics<Dim>::frame_of_forces(int contact) const {
  const auto& c = model_.contacts[contact / Dim * Dim];
  if constexpr (Dim == 2) {
    if (parameters_.kinematics == Kinematics::finite) {
      // mean edge of the two sides
      const auto& d = model_.contacts[contact / Dim * Dim + 1];
      const auto at = [&](int g) { return model_.position[g] + displacement_of_force(g); };
      const Vec<2> edge = ((at(d.a) - at(c.a)) + (at(d.b) - at(c.b))) * 0.5;
      const Vec<2> t = edge * (1.0 / norm(edge));
      return {{{t[1], -t[0]}}, {t}};
    }
  }
  return {c.normal, c.tangents};
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::jump_of_forces(int contact) const {
  const auto& c = model_.contacts[contact];
  return displacement_of_force(c.b) - displacement_of_force(c.a);
}

template <int Dim>
double Mechanics<Dim>::opening(int contact) const {
  return dot(jump_of_forces(contact), frame_of_forces(contact).normal);
}

template <int Dim>
ContactHistory<Dim> Mechanics<Dim>::contact_history(int contact) const {
  const int slot = layout_->contact_slot[contact];
  const auto& row = state_.history[slot / kLanes];
  const int lane = slot % kLanes;
  ContactHistory<Dim> h;
  h.tension_damage = row.tension_damage[lane];
  h.shear_damage = row.shear_damage[lane];
  h.closure = row.closure[lane];
  for (int i = 0; i + 1 < Dim; ++i) h.slip[i] = row.slip[i][lane];
  h.held_slip = row.held_slip[lane];
  return h;
}

template <int Dim>
ContactState<Dim> Mechanics<Dim>::contact(int contact) const {
  const auto frame = frame_of_forces(contact);
  const Vec<Dim> u = jump_of_forces(contact);
  ContactState<Dim> state;
  state.history = contact_history(contact);
  state.opening = dot(u, frame.normal);
  for (int i = 0; i + 1 < Dim; ++i) state.tangential_jump[i] = dot(u, frame.tangents[i]);
  // the law at the jump that it was last taken to gives the tractions again
  auto history = state.history;
  const auto response = update_contact<Dim>(properties_.contacts[properties_.of_contact[contact]],
                                            state.opening, state.tangential_jump, history);
  state.normal_traction = response.normal_traction;
  state.shear_traction = response.shear_traction;
  state.stored = response.stored;
  const int slot = layout_->contact_slot[contact];
  const auto& loss = state_.loss[slot / kLanes];
  const int lane = slot % kLanes;
  state.accumulated_slip = loss.slipped[lane];
  state.dissipated = {loss.tension[lane], loss.shear[lane], loss.friction[lane], loss.compression[lane]};
  return state;
}

namespace {

template <class At>
auto all(int count, At at) {
  std::vector<decltype(at(0))> values;
  values.reserve(count);
  for (int i = 0; i < count; ++i) values.push_back(at(i));
  return values;
}

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> Mechanics<Dim>::displacement() const {
  return all(model_.gridpoint_count(), [&](int g) { return displacement(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Mechanics<Dim>::velocity() const {
  return all(model_.gridpoint_count(), [&](int g) { return velocity(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Mechanics<Dim>::force() const {
  return all(model_.gridpoint_count(), [&](int g) { return force(g); });
}

template <int Dim>
std::vector<SymmetricTensor<Dim>> Mechanics<Dim>::stress() const {
  return all(model_.zone_count(), [&](int z) { return stress(z); });
}

template <int Dim>
std::vector<ContactState<Dim>> Mechanics<Dim>::contacts() const {
  return all(model_.contact_count(), [&](int c) { return contact(c); });
}

template <int Dim>
EnergyLedger Mechanics<Dim>::energy() const {
  EnergyLedger e;
  e.heat = heat_;
  e.mass_scaling = mass_scaling_;
  for (std::size_t b = 0; b < state_.bundle_sums.size(); ++b) {
    const BundleSums& sums = state_.bundle_sums[b];
    e.zones += sums.stored;
    e.kinetic += sums.kinetic;
    e.local_damping += sums.damping_work - sums.begun_damping;
    e.viscous_damping += sums.viscous_work - sums.begun_viscous;
    if (const int c = made_constraints_[b]; c >= 0)
      e.loading += state_.constraints[c].loading_work - sums.begun_loading;
  }
  for (const FaceSums& sums : state_.face_sums) e.contacts += sums.stored;
  for (int row = 0; row < Dim * layout_->face_rows(); ++row) {
    const LossRow& loss = state_.loss[row];
    const auto& area = layout_->faces[row / Dim].area;
    for (int lane = 0; lane < kLanes; ++lane) {
      e.dissipated.tension += loss.tension[lane] * area[lane];
      e.dissipated.shear += loss.shear[lane] * area[lane];
      e.dissipated.friction += loss.friction[lane] * area[lane];
      e.dissipated.compression += loss.compression[lane] * area[lane];
    }
  }
  // weights are constant, so their work follows from the way made
  if (state_.weighs())
    for (int g = 0; g < model_.gridpoint_count(); ++g)
      e.gravity += gravity_mass_[g] * dot(parameters_.gravity, displacement_of_force(g));
  return e;
}

template <int Dim>
double Mechanics<Dim>::unbalanced_ratio() const {
  double applied = 0.0, unbalanced = 0.0;
  for (const BundleSums& sums : state_.bundle_sums) {
    applied += sums.applied;
    unbalanced += sums.unbalanced;
  }
  for (const FaceSums& sums : state_.face_sums) applied += sums.applied;
  return applied > 0.0 ? unbalanced / applied : 0.0;
}

template <int Dim>
double Mechanics<Dim>::largest_relative_jump() const {
  double largest = 0.0;
  for (const FaceSums& sums : state_.face_sums) largest = std::max(largest, sums.jump);
  return largest;
}

template BodyProperties by_interface<2>(const Model<2>&, std::vector<ZoneProperties>,
                                        std::vector<ContactProperties>);
template BodyProperties by_interface<3>(const Model<3>&, std::vector<ZoneProperties>,
                                        std::vector<ContactProperties>);
template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
