#include "pyroclast/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Lines of the point of a contact in the internal variables or the losses, from the first of its pack of
/// faces on. \param first  of each pack of faces, its first line \param count  of lines of a point
template <int Dim, class Lines, class First>
auto lines_of(const Layout<Dim>& layout, Lines& lines, const First& first, int contact, std::size_t count) {
  const int point = layout.contact_slot[contact] / kLanes, pack = layout.face_pack_of_point[point];
  return lines.data() + first[pack] + static_cast<std::size_t>(point - layout.first_point_of(pack)) * count;
}

/// What was made alike before has time steps that differ by less than this factor.
constexpr double kSameStep = 2.0;
/// Forces of a smaller strain are none beside what a body bears: some 3 Pa in concrete.
constexpr double kNoStrain = 1e-10;
/// More than there is of any thing in a body.
constexpr double kMostOfAKind = std::numeric_limits<int>::max();

bool is_slot_of(int slot, const Bundle& bundle) {
  const int first = slot_of(bundle.first_pack, 0);
  return first <= slot && slot < first + bundle.packs * kLanes;
}

int place_of(const LawTable& law, Remembers what, int dim) {
  const auto internals = law.internals(dim);
  const auto found = std::ranges::find(internals, what, &InternalInfo::what);
  return found == internals.end() ? -1 : static_cast<int>(found - internals.begin());
}

}  // namespace

template <int Dim>
BodyProperties by_interface(const Model<Dim>& model, std::vector<ZoneProperties> zones,
                            const std::vector<ContactProperties>& interfaces) {
  BodyProperties p{std::move(zones), ContactSets(interfaces), {}, {}};
  p.of_contact.reserve(model.contacts.size());
  for (const auto& c : model.contacts) p.of_contact.push_back(c.interface);
  return p;
}

template <int Dim>
Mechanics<Dim>::Mechanics(const Model<Dim>& model, const std::vector<double>& densities,
                          BodyProperties properties, const MechanicsParameters<Dim>& parameters,
                          std::shared_ptr<Team> team)
    : model_(model),
      parameters_(parameters),
      team_(team ? std::move(team) : std::make_shared<Team>()),
      properties_(std::move(properties)),
      geometry_(zone_geometry(model)),
      layout_(std::make_unique<const Layout<Dim>>(model, parameters.layout)),
      step_(step_functions<Dim>(parameters.instructions)) {
  if (Dim != 2 && parameters.kinematics == Kinematics::finite)
    throw Error("kinematics = finite: contact frames that turn are made for 2D only; use small");
  if (!properties_.creep.empty()) creep_strain_.resize(model_.zones.size());
  list_laws();
  place_model();
  place_internals();
  place_properties();
  mean_height_ =
      chunked_sum(layout_->chunks.zones, [&](int z) { return 1.0 / norm(geometry_.gradient[z][0]); }) /
      static_cast<double>(model.zones.size());
  compute_stiffness();
  set_masses(densities);
  sweep(1, Pass::measure);
  // nothing has acted yet
  std::fill(storage_.force.begin(), storage_.force.end(), VectorPack<Dim>{});
  property_change_ = energy().zones;  // of a body that begins at another temperature
}

/// Lets the state see the storage as it is now.
template <int Dim>
void Mechanics<Dim>::refresh_views() {
  see(state_, storage_);
}

/// Working memory of one thread for a step.
template <int Dim>
FlatArray<double> Mechanics<Dim>::make_scratch() const {
  return FlatArray<double>(2 * Dim * kLanes * static_cast<std::size_t>(layout_->most_packs));
}

/// Puts what does not change in its places.
template <int Dim>
void Mechanics<Dim>::place_model() {
  see(state_.layout, *layout_);
  state_.gravity = parameters_.gravity;
  state_.local_damping = parameters_.local_damping;
  state_.viscous_damping = parameters_.viscous_damping;
  state_.damping_form = parameters_.damping_form;
  state_.kinematics = parameters_.kinematics;
  state_.thickness = model_.thickness;
  auto& s = storage_;
  const auto packs = static_cast<std::size_t>(layout_->gridpoint_packs);
  s.position = made<VectorPack<Dim>>(packs);
  s.velocity = made<VectorPack<Dim>>(packs);
  s.force = made<VectorPack<Dim>>(packs);
  s.stiffness = made<VectorPack<Dim>>(packs);
  s.displacement = made<Vec<Dim>>(packs * kLanes);
  s.gathered_position = made<Vec<Dim>>(packs * kLanes);
  s.step_over_mass = made<double>(packs * kLanes);
  const auto point_packs = static_cast<std::size_t>(layout_->point_packs);
  s.losing = made<bool>(point_packs);
  s.contact_force = made<Vec<Dim>>(point_packs * kLanes);
  if (parameters_.kinematics == Kinematics::finite) s.turning_force = made<Vec<Dim>>(point_packs * kLanes);
  s.constraints_of_bundle = FlatArray<int>(layout_->bundles.size());
  std::fill(s.constraints_of_bundle.begin(), s.constraints_of_bundle.end(), -1);
  made_constraints_.assign(layout_->bundles.size(), -1);
  s.bundle_sums = made<BundleSums>(layout_->bundles.size());
  s.face_sums = made<FaceSums>(layout_->faces.size());

  const View<VectorPack<Dim>> position(s.position.data(), s.position.size());
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    set_vector<Dim>(position, layout_->gridpoint_slot[g], model_.position[g]);
    s.gathered_position[layout_->gridpoint_slot[g]] = model_.position[g];
  }
  for (int b = 0; b < static_cast<int>(layout_->bundles.size()); ++b)
    for (int lane = 0; lane < kLanes; ++lane) {
      if (layout_->block_in(b, lane) >= 0) continue;
      // the shape of the first, without stiffness
      const Bundle& bundle = layout_->bundles[b];
      for (int i = 0; i < bundle.packs; ++i)
        set_vector<Dim>(position, slot_of(bundle.first_pack + i, lane),
                        vector_at<Dim>(position, slot_of(bundle.first_pack + i, 0)));
    }
  refresh_views();
}

/// Laws of the body, each once, in the order of the interfaces.
template <int Dim>
void Mechanics<Dim>::list_laws() {
  laws_ = properties_.contacts.laws();
  if (laws_.size() > kMostLaws)
    throw Error(fmt::format("the contacts of this body have {} laws; at most {} are possible", laws_.size(),
                            kMostLaws));
  use(step_);
}

template <int Dim>
void Mechanics<Dim>::use(const StepFunctions<Dim>& step) {
  step_ = step;
  law_functions_.clear();
  for (const LawTable* law : laws_) law_functions_.push_back(step_.functions_of(*law));
  state_.laws = law_functions_.data();
}

/// Gives every pack of faces its law, and the part of the internal variables and losses that it takes.
template <int Dim>
void Mechanics<Dim>::place_internals() {
  auto& s = storage_;
  const auto packs = static_cast<std::size_t>(layout_->face_packs());
  s.law_of_faces = FlatArray<std::uint8_t>(packs);
  for (int c = 0; c < model_.contact_count(); ++c)
    s.law_of_faces[layout_->face_pack_of_point[layout_->contact_slot[c] / kLanes]] =
        static_cast<std::uint8_t>(std::ranges::find(laws_, &law_of(c)) - laws_.begin());
  s.first_internal = FlatArray<int>(packs + 1);
  s.first_loss = FlatArray<int>(packs + 1);
  for (int pack = 0; pack < layout_->face_packs(); ++pack) {
    const LawTable& law = law_of_pack(pack);
    const int points = layout_->first_point_of(pack + 1) - layout_->first_point_of(pack);
    s.first_internal[pack + 1] =
        s.first_internal[pack] + points * static_cast<int>(law.internals(Dim).size());
    s.first_loss[pack + 1] = s.first_loss[pack] + points * static_cast<int>(law.losses.size());
  }
  s.internals = made<Line>(static_cast<std::size_t>(s.first_internal[packs]));
  s.loss = made<Line>(static_cast<std::size_t>(s.first_loss[packs]));
  name_dissipations();
  refresh_views();
}

/// Energies that the laws of the body lose, and creep where it does; each name once.
template <int Dim>
void Mechanics<Dim>::name_dissipations() {
  for (const LawTable* law : laws_)
    for (const LossInfo& loss : law->losses)
      if (loss.is_energy() &&
          std::ranges::find(dissipations_, std::string_view(loss.name)) == dissipations_.end())
        dissipations_.emplace_back(loss.name);
  if (creeps() && std::ranges::find(dissipations_, kCreep) == dissipations_.end())
    dissipations_.push_back(kCreep);
  if (dissipations_.size() > kMostDissipations)
    throw Error(
        fmt::format("the laws of this body name {} kinds of dissipated energy; at most {} are counted",
                    dissipations_.size(), kMostDissipations));
}

/// Puts zone and contact parameters in their places.
template <int Dim>
void Mechanics<Dim>::place_properties() {
  auto& packs = storage_.zone_properties;
  std::vector<ZoneProperties> softened;
  if (!creep_under_way_.empty())
    for (int z = 0; z < model_.zone_count(); ++z) softened.push_back(properties_of_zone(z));
  const std::vector<ZoneProperties>& zones = creep_under_way_.empty() ? properties_.zones : softened;
  const auto same = [](const ZoneProperties& a, const ZoneProperties& b) {
    return a.lambda == b.lambda && a.mu == b.mu && a.thermal_strain == b.thermal_strain;
  };
  bool by_bundle = true;
  for (int b = 0; b < model_.block_count() && by_bundle; ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      by_bundle = by_bundle && same(zones[z], zones[model_.block_zones[b]]);
  state_.by_bundle = by_bundle;
  const std::size_t count =
      by_bundle ? layout_->bundles.size() : static_cast<std::size_t>(layout_->zone_packs);
  if (packs.size() != count) packs = made<ZonePropertyPack>(count);
  const auto place = [&](std::size_t pack, int lane, const ZoneProperties& p) {
    packs[pack].lambda[lane] = p.lambda;
    packs[pack].mu[lane] = p.mu;
    packs[pack].thermal_strain[lane] = p.thermal_strain;
  };
  if (by_bundle) {
    for (std::size_t b = 0; b < count; ++b)
      for (int lane = 0; lane < kLanes; ++lane)
        if (const int block = layout_->block_in(static_cast<int>(b), lane); block >= 0)
          place(b, lane, zones[model_.block_zones[block]]);
  } else {
    for (int z = 0; z < model_.zone_count(); ++z)
      place(layout_->zone_slot[z] / kLanes, layout_->zone_slot[z] % kLanes, zones[z]);
  }
  place_creep_strain();
  place_contact_properties();
}

template <int Dim>
void Mechanics<Dim>::place_creep_strain() {
  auto& packs = storage_.creep_strain;
  const std::size_t count = creeps() ? static_cast<std::size_t>(layout_->zone_packs) : 0;
  if (packs.size() != count) packs = made<TensorPack<Dim>>(count);
  for (std::size_t z = 0; z < creep_strain_.size(); ++z) {
    const int slot = layout_->zone_slot[z];
    for (std::size_t i = 0; i < creep_strain_[z].size(); ++i)
      packs[slot / kLanes].component[i][slot % kLanes] = creep_strain_[z][i];
  }
}

template <int Dim>
void Mechanics<Dim>::place_contact_properties() {
  auto& s = storage_;
  const ContactSets& sets = properties_.contacts;
  const std::vector<int> set_of_faces = find_sets_of_faces();
  std::vector<int> first(static_cast<std::size_t>(sets.size()), -1);
  s.first_constant.resize(layout_->faces.size());
  std::size_t bytes = 0;
  for (std::size_t pack = 0; pack < set_of_faces.size(); ++pack) {
    const int set = set_of_faces[pack];
    if (first[set] < 0)
      first[set] = static_cast<int>(std::exchange(bytes, bytes + sets.law(set).constants_size));
    s.first_constant[pack] = first[set];
  }
  s.contact_constants.resize(bytes);
  for (int set = 0; set < sets.size(); ++set)
    if (first[set] >= 0) sets.derive(set, s.contact_constants.data() + first[set]);
  if (!std::ranges::all_of(s.one_set, std::identity())) place_own_constants();
  refresh_views();
}

/// First set of each pack of faces; finds the packs whose points share one set.
template <int Dim>
std::vector<int> Mechanics<Dim>::find_sets_of_faces() {
  auto& one_set = storage_.one_set;
  const ContactSets& sets = properties_.contacts;
  std::vector<int> set_of_faces(layout_->faces.size(), -1);
  one_set.resize(layout_->faces.size());
  std::fill(one_set.begin(), one_set.end(), true);
  for (int c = 0; c < model_.contact_count(); ++c) {
    const int pack = layout_->face_pack_of_point[layout_->contact_slot[c] / kLanes];
    const int set = properties_.of_contact[c];
    if (&sets.law(set) != &law_of_pack(pack))
      throw Error(fmt::format(
          "contact {} of interface \"{}\" has the law \"{}\", others of it have \"{}\": contacts of "
          "one interface have one law, from the start of a run to its end",
          c, model_.interface_names[model_.contacts[c].interface], sets.law(set).name,
          law_of_pack(pack).name));
    if (set_of_faces[pack] < 0) set_of_faces[pack] = set;
    if (set_of_faces[pack] != set) one_set[pack] = false;
  }
  return set_of_faces;
}

/// Constants of each contact point, for packs of faces that have no one set.
template <int Dim>
void Mechanics<Dim>::place_own_constants() {
  auto& s = storage_;
  const auto count = [&](int pack) { return law_of_pack(pack).constant_count; };
  if (s.own_constants.empty()) {
    s.first_own_constant = FlatArray<int>(layout_->faces.size() + 1);
    for (int pack = 0; pack < layout_->face_packs(); ++pack)
      s.first_own_constant[pack + 1] =
          s.first_own_constant[pack] +
          (layout_->first_point_of(pack + 1) - layout_->first_point_of(pack)) * count(pack);
    s.own_constants = made<Line>(static_cast<std::size_t>(s.first_own_constant[layout_->face_packs()]));
  }
  for (int pack = 0; pack < layout_->face_packs(); ++pack) {  // for idle lanes
    if (s.one_set[pack]) continue;
    for (int line = s.first_own_constant[pack]; line < s.first_own_constant[pack + 1]; line += count(pack))
      for (int lane = 0; lane < kLanes; ++lane)
        law_of_pack(pack).numbers_of(s.contact_constants.data() + s.first_constant[pack],
                                     s.own_constants[line].number + lane, kLanes);
  }
  std::size_t most = 0;
  for (const LawTable* law : laws_) most = std::max(most, law->constants_size);
  FlatArray<std::byte> constants(most);
  for (int c = 0; c < model_.contact_count(); ++c) {
    const int slot = layout_->contact_slot[c], pack = layout_->face_pack_of_point[slot / kLanes];
    if (s.one_set[pack]) continue;
    properties_.contacts.derive(properties_.of_contact[c], constants.data());
    Line* const line = lines_of(*layout_, s.own_constants, s.first_own_constant, c, count(pack));
    law_of_pack(pack).numbers_of(constants.data(), line->number + slot % kLanes, kLanes);
  }
}

/// k_gp of Eq. (9): for every gridpoint the largest sum of |stiffness| over a row of the assembled matrix,
/// zones and contacts. By Gershgorin's theorem no natural frequency exceeds sqrt(k_gp / m), so the step is
/// safe for any shape.
template <int Dim>
void Mechanics<Dim>::compute_stiffness() {
  FlatArray<double> scratch = make_scratch();
  step_.passes.sum_stiffness(state_, scratch.data());
  stiffness_.resize(model_.position.size());
  for (int g = 0; g < model_.gridpoint_count(); ++g) {
    const Vec<Dim> pack = vector_at<Dim>(state_.stiffness, layout_->gridpoint_slot[g]);
    stiffness_[g] = *std::max_element(pack.c.begin(), pack.c.end());
  }
  set_least_force();
}

/// What a strain that counts as none puts on all gridpoints.
template <int Dim>
void Mechanics<Dim>::set_least_force() {
  least_force_ = kNoStrain * mean_height_ *
                 chunked_sum(layout_->chunks.gridpoints, [&](int g) { return stiffness_[g]; });
}

template <int Dim>
void Mechanics<Dim>::set_masses(const std::vector<double>& densities) {
  gravity_mass_.assign(model_.position.size(), 0.0);
  for (int b = 0; b < model_.block_count(); ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      for (int g : model_.zones[z])
        gravity_mass_[g] += densities[model_.block_material[b]] * geometry_.volume[z] / (Dim + 1);
  real_mass_ = chunked_sum(layout_->chunks.gridpoints, [&](int g) { return gravity_mass_[g]; });
  if (norm(parameters_.gravity) > 0.0) {
    storage_.real_mass = made<double>(storage_.displacement.size());
    for (int g = 0; g < model_.gridpoint_count(); ++g)
      storage_.real_mass[layout_->gridpoint_slot[g]] = gravity_mass_[g];
    refresh_views();
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
double Mechanics<Dim>::scaled_mass(int gridpoint) const {
  const double half = 0.5 * parameters_.time_step / parameters_.safety;
  return stiffness_[gridpoint] * (1.0 + parameters_.local_damping) * half * half;
}

template <int Dim>
void Mechanics<Dim>::scale_masses() {
  state_.time_step = parameters_.time_step;
  mass_.resize(stiffness_.size());
  // of the half step begun with the old mass; nothing moves yet when the first masses are made
  begun_mass_scaling_ += chunked_sum(layout_->chunks.gridpoints, [&](int g) {
    const Vec<Dim> v = velocity(g);
    return 0.5 * (scaled_mass(g) - mass_[g]) * dot(v, v);
  });
  set_moving_mass();
}

template <int Dim>
void Mechanics<Dim>::set_moving_mass() {
  for (int g = 0; g < model_.gridpoint_count(); ++g) mass_[g] = scaled_mass(g);
  moving_mass_ = chunked_sum(layout_->chunks.gridpoints, [&](int g) { return mass_[g]; });
  set_step_over_mass();
}

template <int Dim>
void Mechanics<Dim>::set_step_over_mass() {
  auto& step_over_mass = storage_.step_over_mass;
  std::fill(step_over_mass.begin(), step_over_mass.end(), 1.0);  // idle ones never move
  for (std::size_t g = 0; g < mass_.size(); ++g)
    step_over_mass[layout_->gridpoint_slot[g]] = time_step() / mass_[g];
}

template <int Dim>
BodyProperties Mechanics<Dim>::set_properties(BodyProperties properties) {
  commit_creep();
  if (!properties.creep.empty() && !creeps())
    throw Error("a body that was made of what does not creep cannot begin to");
  change_properties([&] {
    begin_creep(properties.creep);
    std::swap(properties_, properties);
  });
  return properties;
}

template <int Dim>
void Mechanics<Dim>::commit_creep() {
  if (!creep_under_way_.empty()) change_properties([&] { end_creep(); });
}

/// With the stress that zones have by the properties that there are.
template <int Dim>
void Mechanics<Dim>::begin_creep(const std::vector<CreepIncrement>& creep) {
  if (std::ranges::none_of(creep, [](const CreepIncrement& i) { return i.compliance != 0.0; })) return;
  creep_under_way_.resize(creep.size());
  for (int z = 0; z < model_.zone_count(); ++z) {
    CreepUnderWay& zone = creep_under_way_[z];
    Rotation<double> rotation;
    zone.poisson = creep[z].poisson;
    zone.stress = stress_in_own_frame(z, rotation);
    zone.split = creep_split<Dim>(creep[z], zone.stress);
  }
  // those above are still of what was before
  for (int z = 0; z < model_.zone_count(); ++z)
    for (std::size_t i = 0; i < creep_strain_[z].size(); ++i)
      creep_strain_[z][i] += creep_under_way_[z].split.known[i];
}

template <int Dim>
void Mechanics<Dim>::end_creep() {
  const auto crept = [&](const CreepUnderWay& zone, const SymmetricTensor<Dim>& stress) {
    auto strain = creep_direction<Dim>(stress, zone.poisson);
    for (double& component : strain) component *= zone.split.compliance;
    return strain;
  };
  std::vector<SymmetricTensor<Dim>> last(creep_under_way_.size());
  creep_work_ += chunked_sum(layout_->chunks.zones, [&](int z) {
    const CreepUnderWay& zone = creep_under_way_[z];
    Rotation<double> rotation;
    const auto stress = stress_in_own_frame(z, rotation);
    last[z] = crept(zone, stress);
    SymmetricTensor<Dim> all, twice_mean;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = zone.split.known[i] + last[z][i];
      twice_mean[i] = zone.stress[i] + stress[i];
    }
    return energy_density<Dim>(twice_mean, all) * geometry_.volume[z];
  });
  for (int z = 0; z < model_.zone_count(); ++z)
    for (std::size_t i = 0; i < last[z].size(); ++i) creep_strain_[z][i] += last[z][i];
  creep_under_way_.clear();
}

/// \param change  of properties or creep
template <int Dim>
template <class Change>
void Mechanics<Dim>::change_properties(Change change) {
  // The ledger counts the work of forces by the trapezoidal rule. So the change is made at the displacements
  // of the last step's forces, and the half step already begun with the old ones is made good.
  const EnergyLedger before = energy();
  const double held_before = before.zones + before.contacts + before.dissipated.total();
  change();
  place_properties();
  auto& displacement = storage_.displacement;
  const auto next = displacement;
  const auto old_force = forces();
  const double begun = steps_ > 0 ? time_step() : 0.0;
  for (std::size_t slot = 0; slot < next.size(); ++slot)
    displacement[slot] -= vector_at<Dim>(state_.velocity, static_cast<int>(slot)) * begun;
  sweep(1, Pass::measure);
  std::copy(next.begin(), next.end(), displacement.begin());

  const EnergyLedger after = energy();
  property_change_ += after.zones + after.contacts + after.dissipated.total() - held_before;
  begun_property_change_ -= chunked_sum(layout_->chunks.gridpoints, [&](int g) {
    return 0.5 * begun * dot(force(g) - old_force[g], velocity(g));
  });

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

// What holds, drives and loads the body

template <int Dim>
int Mechanics<Dim>::bundle_of(int gridpoint) const {
  return layout_->bundle_of_block[model_.block_of(gridpoint)];
}

/// Slot counted from the first of its bundle.
template <int Dim>
int Mechanics<Dim>::slot_in_bundle(int gridpoint) const {
  const Bundle& bundle = layout_->bundles[bundle_of(gridpoint)];
  return layout_->gridpoint_slot[gridpoint] - slot_of(bundle.first_pack, 0);
}

/// Index of those of the gridpoint's bundle, made when there are none yet; they act from now on.
template <int Dim>
int Mechanics<Dim>::constraints_of(int gridpoint) {
  const int b = bundle_of(gridpoint);
  int& index = made_constraints_[b];
  if (index < 0) {
    index = static_cast<int>(storage_.constraints.size());
    const auto first_pack = storage_.constraint_packs.size();
    storage_.constraints.resize(storage_.constraints.size() + 1);
    storage_.constraints[index].first_pack = static_cast<int>(first_pack);
    storage_.constraint_packs.resize(first_pack + static_cast<std::size_t>(layout_->bundles[b].packs));
    constraints_are_in_order_ = false;
    refresh_views();
  }
  storage_.constraints_of_bundle[b] = index;
  return index;
}

/// Puts constraints into the order of their bundles, so that a state does not depend on the order in which
/// they were made.
template <int Dim>
void Mechanics<Dim>::order_constraints() {
  if (std::exchange(constraints_are_in_order_, true)) return;
  auto& s = storage_;
  FlatArray<BundleConstraints> constraints(s.constraints.size());
  FlatArray<ConstraintPack<Dim>> packs(s.constraint_packs.size());
  int next = 0, next_pack = 0;
  for (std::size_t b = 0; b < made_constraints_.size(); ++b) {
    int& index = made_constraints_[b];
    if (index < 0) continue;
    constraints[next] = s.constraints[index];
    const int first_pack = std::exchange(constraints[next].first_pack, next_pack);
    std::copy_n(s.constraint_packs.begin() + first_pack, layout_->bundles[b].packs,
                packs.begin() + next_pack);
    next_pack += layout_->bundles[b].packs;
    if (s.constraints_of_bundle[b] >= 0) s.constraints_of_bundle[b] = next;
    index = next++;
  }
  s.constraints = std::move(constraints);
  s.constraint_packs = std::move(packs);
  refresh_views();
}

template <int Dim>
ConstraintPack<Dim>& Mechanics<Dim>::constraint_pack(int constraints, int gridpoint) {
  return storage_
      .constraint_packs[storage_.constraints[constraints].first_pack + slot_in_bundle(gridpoint) / kLanes];
}

/// A bundle that nothing holds, drives or loads any more takes the shorter way through a step.
template <int Dim>
void Mechanics<Dim>::drop_if_free(int b) {
  const int index = made_constraints_[b];
  if (index < 0) return;
  const BundleConstraints& constraints = storage_.constraints[index];
  if (constraints.first_tie != constraints.last_tie) return;
  for (int pack = 0; pack < layout_->bundles[b].packs; ++pack)
    for (int i = 0; i < Dim; ++i) {
      const ConstraintPack<Dim>& held = storage_.constraint_packs[constraints.first_pack + pack];
      if (held.prescribed[i] != 0) return;
      for (double force : held.applied[i])
        if (force != 0.0) return;
    }
  storage_.constraints_of_bundle[b] = -1;
}

template <int Dim>
void Mechanics<Dim>::prescribe_velocity(int gridpoint, int component, double velocity) {
  auto& pack = constraint_pack(constraints_of(gridpoint), gridpoint);
  const int lane = layout_->gridpoint_slot[gridpoint] % kLanes;
  pack.prescribed[component] = static_cast<std::uint8_t>(pack.prescribed[component] | (1U << lane));
  pack.prescribed_velocity[component][lane] = velocity;
}

template <int Dim>
bool Mechanics<Dim>::is_prescribed(int gridpoint, int component) const {
  const int index = made_constraints_[bundle_of(gridpoint)];
  if (index < 0) return false;
  const int slot = slot_in_bundle(gridpoint);
  const auto& pack = state_.constraint_packs[state_.constraints[index].first_pack + slot / kLanes];
  return (pack.prescribed[component] >> (slot % kLanes) & 1U) != 0;
}

template <int Dim>
void Mechanics<Dim>::release(int gridpoint, int component) {
  if (made_constraints_[bundle_of(gridpoint)] < 0) return;
  auto& pack = constraint_pack(constraints_of(gridpoint), gridpoint);
  const int lane = layout_->gridpoint_slot[gridpoint] % kLanes;
  pack.prescribed[component] = static_cast<std::uint8_t>(pack.prescribed[component] & ~(1U << lane));
  drop_if_free(bundle_of(gridpoint));
}

template <int Dim>
void Mechanics<Dim>::tie(std::vector<int> gridpoints, int component) {
  std::sort(gridpoints.begin(), gridpoints.end());
  constraints_of(gridpoints.front());
  TieOfBundle tie{bundle_of(gridpoints.front()), component, {}};
  double mass = 0.0, momentum = 0.0;
  for (int g : gridpoints) {
    tie.slots.push_back(layout_->gridpoint_slot[g]);
    mass += mass_[g];
    momentum += mass_[g] * velocity(g)[component];
  }
  for (int slot : tie.slots) storage_.velocity[slot / kLanes].c[component][slot % kLanes] = momentum / mass;
  ties_.push_back(std::move(tie));
  place_ties();
}

template <int Dim>
void Mechanics<Dim>::untie() {
  ties_.clear();
  place_ties();
  for (std::size_t b = 0; b < made_constraints_.size(); ++b) drop_if_free(static_cast<int>(b));
}

template <int Dim>
void Mechanics<Dim>::place_ties() {
  std::sort(ties_.begin(), ties_.end(), [](const TieOfBundle& a, const TieOfBundle& b) {
    return std::tie(a.bundle, a.component, a.slots) < std::tie(b.bundle, b.component, b.slots);
  });
  storage_.ties.resize(0);
  storage_.tied_slots.resize(0);
  for (auto& constraints : storage_.constraints) constraints.first_tie = constraints.last_tie = 0;
  for (const TieOfBundle& tie : ties_) {
    const auto begin = storage_.tied_slots.size();
    storage_.tied_slots.resize(begin + tie.slots.size());
    std::copy(tie.slots.begin(), tie.slots.end(), storage_.tied_slots.begin() + begin);
    const auto index = static_cast<int>(storage_.ties.size());
    storage_.ties.resize(storage_.ties.size() + 1);
    storage_.ties[index] = {tie.component, static_cast<int>(begin),
                            static_cast<int>(begin + tie.slots.size())};
    auto& constraints = storage_.constraints[made_constraints_[tie.bundle]];
    if (constraints.first_tie == constraints.last_tie) constraints.first_tie = index;
    constraints.last_tie = index + 1;
  }
  refresh_views();
}

template <int Dim>
void Mechanics<Dim>::apply_force(int gridpoint, const Vec<Dim>& force) {
  auto& pack = constraint_pack(constraints_of(gridpoint), gridpoint);
  const int lane = layout_->gridpoint_slot[gridpoint] % kLanes;
  for (int i = 0; i < Dim; ++i) pack.applied[i][lane] = force[i];
  drop_if_free(bundle_of(gridpoint));
}

template <int Dim>
bool Mechanics<Dim>::break_contact(int contact) {
  const LawTable& law = law_of(contact);
  bool breaks = false;
  for (const auto what : {Remembers::tension_damage, Remembers::shear_damage, Remembers::mixed_damage})
    if (const int place = place_of(law, what, Dim); place >= 0) {
      lines_of(*layout_, storage_.internals, storage_.first_internal, contact,
               law.internals(Dim).size())[place]
          .number[layout_->contact_slot[contact] % kLanes] = 1.0;
      breaks = true;
    }
  return breaks;
}

// Motion

template <int Dim>
void Mechanics<Dim>::advance(int steps) {
  if (steps <= 0) return;
  order_constraints();
  property_change_ += std::exchange(begun_property_change_, 0.0);
  mass_scaling_ += std::exchange(begun_mass_scaling_, 0.0);
  if (steps > 1) sweep(steps - 1, Pass::move);
  sweep(1, Pass::move_and_measure);
  steps_ += steps;
}

// Checkpoints

/// Fills all that steps change with NaN; in idle places forces stay zero, for gridpoints gather from them
/// too.
template <int Dim>
void Mechanics<Dim>::forget() {
  for_each_array(
      [](const ArrayInfo& info, auto& array) {
        if (info.lasts == Lasts::kept && !array.empty())
          std::memset(static_cast<void*>(array.data()), 0xff, bytes_of(array));
      },
      storage_);
  Vec<Dim> nothing;
  nothing.c.fill(std::numeric_limits<double>::quiet_NaN());
  for (auto* forces : {&storage_.contact_force, &storage_.turning_force})
    for (const int slot : layout_->contact_slot)
      if (!forces->empty()) (*forces)[slot] = nothing;
}

template <int Dim>
void Mechanics<Dim>::visit_state(StateVisitor& visitor) {
  order_constraints();
  if (visitor.replaces()) forget();
  visitor.visit("steps", steps_, state::count());
  // of real mass: fixed when the run began, of which this body is a beginning
  visitor.visit("time_step", state_.time_step,
                state::within(state_.time_step / kSameStep, state_.time_step * kSameStep));
  visitor.visit("property_change", property_change_);
  visitor.visit("mass_scaling", mass_scaling_);
  visitor.visit("begun_property_change", begun_property_change_);
  visitor.visit("begun_mass_scaling", begun_mass_scaling_);
  visitor.visit("creep_work", creep_work_);
  visitor.visit_numbers("creep_strains", creep_strain_, state::finite().of(creep_strain_.size()));
  visitor.visit_numbers("creep_under_way", creep_under_way_);
  visitor.require(creep_under_way_.empty() || (creeps() && creep_under_way_.size() == creep_strain_.size()),
                  "creep_under_way", "does not have each zone, or nothing creeps");
  visitor.visit("made_constraints", made_constraints_,
                state::within(-1, kMostOfAKind).of(made_constraints_.size()));
  // of the frames of the last change of properties, which turn on since
  visitor.visit("stiffness", stiffness_, state::at_least(0).of(stiffness_.size()));
  for_each_array(
      [&](const ArrayInfo& info, auto& array) {
        if (info.lasts == Lasts::kept) visit_array(visitor, info.name, array);
      },
      storage_);
  visit_ties(visitor);
  require_constraints(visitor);
  visit_properties(visitor);
  if (!visitor.replaces()) return;
  set_least_force();
  place_properties();
  if (parameters_.mass == MassChoice::scaled)
    set_moving_mass();
  else
    set_step_over_mass();
}

/// Those of the state that last. What holds, drives or loads comes and goes; of all else there is as much as
/// there was.
template <int Dim>
template <class Array>
void Mechanics<Dim>::visit_array(StateVisitor& visitor, const char* name, Array& array) {
  using T = std::decay_t<decltype(*array.data())>;
  if constexpr (std::is_same_v<T, int>) {
    const bool is_of_bundles = static_cast<void*>(&array) == &storage_.constraints_of_bundle;
    visitor.visit(
        name, array,
        is_of_bundles ? state::within(-1, kMostOfAKind).of(array.size()) : state::within(0, kMostOfAKind));
  } else if constexpr (std::is_same_v<T, BundleConstraints> || std::is_same_v<T, Tie> ||
                       std::is_same_v<T, ConstraintPack<Dim>>) {
    visitor.visit_plain(name, array);
  } else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::uint8_t> ||
                       std::is_same_v<T, std::byte>) {
    throw Error(
        fmt::format("\"{}\" has no form in which a state can keep it", name));  // a fault of the program
  } else {
    visitor.visit_numbers(name, array, state::finite().of(array.size()));
  }
}

/// Throws Error where what holds, drives or loads names something that is not there. Only of what comes from
/// outside.
template <int Dim>
void Mechanics<Dim>::require_constraints(const StateVisitor& visitor) const {
  if (!visitor.checks()) return;
  const auto& s = storage_;
  const auto packs = static_cast<std::int64_t>(s.constraint_packs.size());
  const auto within = [](std::int64_t first, std::int64_t last, std::size_t size) {
    return 0 <= first && first <= last && last <= static_cast<std::int64_t>(size);
  };
  std::size_t made = 0, functions_of_made = 0, tied = 0;
  for (std::size_t b = 0; b < made_constraints_.size(); ++b)
    if (made_constraints_[b] >= 0) {
      ++made;
      functions_of_made += static_cast<std::size_t>(layout_->bundles[b].packs);
    }
  for (const TieOfBundle& tie : ties_) tied += tie.slots.size();
  visitor.require(s.constraints.size() == made, "constraints", "are not those of the bundles that have some");
  visitor.require(s.constraint_packs.size() == functions_of_made, "constraint_packs",
                  "are not those of the bundles that have some");
  visitor.require(s.ties.size() == ties_.size(), "ties", "are not as many as those of the bundles");
  visitor.require(s.tied_slots.size() == tied, "tied_slots", "are not as many as those of the bundles");
  for (std::size_t b = 0; b < made_constraints_.size(); ++b) {
    const int index = made_constraints_[b];
    visitor.require(s.constraints_of_bundle[b] < 0 || s.constraints_of_bundle[b] == index,
                    "constraints_of_bundle", "names others than those that were made for it");
    if (index < 0) continue;
    const Bundle& bundle = layout_->bundles[b];
    visitor.require(index < static_cast<int>(s.constraints.size()), "made_constraints",
                    "names one that is not there");
    const BundleConstraints& own = s.constraints[index];
    visitor.require(own.first_pack >= 0 && own.first_pack + static_cast<std::int64_t>(bundle.packs) <= packs,
                    "constraints", "names packs that are not there");
    visitor.require(within(own.first_tie, own.last_tie, s.ties.size()), "constraints",
                    "names ties that are not there");
    visitor.require(std::isfinite(own.loading_work), "constraints", "has a work that is not finite");
    for (int i = own.first_tie; i < own.last_tie; ++i) {
      const Tie& tie = s.ties[i];
      visitor.require(within(tie.begin, tie.end, s.tied_slots.size()), "ties",
                      "names slots that are not there");
      visitor.require(0 <= tie.component && tie.component < Dim, "ties", "has no direction of this body");
      for (int j = tie.begin; j < tie.end; ++j)
        visitor.require(is_slot_of(s.tied_slots[j], bundle), "tied_slots", "names a slot of another bundle");
    }
  }
  for (const auto& pack : s.constraint_packs)
    for (int i = 0; i < Dim; ++i)
      for (int lane = 0; lane < kLanes; ++lane)
        visitor.require(
            std::isfinite(pack.prescribed_velocity[i][lane]) && std::isfinite(pack.applied[i][lane]),
            "constraint_packs", "has a velocity or a force that is not finite");
  for (const TieOfBundle& tie : ties_) {
    visitor.require(made_constraints_[tie.bundle] >= 0, "ties_of_bundles",
                    "ties a bundle without constraints");
    for (const int slot : tie.slots)
      visitor.require(is_slot_of(slot, layout_->bundles[tie.bundle]), "ties_of_bundles",
                      "names a slot of another bundle");
  }
}

template <int Dim>
void Mechanics<Dim>::visit_ties(StateVisitor& visitor) {
  std::vector<int> numbers;
  for (const TieOfBundle& tie : ties_) {
    numbers.insert(numbers.end(), {tie.bundle, tie.component, static_cast<int>(tie.slots.size())});
    numbers.insert(numbers.end(), tie.slots.begin(), tie.slots.end());
  }
  visitor.visit("ties_of_bundles", numbers, state::within(0, kMostOfAKind));
  if (!visitor.replaces()) return;
  ties_.clear();
  for (auto i = numbers.begin(); i != numbers.end();) {
    visitor.require(numbers.end() - i >= 3 && i[2] <= numbers.end() - i - 3 && i[1] < Dim &&
                        i[0] < static_cast<int>(layout_->bundles.size()),
                    "ties_of_bundles", "is no list of ties");
    const auto slots = i + 3;
    const auto end = slots + i[2];
    ties_.push_back({i[0], i[1], {slots, end}});
    i = end;
  }
}

/// Of the temperatures that were last handed over; the field may be at others by now.
template <int Dim>
void Mechanics<Dim>::visit_properties(StateVisitor& visitor) {
  bool by_block = state_.by_bundle;
  visitor.visit("properties_by_block", by_block);
  std::vector<ZoneProperties> zones;
  if (by_block)
    for (int b = 0; b < model_.block_count(); ++b) zones.push_back(properties_.zones[model_.block_zones[b]]);
  else
    zones = properties_.zones;
  const int count = by_block ? model_.block_count() : model_.zone_count();
  visitor.visit_numbers("zone_properties", zones, state::finite().of(static_cast<std::size_t>(count)));

  ContactSets& sets = properties_.contacts;
  std::vector<int> laws, choices;
  std::vector<double> numbers;
  for (int set = 0; set < sets.size(); ++set) {
    laws.push_back(static_cast<int>(std::ranges::find(laws_, &sets.law(set)) - laws_.begin()));
    numbers.insert(numbers.end(), sets.numbers(set).begin(), sets.numbers(set).end());
    choices.insert(choices.end(), sets.choices(set).begin(), sets.choices(set).end());
  }
  visitor.visit("law_of_set", laws, state::index(laws_.size()));
  std::size_t number_count = 0, choice_count = 0;
  for (const int index : laws) {
    number_count += laws_.at(index)->properties.size();
    choice_count += laws_.at(index)->choices.size();
  }
  visitor.visit("numbers_of_sets", numbers, state::number().of(number_count));
  visitor.visit("choices_of_sets", choices, state::index(ChoiceInfo::kMostOptions).of(choice_count));
  visitor.visit("set_of_contact", properties_.of_contact,
                state::index(laws.size()).of(model_.contacts.size()));
  if (!visitor.replaces()) return;

  for (int b = 0; b < model_.block_count(); ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      properties_.zones[z] = zones.at(by_block ? b : z);
  sets = {};
  auto number = numbers.begin();
  auto choice = choices.begin();
  for (const int index : laws) {
    const LawTable& law = *laws_.at(index);
    const auto last_number = number + static_cast<std::ptrdiff_t>(law.properties.size());
    const auto last_choice = choice + static_cast<std::ptrdiff_t>(law.choices.size());
    std::copy(number, last_number, sets.add(law, {choice, last_choice}).begin());
    if (visitor.checks()) sets.validate(sets.size() - 1, law.name);
    number = last_number;
    choice = last_choice;
  }
}

template <int Dim>
void Mechanics<Dim>::sweep(int steps, Pass pass) {
  const bool measure = pass != Pass::move;
  const auto update_faces = [](State<Dim>& s, int first, int last, bool measured) {
    for_each_law(s, first, last, [&](const PackFunctions<Dim>& law, int begin, int end) {
      law.update(s, begin, end, measured);
    });
  };
  // A call ends before its last step where other work took the cores, and fewer threads go on.
  for (int left = steps, moved = 0; left > 0; left -= moved) {
    const int threads = std::clamp(model_.zone_count() / parameters_.zones_for_a_thread, 1, team_->offered());
    if (static_cast<int>(workers_.size()) != threads) {
      workers_.clear();
      for (Share& share : share_out(*layout_, threads))
        workers_.push_back({std::move(share), make_scratch()});
    }
    team_->run(threads, [&](int thread) {
      Worker& worker = workers_[static_cast<std::size_t>(thread)];
      State<Dim> s = state_;
      int taken = 0;
      for (bool is_crowded = false; taken < left && !is_crowded; ++taken) {
        for (const auto& faces : worker.share.crossing) update_faces(s, faces.first, faces.last, measure);
        team_->barrier();
        for (const auto& stride : worker.share.strides) {
          update_faces(s, stride.faces.first, stride.faces.last, measure);
          step_.passes.move_bundles(s, stride.bundles.first, stride.bundles.last, pass,
                                    worker.scratch.data());
        }
        is_crowded = team_->barrier();
      }
      if (thread == 0) moved = taken;
    });
  }
}

// The state in the order of the model

template <int Dim>
Vec<Dim> Mechanics<Dim>::displacement(int gridpoint) const {
  return state_.displacement[layout_->gridpoint_slot[gridpoint]];
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::velocity(int gridpoint) const {
  return vector_at<Dim>(state_.velocity, layout_->gridpoint_slot[gridpoint]);
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::force(int gridpoint) const {
  return vector_at<Dim>(state_.force, layout_->gridpoint_slot[gridpoint]);
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::applied_force(int gridpoint) const {
  const int index = made_constraints_[bundle_of(gridpoint)];
  if (index < 0) return {};
  const int slot = slot_in_bundle(gridpoint);
  const auto& pack = state_.constraint_packs[state_.constraints[index].first_pack + slot / kLanes];
  Vec<Dim> force;
  for (int i = 0; i < Dim; ++i) force[i] = pack.applied[i][slot % kLanes];
  return force;
}

/// That the last forces belong to.
template <int Dim>
Vec<Dim> Mechanics<Dim>::displacement_of_force(int gridpoint) const {
  return displacement(gridpoint) - velocity(gridpoint) * (steps_ > 0 ? time_step() : 0.0);
}

/// \param rotation  of the frame, out
template <int Dim>
SymmetricTensor<Dim> Mechanics<Dim>::stress_in_own_frame(int zone, Rotation<double>& rotation) const {
  std::array<Vec<Dim>, Dim + 1> u;
  for (int n = 0; n <= Dim; ++n) u[n] = displacement_of_force(model_.zones[zone][n]);
  const ZoneProperties p = properties_of_zone(zone);
  auto strain = mechanical_strain<Dim>(geometry_.gradient[zone], 1.0, u, p.thermal_strain,
                                       parameters_.kinematics, rotation);
  if (creeps())
    for (std::size_t i = 0; i < strain.size(); ++i) strain[i] -= creep_strain_[zone][i];
  return zone_stress<Dim>(p, strain);
}

template <int Dim>
SymmetricTensor<Dim> Mechanics<Dim>::stress(int zone) const {
  Rotation<double> rotation;
  const auto stress = stress_in_own_frame(zone, rotation);
  return rotated<Dim>(rotation, stress);
}

template <int Dim>
ZoneProperties Mechanics<Dim>::properties_of_zone(int zone) const {
  const ZoneProperties& p = properties_.zones[zone];
  if (creep_under_way_.empty()) return p;
  const CreepUnderWay& creep = creep_under_way_[zone];
  return with_compliance<Dim>(p, creep.split.compliance, creep.poisson);
}

template <int Dim>
SymmetricTensor<Dim> Mechanics<Dim>::creep_strain(int zone) const {
  if (!creeps()) return {};
  Rotation<double> rotation;
  stress_in_own_frame(zone, rotation);
  return rotated<Dim>(rotation, creep_strain_[zone]);
}

template <int Dim>
ContactFrame<Dim> Mechanics<Dim>::frame_of_forces(int contact) const {
  const auto& c = model_.contacts[model_.face_contacts[model_.contacts[contact].face]];
  if constexpr (Dim == 2) {
    if (parameters_.kinematics == Kinematics::finite) {
      // mean edge of the two sides
      const auto& d = model_.contacts[model_.face_contacts[c.face] + 1];
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
double Mechanics<Dim>::remembered(int contact, Remembers what) const {
  const LawTable& law = law_of(contact);
  const int place = place_of(law, what, Dim);
  if (place < 0) return 0.0;
  return lines_of(*layout_, state_.internals, state_.first_internal, contact,
                  law.internals(Dim).size())[place]
      .number[layout_->contact_slot[contact] % kLanes];
}

template <int Dim>
ContactState<Dim> Mechanics<Dim>::contact(int contact) const {
  const int set = properties_.of_contact[contact], lane = layout_->contact_slot[contact] % kLanes;
  ContactState<Dim> state;
  state.law = &law_of(contact);
  const auto values = [&](const auto& lines, const auto& first, std::size_t count) {
    std::vector<double> numbers(count);
    const Line* line = lines_of(*layout_, lines, first, contact, count);
    for (double& number : numbers) number = line++->number[lane];
    return numbers;
  };
  state.internals = values(state_.internals, state_.first_internal, state.law->internals(Dim).size());
  state.losses = values(state_.loss, state_.first_loss, state.law->losses.size());
  const auto frame = frame_of_forces(contact);
  const Vec<Dim> u = jump_of_forces(contact);
  state.opening = dot(u, frame.normal);
  for (int i = 0; i + 1 < Dim; ++i) state.tangential_jump[i] = dot(u, frame.tangents[i]);
  // the law at the jump that it was last taken to gives the tractions again
  std::array<double, Dim> jump{state.opening};
  for (int i = 0; i + 1 < Dim; ++i) jump[i + 1] = state.tangential_jump[i];
  auto internals = state.internals, losses = state.losses;
  const PointResponse response = state.law->update(Dim)(properties_.contacts[set].constants().data(),
                                                        jump.data(), internals.data(), losses.data());
  state.normal_traction = response.normal_traction;
  for (int i = 0; i + 1 < Dim; ++i) state.shear_traction[i] = response.shear_traction[i];
  state.stored = response.stored;
  return state;
}

template <int Dim>
double ContactState<Dim>::remembered(Remembers what) const {
  const int place = place_of(*law, what, Dim);
  return place < 0 ? 0.0 : internals[place];
}

template <int Dim>
double ContactState<Dim>::remembered(std::string_view name) const {
  const auto infos = law->internals(Dim);
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (infos[i].name == name) return internals[i];
  return 0.0;
}

template <int Dim>
double ContactState<Dim>::lost(std::string_view name) const {
  for (std::size_t i = 0; i < losses.size(); ++i)
    if (law->losses[i].name == name) return losses[i];
  return 0.0;
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
std::vector<Vec<Dim>> Mechanics<Dim>::displacements() const {
  return all(model_.gridpoint_count(), [&](int g) { return displacement(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Mechanics<Dim>::velocities() const {
  return all(model_.gridpoint_count(), [&](int g) { return velocity(g); });
}

template <int Dim>
std::vector<Vec<Dim>> Mechanics<Dim>::forces() const {
  return all(model_.gridpoint_count(), [&](int g) { return force(g); });
}

template <int Dim>
std::vector<SymmetricTensor<Dim>> Mechanics<Dim>::stresses() const {
  return all(model_.zone_count(), [&](int z) { return stress(z); });
}

template <int Dim>
std::vector<ContactState<Dim>> Mechanics<Dim>::contacts() const {
  return all(model_.contact_count(), [&](int c) { return contact(c); });
}

// Sums

template <int Dim>
Vec<Dim> Mechanics<Dim>::mean_displacement(const GridpointSet& set) const {
  const auto sum = chunked_sum<Vec<Dim>>(
      set.chunks, [&](int i, Vec<Dim>& total) { total += displacement(set.gridpoints[i]); });
  return sum * (1.0 / count(set.chunks));
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::net_force() const {
  return chunked_sum<Vec<Dim>>(layout_->chunks.gridpoints, [&](int g, Vec<Dim>& total) {
    const Vec<Dim> on_all = force(g);
    for (int i = 0; i < Dim; ++i)
      if (!is_prescribed(g, i)) total[i] += on_all[i];
  });
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::total_force(const GridpointSet& set) const {
  return chunked_sum<Vec<Dim>>(set.chunks,
                               [&](int i, Vec<Dim>& total) { total += force(set.gridpoints[i]); });
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::total_applied_force(const GridpointSet& set) const {
  return chunked_sum<Vec<Dim>>(set.chunks,
                               [&](int i, Vec<Dim>& total) { total += applied_force(set.gridpoints[i]); });
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::total_weight(const GridpointSet& set) const {
  return parameters_.gravity *
         chunked_sum(set.chunks, [&](int i) { return gravity_mass_[set.gridpoints[i]]; });
}

template <int Dim>
double Mechanics<Dim>::total_moving_mass(const GridpointSet& set) const {
  return chunked_sum(set.chunks, [&](int i) { return mass_[set.gridpoints[i]]; });
}

template <int Dim>
Dissipation Mechanics<Dim>::dissipated() const {
  struct Sums {
    std::array<double, kMostDissipations> energy{};
    void operator+=(const Sums& o) {
      for (std::size_t i = 0; i < energy.size(); ++i) energy[i] += o.energy[i];
    }
  };
  // of each law, where its losses count
  std::vector<std::vector<int>> places;
  for (const LawTable* law : laws_)
    for (auto& of_law = places.emplace_back(); const LossInfo& loss : law->losses) {
      const auto found = std::ranges::find(dissipations_, std::string_view(loss.name));
      of_law.push_back(found == dissipations_.end() ? -1 : static_cast<int>(found - dissipations_.begin()));
    }
  const Sums sums = chunked_sum<Sums>(layout_->chunks.face_packs, [&](int pack, Sums& sum) {
    const Line* line = state_.loss.data() + state_.first_loss[pack];
    for (int point = layout_->first_point_of(pack); point < layout_->first_point_of(pack + 1); ++point) {
      const double* const area = layout_->points[point].area;
      for (const int place : places[state_.law_of_faces[pack]]) {
        if (place >= 0)
          for (int lane = 0; lane < kLanes; ++lane) sum.energy[place] += line->number[lane] * area[lane];
        ++line;
      }
    }
  });
  Dissipation all{
      dissipations_,
      {sums.energy.begin(), sums.energy.begin() + static_cast<std::ptrdiff_t>(dissipations_.size())}};
  if (creeps())
    all.energies[static_cast<std::size_t>(std::ranges::find(all.names, kCreep) - all.names.begin())] +=
        creep_work_;
  return all;
}

double Dissipation::of(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? 0.0 : energies[static_cast<std::size_t>(found - names.begin())];
}

double Dissipation::total() const {
  return std::accumulate(energies.begin(), energies.end(), 0.0);
}

template <int Dim>
EnergyLedger Mechanics<Dim>::energy() const {
  struct Sums {
    double zones = 0.0, kinetic = 0.0, local_damping = 0.0, viscous_damping = 0.0, loading = 0.0;
    void operator+=(const Sums& o) {
      zones += o.zones;
      kinetic += o.kinetic;
      local_damping += o.local_damping;
      viscous_damping += o.viscous_damping;
      loading += o.loading;
    }
  };
  const auto sums = chunked_sum<Sums>(layout_->chunks.bundles, [&](int b, Sums& sum) {
    const BundleSums& of_bundle = state_.bundle_sums[b];
    const int c = made_constraints_[b];
    sum += {of_bundle.stored, of_bundle.kinetic, of_bundle.damping_work - of_bundle.begun_damping,
            of_bundle.viscous_work - of_bundle.begun_viscous,
            c >= 0 ? state_.constraints[c].loading_work - of_bundle.begun_loading : 0.0};
  });
  EnergyLedger e;
  e.property_change = property_change_;
  e.mass_scaling = mass_scaling_;
  e.zones = sums.zones;
  e.kinetic = sums.kinetic;
  e.local_damping = sums.local_damping;
  e.viscous_damping = sums.viscous_damping;
  e.loading = sums.loading;
  e.contacts =
      chunked_sum(layout_->chunks.face_packs, [&](int pack) { return state_.face_sums[pack].stored; });
  e.dissipated = dissipated();
  // weights are constant, so their work follows from the way made
  if (state_.weighs())
    e.gravity = chunked_sum(layout_->chunks.gridpoints, [&](int g) {
      return gravity_mass_[g] * dot(parameters_.gravity, displacement_of_force(g));
    });
  return e;
}

template <int Dim>
double Mechanics<Dim>::mean_unbalanced_force() const {
  return chunked_sum(layout_->chunks.bundles, [&](int b) { return state_.bundle_sums[b].unbalanced; }) /
         count(layout_->chunks.gridpoints);
}

template <int Dim>
double Mechanics<Dim>::unbalanced_ratio() const {
  const double unbalanced =
      chunked_sum(layout_->chunks.bundles, [&](int b) { return state_.bundle_sums[b].unbalanced; });
  const double applied =
      chunked_sum(layout_->chunks.bundles, [&](int b) { return state_.bundle_sums[b].applied; }) +
      chunked_sum(layout_->chunks.face_packs, [&](int pack) { return state_.face_sums[pack].applied; });
  return unbalanced / std::max(applied, least_force_);
}

template <int Dim>
double Mechanics<Dim>::largest_relative_jump() const {
  double largest = 0.0;
  for (const FaceSums& sums : state_.face_sums) largest = std::max(largest, sums.jump);
  return largest;
}

template BodyProperties by_interface<2>(const Model<2>&, std::vector<ZoneProperties>,
                                        const std::vector<ContactProperties>&);
template BodyProperties by_interface<3>(const Model<3>&, std::vector<ZoneProperties>,
                                        const std::vector<ContactProperties>&);
template struct ContactState<2>;
template struct ContactState<3>;
template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
