#include "pyroclast/mechanics/mechanics.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

double sign(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }

}  // namespace

template <int Dim>
Mechanics<Dim>::Mechanics(const Model<Dim>& model, const std::vector<double>& densities,
                          std::vector<ZoneProperties> zones, std::vector<ContactProperties> interfaces,
                          const MechanicsParameters<Dim>& parameters)
    : model_(model),
      parameters_(parameters),
      geometry_(zone_geometry(model)),
      gridpoint_contacts_(gridpoint_contacts(model)),
      zone_properties_(std::move(zones)),
      interfaces_(std::move(interfaces)) {
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
  contact_force_.resize(model.contacts.size());
  work_.resize(static_cast<std::size_t>(model.block_count()));
  compute_stiffness();
  set_masses(densities);
}

/// k_gp of Eq. (9): for every gridpoint the largest sum of |stiffness| over a row of the assembled matrix, zones and
/// contacts. By Gershgorin's theorem no natural frequency exceeds sqrt(k_gp / m), so the step is safe for any shape.
template <int Dim>
void Mechanics<Dim>::compute_stiffness() {
  std::vector<Vec<Dim>> row(model_.position.size());
  for (std::size_t z = 0; z < model_.zones.size(); ++z) {
    std::array<Vec<Dim>, Dim + 1> g{};
    for (int n = 0; n < Dim; ++n) {
      g[n] = geometry_.gradient[z][n];
      g[Dim] -= g[n];
    }
    const auto& p = zone_properties_[z];
    for (int m = 0; m <= Dim; ++m)
      for (int n = 0; n <= Dim; ++n)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) {
            double k = p.lambda * g[m][i] * g[n][j] + p.mu * g[m][j] * g[n][i];
            if (i == j) k += p.mu * dot(g[m], g[n]);
            row[model_.zones[z][m]][i] += std::abs(k) * geometry_.volume[z];
          }
  }
  for (const auto& c : model_.contacts) {
    const auto& p = interfaces_[c.interface];
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
  for (std::size_t g = 0; g < row.size(); ++g) stiffness_[g] = *std::max_element(row[g].c.begin(), row[g].c.end());
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
    return;
  }
  time_step_ = parameters_.time_step;
  const double half = 0.5 * time_step_ / parameters_.safety;
  mass_.resize(stiffness_.size());
  for (std::size_t g = 0; g < mass_.size(); ++g) {
    mass_[g] = stiffness_[g] * (1.0 + parameters_.local_damping) * half * half;
    moving_mass_ += mass_[g];
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
  const int contacts = model_.contact_count();
  const int blocks = model_.block_count();
#pragma omp parallel
  for (int i = 0; i < steps; ++i) {
#pragma omp for schedule(static)
    for (int c = 0; c < contacts; ++c) update_contact_point(c);
#pragma omp for schedule(static)
    for (int b = 0; b < blocks; ++b) {
      add_zone_forces(b);
      move_gridpoints(b);
    }
  }
  steps_ += steps;
}

/// Jump to traction and force, Eqs. (10)-(15).
template <int Dim>
void Mechanics<Dim>::update_contact_point(int index) {
  const auto& c = model_.contacts[index];
  auto& state = contact_state_[index];
  const Vec<Dim> u = jump(c);
  Tangential<Dim> tangential;
  for (int i = 0; i + 1 < Dim; ++i) tangential[i] = dot(u, c.tangents[i]);
  const auto response =
      update_contact<Dim>(interfaces_[c.interface], dot(u, c.normal), tangential, state.history);
  state.normal_traction = response.normal_traction;
  state.shear_traction = response.shear_traction;
  state.stored = response.stored;
  state.dissipated.tension += response.dissipated.tension;
  state.dissipated.shear += response.dissipated.shear;
  state.dissipated.friction += response.dissipated.friction;
  state.dissipated.compression += response.dissipated.compression;
  Vec<Dim> traction = c.normal * response.normal_traction;
  for (int i = 0; i + 1 < Dim; ++i) traction += c.tangents[i] * response.shear_traction[i];
  contact_force_[index] = traction * c.area;
}

/// Internal forces F_z of a block's gridpoints, Eqs. (4) and (5). Starts the sum of forces.
template <int Dim>
void Mechanics<Dim>::add_zone_forces(int block) {
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g) force_[g] = {};
  for (int z = model_.block_zones[block]; z < model_.block_zones[block + 1]; ++z) {
    const auto& corner = model_.zones[z];
    const auto& p = zone_properties_[z];
    std::array<Vec<Dim>, Dim + 1> u;
    for (int n = 0; n <= Dim; ++n) u[n] = displacement_[corner[n]];
    stress_[z] = zone_stress<Dim>(p, mechanical_strain<Dim>(geometry_.gradient[z], u, p.thermal_strain));
    Vec<Dim> last{};
    for (int n = 0; n < Dim; ++n) {
      const Vec<Dim> f = apply<Dim>(stress_[z], geometry_.gradient[z][n]) * geometry_.volume[z];
      force_[corner[n]] -= f;
      last += f;
    }
    force_[corner[Dim]] += last;
  }
}

template <int Dim>
void Mechanics<Dim>::add_contact_forces(int g) {
  for (int k = gridpoint_contacts_.begin[g]; k < gridpoint_contacts_.begin[g + 1]; ++k) {
    const int tagged = gridpoint_contacts_.contact[k];
    if (tagged & 1)
      force_[g] -= contact_force_[tagged >> 1];
    else
      force_[g] += contact_force_[tagged >> 1];
  }
}

/// Completes the sum of forces, damps it (8) and integrates velocity and displacement (6), (7).
template <int Dim>
void Mechanics<Dim>::move_gridpoints(int block) {
  const double dt = time_step_;
  const double lambda = parameters_.local_damping;
  const bool combined = parameters_.damping_form == DampingForm::combined;
  const double half_xi = 0.5 * parameters_.viscous_damping * dt;
  BlockWork& work = work_[block];
  for (int g = model_.block_gridpoints[block]; g < model_.block_gridpoints[block + 1]; ++g) {
    add_contact_forces(g);
    const Vec<Dim> weight = parameters_.gravity * gravity_mass_[g];
    force_[g] += weight + applied_[g];
    for (int i = 0; i < Dim; ++i) {
      const double before = velocity_[g][i];
      const double sum = force_[g][i];
      double after;
      if (prescribed_[g] >> i & 1) {
        after = prescribed_velocity_[g][i];
        const double reaction = mass_[g] * (after - before) / dt - sum;
        work.loading += (reaction + applied_[g][i]) * 0.5 * (before + after) * dt;
      } else {
        const double damping = lambda * std::abs(sum) * (combined ? 0.5 * (sign(before) - sign(sum - previous_force_[g][i])) : sign(before));
        after = ((1.0 - half_xi) * before + (sum - damping) * dt / mass_[g]) / (1.0 + half_xi);
        const double mean = 0.5 * (before + after);
        work.local_damping += damping * mean * dt;
        work.viscous_damping += parameters_.viscous_damping * mass_[g] * mean * mean * dt;
        work.loading += applied_[g][i] * mean * dt;
      }
      work.gravity += weight[i] * 0.5 * (before + after) * dt;
      velocity_[g][i] = after;
      displacement_[g][i] += after * dt;
    }
    if (combined) previous_force_[g] = force_[g];
  }
}

template <int Dim>
EnergyLedger Mechanics<Dim>::energy() const {
  EnergyLedger e;
  for (const auto& w : work_) {
    e.loading += w.loading;
    e.gravity += w.gravity;
    e.local_damping += w.local_damping;
    e.viscous_damping += w.viscous_damping;
  }
  for (std::size_t z = 0; z < model_.zones.size(); ++z) {
    const auto& p = zone_properties_[z];
    std::array<Vec<Dim>, Dim + 1> u;
    for (int n = 0; n <= Dim; ++n) {
      const int g = model_.zones[z][n];
      // of the configuration that the last forces and contact states belong to
      u[n] = displacement_[g] - velocity_[g] * (steps_ > 0 ? time_step_ : 0.0);
    }
    const auto strain = mechanical_strain<Dim>(geometry_.gradient[z], u, p.thermal_strain);
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
  for (std::size_t g = 0; g < mass_.size(); ++g) e.kinetic += 0.5 * mass_[g] * dot(velocity_[g], velocity_[g]);
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
  for (const auto& f : contact_force_) applied += 2.0 * norm(f);
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
    largest = std::max(largest, norm(jump(c)) / length);
  }
  return largest;
}

template class Mechanics<2>;
template class Mechanics<3>;

}  // namespace pyroclast
