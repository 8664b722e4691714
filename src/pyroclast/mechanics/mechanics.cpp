#include "pyroclast/mechanics/mechanics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Without a branch: signs of vibrating motion cannot be predicted.
double sign(double x) {
  return static_cast<double>((x > 0.0) - (x < 0.0));
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
      geometry_(zone_geometry(model)),
      gridpoint_contacts_(gridpoint_contacts(model)),
      properties_(std::move(properties)) {
  const auto gridpoints = model.position.size();
  displacement_.resize(gridpoints);
  velocity_.resize(gridpoints);
  force_.resize(gridpoints);
  applied_.resize(gridpoints);
  if (parameters.damping_form == DampingForm::combined) previous_force_.resize(gridpoints);
  prescribed_velocity_.resize(gridpoints);
  prescribed_.resize(gridpoints);
  stress_.resize(model.zones.size());
  contact_state_.resize(model.contacts.size());
  contact_force_.resize(2 * model.contacts.size());
  if (Dim != 2 && parameters.kinematics == Kinematics::finite)
    throw Error("kinematics = finite: contact frames that turn are made for 2D only; use small");
  work_.resize(model.block_material.size());
  begun_.resize(model.block_material.size());
  kinetic_.resize(model.block_material.size());
  compute_stiffness();
  set_masses(densities);
}

/// k_gp of Eq. (9): for every gridpoint the largest sum of |stiffness| over a row of the assembled matrix,
/// zones and contacts. By Gershgorin's theorem no natural frequency exceeds sqrt(k_gp / m), so the step is
/// safe for any shape.
template <int Dim>
void Mechanics<Dim>::compute_stiffness() {
  std::vector<Vec<Dim>> row(model_.position.size());
  for (std::size_t z = 0; z < model_.zones.size(); ++z) {
    std::array<Vec<Dim>, Dim + 1> g{};
    for (int n = 0; n < Dim; ++n) {
      g[n] = geometry_.gradient[z][n];
      g[Dim] -= g[n];
    }
    const auto& p = properties_.zones[z];
    for (int m = 0; m <= Dim; ++m)
      for (int n = 0; n <= Dim; ++n)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) {
            double k = p.lambda * g[m][i] * g[n][j] + p.mu * g[m][j] * g[n][i];
            if (i == j) k += p.mu * dot(g[m], g[n]);
            row[model_.zones[z][m]][i] += std::abs(k) * geometry_.volume[z];
          }
  }
  for (std::size_t index = 0; index < model_.contacts.size(); ++index) {
    const auto& c = model_.contacts[index];
    const auto& p = properties_.contacts[properties_.of_contact[index]];
    for (int i = 0; i < Dim; ++i) {
      double sum = 0.0;
      for (int j = 0; j < Dim; ++j) {
        const double nn = c.normal[i] * c.normal[j];
        sum += std::abs(p.normal_stiffness * nn + p.shear_stiffness * ((i == j ? 1.0 : 0.0) - nn));
      }
      // once for the gridpoint itself, once for the one across
      row[c.a][i] += 2.0 * sum * c.area;
      row[c.b][i] += 2.0 * sum * c.area;
    }
  }
  stiffness_.resize(row.size());
  for (std::size_t g = 0; g < row.size(); ++g)
    stiffness_[g] = *std::max_element(row[g].c.begin(), row[g].c.end());
}

template <int Dim>
void Mechanics<Dim>::set_masses(const std::vector<double>& densities) {
  gravity_mass_.assign(model_.position.size(), 0.0);
  for (int b = 0; b < model_.block_count(); ++b)
    for (int z = model_.block_zones[b]; z < model_.block_zones[b + 1]; ++z)
      for (int g : model_.zones[z])
        gravity_mass_[g] += densities[model_.block_material[b]] * geometry_.volume[z] / (Dim + 1);
  for (double m : gravity_mass_) real_mass_ += m;

  if (parameters_.mass == MassChoice::real) {
    mass_ = gravity_mass_;
    moving_mass_ = real_mass_;
    time_step_ = real_mass_limit().step;
    set_step_over_mass();
  } else {
    scale_masses();
  }
}

/// Density scaling: the mass with which each gridpoint's own limit is the common step.
template <int Dim>
void Mechanics<Dim>::scale_masses() {
  time_step_ = parameters_.time_step;
  const double half = 0.5 * time_step_ / parameters_.safety;
  mass_.resize(stiffness_.size());
  moving_mass_ = 0.0;
  for (std::size_t g = 0; g < mass_.size(); ++g) {
    const double mass = stiffness_[g] * (1.0 + parameters_.local_damping) * half * half;
    // of the half step begun with the old mass; nothing moves yet when the first masses are made
    begun_mass_scaling_ += 0.5 * (mass - mass_[g]) * dot(velocity_[g], velocity_[g]);
    mass_[g] = mass;
    moving_mass_ += mass;
  }
  for (Tie& t : ties_) {
    t.mass = 0.0;
    for (int g : t.gridpoints) t.mass += mass_[g];
  }
  set_step_over_mass();
}

template <int Dim>
void Mechanics<Dim>::set_step_over_mass() {
  step_over_mass_.resize(mass_.size());
  for (std::size_t g = 0; g < mass_.size(); ++g) step_over_mass_[g] = time_step_ / mass_[g];
}

template <int Dim>
void Mechanics<Dim>::set_properties(BodyProperties properties) {
  // The ledger counts the work of forces by the trapezoidal rule. So the change is made at the displacements
  // of the last step's forces, and the half step already begun with the old ones is made good.
  const EnergyLedger before = energy();
  const double held_before = before.zones + before.contacts + before.dissipated.total();
  properties_ = std::move(properties);
  const auto next = displacement_;
  const auto old_force = force_;
  const double begun = steps_ > 0 ? time_step_ : 0.0;
  for (std::size_t g = 0; g < displacement_.size(); ++g) displacement_[g] -= velocity_[g] * begun;
  evaluate_forces();
  displacement_ = next;

  const EnergyLedger after = energy();
  heat_ += after.zones + after.contacts + after.dissipated.total() - held_before;
  for (std::size_t g = 0; g < force_.size(); ++g)
    begun_heat_ -= 0.5 * begun * dot(force_[g] - old_force[g], velocity_[g]);

  compute_stiffness();
  if (parameters_.mass == MassChoice::scaled) {
    scale_masses();
  } else if (const double limit = real_mass_limit().step / parameters_.safety;
             limit < time_step_ * (1.0 - 1e-9)) {
    throw Error(fmt::format(
        "the body got stiffer at its new temperature: the time step {:.3g} s of its real mass is not stable "
        "any more (now {:.3g} s); start from a smaller safety, or scale the mass",
        time_step_, limit));
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
void Mechanics<Dim>::prescribe_velocity(int gridpoint, int component, double velocity) {
  prescribed_[gridpoint] = static_cast<std::uint8_t>(prescribed_[gridpoint] | (1U << component));
  prescribed_velocity_[gridpoint][component] = velocity;
}

template <int Dim>
void Mechanics<Dim>::release(int gridpoint, int component) {
  prescribed_[gridpoint] = static_cast<std::uint8_t>(prescribed_[gridpoint] & ~(1U << component));
}

template <int Dim>
void Mechanics<Dim>::tie(std::vector<int> gridpoints, int component) {
  const auto after =
      std::upper_bound(model_.block_gridpoints.begin(), model_.block_gridpoints.end(), gridpoints.front());
  const int block = static_cast<int>(after - model_.block_gridpoints.begin()) - 1;
  double mass = 0.0, momentum = 0.0;
  for (int g : gridpoints) {
    mass += mass_[g];
    momentum += mass_[g] * velocity_[g][component];
  }
  for (int g : gridpoints) velocity_[g][component] = momentum / mass;
  ties_.push_back({block, component, std::move(gridpoints), mass});
}

template <int Dim>
void Mechanics<Dim>::apply_force(int gridpoint, const Vec<Dim>& force) {
  applied_[gridpoint] = force;
}

template <int Dim>
void Mechanics<Dim>::break_contact(int contact) {
  contact_state_[contact].history.tension_damage = 1.0;
  contact_state_[contact].history.shear_damage = 1.0;
}

template <int Dim>
void Mechanics<Dim>::advance(int steps) {
  if (steps > 0) {
    heat_ += std::exchange(begun_heat_, 0.0);
    mass_scaling_ += std::exchange(begun_mass_scaling_, 0.0);
  }
  const int faces = model_.contact_count() / Dim;
  const int blocks = model_.block_count();
#pragma omp parallel
  for (int i = 0; i < steps; ++i) {
#pragma omp for schedule(static)
    for (int f = 0; f < faces; ++f) update_face(f);
#pragma omp for schedule(static)
    for (int b = 0; b < blocks; ++b) {
      add_zone_forces(b);
      complete_forces(b);
      move_gridpoints(b);
    }
  }
  steps_ += steps;
}

/// Forces at the present displacements, without moving.
template <int Dim>
void Mechanics<Dim>::evaluate_forces() {
  const int faces = model_.contact_count() / Dim;
  const int blocks = model_.block_count();
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int f = 0; f < faces; ++f) update_face(f);
#pragma omp for schedule(static)
    for (int b = 0; b < blocks; ++b) {
      add_zone_forces(b);
      complete_forces(b);
    }
  }
}

/// Contact points of one shared face: jumps to tractions to forces, Eqs. (10)-(15).
template <int Dim>
void Mechanics<Dim>::update_face(int face) {
  const int first = face * Dim;
  const ContactFrame<Dim> frame = current_frame(first);
  for (int c = first; c < first + Dim; ++c) {
    const Vec<Dim> force = update_contact_point(c, frame);
    contact_force_[2 * c] = force;
    contact_force_[2 * c + 1] = -force;
  }
  if constexpr (Dim == 2)
    if (parameters_.kinematics == Kinematics::finite) add_turning_force(first, frame);
}

template <int Dim>
ContactFrame<Dim> Mechanics<Dim>::current_frame(int first) const {
  const auto& c = model_.contacts[first];
  if constexpr (Dim == 2) {
    if (parameters_.kinematics == Kinematics::finite) {
      // mean edge of the two sides
      const auto& d = model_.contacts[first + 1];
      const auto& x = model_.position;
      const auto& u = displacement_;
      const Vec<2> edge =
          0.5 * ((x[d.a] - x[c.a]) + (x[d.b] - x[c.b]) + (u[d.a] - u[c.a]) + (u[d.b] - u[c.b]));
      const double length = norm(edge);
      const Vec<2> t = edge * (1.0 / length);
      return {{{t[1], -t[0]}}, {t}, length};
    }
  }
  return {c.normal, c.tangents, 0.0};
}

/// Takes one contact point through the law; returns the force on its side a.
template <int Dim>
Vec<Dim> Mechanics<Dim>::update_contact_point(int index, const ContactFrame<Dim>& frame) {
  const auto& c = model_.contacts[index];
  auto& state = contact_state_[index];
  const Vec<Dim> u = displacement_[c.b] - displacement_[c.a];
  state.opening = dot(u, frame.normal);
  for (int i = 0; i + 1 < Dim; ++i) state.tangential_jump[i] = dot(u, frame.tangents[i]);
  const auto response = update_contact<Dim>(properties_.contacts[properties_.of_contact[index]],
                                            state.opening, state.tangential_jump, state.history);
  state.normal_traction = response.normal_traction;
  state.shear_traction = response.shear_traction;
  state.stored = response.stored;
  state.dissipated += response.dissipated;
  Vec<Dim> traction = frame.normal * response.normal_traction;
  for (int i = 0; i + 1 < Dim; ++i) traction += frame.tangents[i] * response.shear_traction[i];
  return traction * c.area;
}

/// Where the frame turns with the edge, so do the components of a jump. The forces that do the work of the
/// tractions on that part keep moments in balance: minus the derivative of the jump's components by the
/// edge's gridpoints.
template <int Dim>
void Mechanics<Dim>::add_turning_force(int first, const ContactFrame<Dim>& frame) {
  double q = 0.0;
  for (int c = first; c < first + Dim; ++c) {
    const auto& s = contact_state_[c];
    q += model_.contacts[c].area / frame.length *
         (s.shear_traction[0] * s.opening - s.normal_traction * s.tangential_jump[0]);
  }
  const Vec<Dim> force = frame.normal * (0.5 * q);
  for (int side : {0, 1}) {
    contact_force_[2 * first + side] += force;
    contact_force_[2 * (first + 1) + side] -= force;
  }
}

/// Internal forces F_z of a block's gridpoints, Eqs. (4) and (5). Starts the sum of forces.
template <int Dim>
void Mechanics<Dim>::add_zone_forces(int block) {
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g) force_[g] = {};
  for (int z = model_.block_zones[block]; z < model_.block_zones[block + 1]; ++z) {
    const auto& corner = model_.zones[z];
    const auto& p = properties_.zones[z];
    std::array<Vec<Dim>, Dim + 1> u;
    for (int n = 0; n <= Dim; ++n) u[n] = displacement_[corner[n]];
    Rotation rotation;
    const auto strain =
        mechanical_strain<Dim>(geometry_.gradient[z], u, p.thermal_strain, parameters_.kinematics, rotation);
    const auto stress = zone_stress<Dim>(p, strain);
    stress_[z] = rotated<Dim>(rotation, stress);
    Vec<Dim> last{};
    for (int n = 0; n < Dim; ++n) {
      const Vec<Dim> f =
          rotated<Dim>(rotation, apply<Dim>(stress, geometry_.gradient[z][n])) * geometry_.volume[z];
      force_[corner[n]] -= f;
      last += f;
    }
    force_[corner[Dim]] += last;
  }
}

template <int Dim>
Vec<Dim> Mechanics<Dim>::contact_forces(int g) const {
  Vec<Dim> sum{};
  for (int k = gridpoint_contacts_.begin[g]; k < gridpoint_contacts_.begin[g + 1]; ++k)
    sum += contact_force_[gridpoint_contacts_.contact_side[k]];
  return sum;
}

/// Completes the sum of forces (4) and shares it out where gridpoints are tied.
template <int Dim>
void Mechanics<Dim>::complete_forces(int block) {
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g)
    force_[g] = force_[g] + contact_forces(g) + parameters_.gravity * gravity_mass_[g] + applied_[g];
  for (const Tie& t : ties_) {
    if (t.block != block) continue;
    double sum = 0.0;
    for (int g : t.gridpoints) sum += force_[g][t.component];
    for (int g : t.gridpoints) force_[g][t.component] = sum * mass_[g] / t.mass;
  }
}

/// Damps the sum of forces (8) and integrates velocity and displacement (6), (7).
template <int Dim>
void Mechanics<Dim>::move_gridpoints(int block) {
  const double dt = time_step_;
  const double lambda = parameters_.local_damping;
  const double xi = parameters_.viscous_damping;
  const bool combined = parameters_.damping_form == DampingForm::combined;
  const double kept = 1.0 - 0.5 * xi * dt;
  const double over = 1.0 / (1.0 + 0.5 * xi * dt);
  BlockWork done, begun;
  double kinetic = 0.0;
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g) {
    const double mass = mass_[g];
    const Vec<Dim> weight = parameters_.gravity * gravity_mass_[g];
    const Vec<Dim> applied = applied_[g];
    const Vec<Dim> sum = force_[g];
    const Vec<Dim> before = velocity_[g];
    Vec<Dim> change{};
    if (combined) {
      change = sum - previous_force_[g];
      previous_force_[g] = sum;
    }
    Vec<Dim> after;
    for (int i = 0; i < Dim; ++i) {
      double loading = applied[i], damping = 0.0, drag = 0.0;
      if (prescribed_[g] >> i & 1) {
        after[i] = prescribed_velocity_[g][i];
        loading += mass * (after[i] - before[i]) / dt - sum[i];  // the reaction
      } else {
        const double opposing = combined ? 0.5 * (sign(before[i]) - sign(change[i])) : sign(before[i]);
        damping = lambda * std::abs(sum[i]) * opposing;
        after[i] = (kept * before[i] + (sum[i] - damping) * step_over_mass_[g]) * over;
        drag = xi * mass * 0.5 * (before[i] + after[i]);
      }
      const double to = 0.5 * before[i] * dt, from = 0.5 * after[i] * dt;
      done.add({loading * to, weight[i] * to, damping * to, drag * to});
      begun.add({loading * from, weight[i] * from, damping * from, drag * from});
    }
    kinetic += 0.5 * mass * dot(before, after);
    velocity_[g] = after;
    displacement_[g] += after * dt;
  }
  work_[block].add(begun_[block]);
  work_[block].add(done);
  begun_[block] = begun;
  kinetic_[block] = kinetic;
}

template <int Dim>
EnergyLedger Mechanics<Dim>::energy() const {
  EnergyLedger e;
  e.heat = heat_;
  e.mass_scaling = mass_scaling_;
  for (const auto& w : work_) {
    e.loading += w.loading;
    e.gravity += w.gravity;
    e.local_damping += w.local_damping;
    e.viscous_damping += w.viscous_damping;
  }
  for (std::size_t z = 0; z < model_.zones.size(); ++z) {
    const auto& p = properties_.zones[z];
    std::array<Vec<Dim>, Dim + 1> u;
    for (int n = 0; n <= Dim; ++n) {
      const int g = model_.zones[z][n];
      // of the configuration that the last forces and contact states belong to
      u[n] = displacement_[g] - velocity_[g] * (steps_ > 0 ? time_step_ : 0.0);
    }
    Rotation ignored;
    const auto strain =
        mechanical_strain<Dim>(geometry_.gradient[z], u, p.thermal_strain, parameters_.kinematics, ignored);
    e.zones += energy_density<Dim>(zone_stress<Dim>(p, strain), strain) * geometry_.volume[z];
  }
  for (std::size_t c = 0; c < contact_state_.size(); ++c) {
    const double area = model_.contacts[c].area;
    const auto& s = contact_state_[c];
    e.contacts += s.stored * area;
    e.dissipated.tension += s.dissipated.tension * area;
    e.dissipated.shear += s.dissipated.shear * area;
    e.dissipated.friction += s.dissipated.friction * area;
    e.dissipated.compression += s.dissipated.compression * area;
  }
  for (double kinetic : kinetic_) e.kinetic += kinetic;
  return e;
}

template <int Dim>
double Mechanics<Dim>::unbalanced_ratio() const {
  double applied = 0.0;
  for (std::size_t z = 0; z < model_.zones.size(); ++z) {
    Vec<Dim> last{};
    for (int n = 0; n < Dim; ++n) {
      const Vec<Dim> f = apply<Dim>(stress_[z], geometry_.gradient[z][n]) * geometry_.volume[z];
      applied += norm(f);
      last += f;
    }
    applied += norm(last);
  }
  for (const auto& f : contact_force_) applied += norm(f);
  double unbalanced = 0.0;
  for (std::size_t g = 0; g < mass_.size(); ++g) {
    applied += norm(parameters_.gravity) * gravity_mass_[g] + norm(applied_[g]);
    Vec<Dim> free = force_[g];
    for (int i = 0; i < Dim; ++i)
      if (prescribed_[g] >> i & 1) free[i] = 0.0;
    unbalanced += norm(free);
  }
  return applied > 0.0 ? unbalanced / applied : 0.0;
}

template <int Dim>
double Mechanics<Dim>::largest_relative_jump() const {
  double largest = 0.0;
  for (const auto& c : model_.contacts) {
    const double length = Dim == 2 ? Dim * c.area / model_.thickness : std::sqrt(2.0 * Dim * c.area);
    largest = std::max(largest, norm(displacement_[c.b] - displacement_[c.a]) / length);
  }
  return largest;
}

template BodyProperties by_interface<2>(const Model<2>&, std::vector<ZoneProperties>,
                                        std::vector<ContactProperties>);
template BodyProperties by_interface<3>(const Model<3>&, std::vector<ZoneProperties>,
                                        std::vector<ContactProperties>);
template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
