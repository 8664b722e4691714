#include "textbook.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pyroclast/base/error.hpp"

namespace textbook {

namespace {

constexpr double kNeverReached = 1e300;  // Pa

/// Every law that the textbook knows, as the paper's.
pyroclast::Cohesive::Properties<double> as_cohesive(const pyroclast::ContactProperties& properties) {
  if (properties.law == &pyroclast::table_of<pyroclast::Cohesive>())
    return properties.as<pyroclast::Cohesive>();
  pyroclast::Cohesive::Properties<double> p;
  p.compressive_limit = kNeverReached;
  p.hardening = 0.5;
  if (properties.law == &pyroclast::table_of<pyroclast::Elastic>()) {
    const auto elastic = properties.as<pyroclast::Elastic>();
    p.normal_stiffness = elastic.normal_stiffness;
    p.shear_stiffness = elastic.shear_stiffness;
  } else {
    const auto frictional = properties.as<pyroclast::Frictional>();
    p.normal_stiffness = frictional.normal_stiffness;
    p.shear_stiffness = frictional.shear_stiffness;
    p.friction_angle = p.residual_friction_angle = std::atan(frictional.friction);
  }
  return p;
}

}  // namespace

Law::Law(const pyroclast::ContactProperties& properties)
    : p(as_cohesive(properties)),
      fails(properties.law != &pyroclast::table_of<pyroclast::Elastic>()),
      held(properties.law != &pyroclast::table_of<pyroclast::Frictional>()),
      friction(std::tan(p.friction_angle)),
      residual_friction(std::tan(p.residual_friction_angle)),
      elastic_opening(p.tensile_strength / p.normal_stiffness),
      ultimate_opening(p.tensile_strength > 0.0 ? 2.0 * p.mode_1_energy / p.tensile_strength : 0.0),
      yield_slope(p.hardening * p.normal_stiffness / (1.0 - p.hardening)) {}

Body::Body(const pyroclast::ModelOf<2>& model, const std::vector<double>& densities,
           const pyroclast::BodyProperties& properties, const pyroclast::MechanicsParameters& parameters)
    : parameters_(parameters), gridpoints_(model.position.size()) {
  if (parameters.kinematics != pyroclast::Kinematics::small)
    throw pyroclast::Error("the textbook step knows small kinematics only");
  make_zones(model, properties);
  make_contacts(model, properties);
  set_masses(model, densities);
}

void Body::make_zones(const pyroclast::ModelOf<2>& model, const pyroclast::BodyProperties& properties) {
  for (std::size_t i = 0; i < model.zones.size(); ++i) {
    Zone z{};
    double x[3], y[3];
    for (int n = 0; n < 3; ++n) {
      z.gridpoint[n] = model.zones[i][n];
      x[n] = model.position[z.gridpoint[n]][0];
      y[n] = model.position[z.gridpoint[n]][1];
    }
    const double twice_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    for (int n = 0; n < 3; ++n) {
      const int next = (n + 1) % 3, after = (n + 2) % 3;
      z.dx[n] = (y[next] - y[after]) / twice_area;
      z.dy[n] = (x[after] - x[next]) / twice_area;
    }
    z.volume = 0.5 * twice_area * model.thickness;
    const auto& p = properties.zones[i];
    z.d11 = p.lambda + 2.0 * p.mu;
    z.d12 = p.lambda;
    z.shear_modulus = p.mu;
    z.thermal_strain = p.thermal_strain;
    zones_.push_back(z);
  }
}

void Body::make_contacts(const pyroclast::ModelOf<2>& model, const pyroclast::BodyProperties& properties) {
  for (int set = 0; set < properties.contacts.size(); ++set) laws_.emplace_back(properties.contacts[set]);
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    const auto& c = model.contacts[i];
    contacts_.push_back({.a = c.a,
                         .b = c.b,
                         .normal = {c.normal[0], c.normal[1]},
                         .tangent = {c.tangents[0][0], c.tangents[0][1]},
                         .area = c.area,
                         .law = properties.of_contact[i]});
  }
}

/// Largest sum of |K_ij| over the two rows of each gridpoint, N/m.
std::vector<double> Body::stiffness() const {
  std::vector<double> row(2 * gridpoints_.size());
  for (const Zone& z : zones_) {
    std::array<std::array<double, 6>, 3> strain{};  // strain-displacement matrix B, with engineering shear
    for (int n = 0; n < 3; ++n) {
      const int x = 2 * n, y = x + 1;
      strain[0][x] = z.dx[n];
      strain[1][y] = z.dy[n];
      strain[2][x] = z.dy[n];
      strain[2][y] = z.dx[n];
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double k = strain[0][i] * (z.d11 * strain[0][j] + z.d12 * strain[1][j]) +
                         strain[1][i] * (z.d12 * strain[0][j] + z.d11 * strain[1][j]) +
                         strain[2][i] * z.shear_modulus * strain[2][j];
        row[2 * z.gridpoint[i / 2] + i % 2] += std::abs(k) * z.volume;
      }
  }
  for (const ContactPoint& c : contacts_) {
    const auto& p = laws_[c.law].p;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        const double k = std::abs(p.normal_stiffness * c.normal[i] * c.normal[j] +
                                  p.shear_stiffness * c.tangent[i] * c.tangent[j]);
        row[2 * c.a + i] += 2.0 * k * c.area;  // the gridpoint's own displacement and the other's
        row[2 * c.b + i] += 2.0 * k * c.area;
      }
  }
  std::vector<double> largest(gridpoints_.size());
  for (std::size_t g = 0; g < largest.size(); ++g) largest[g] = std::max(row[2 * g], row[2 * g + 1]);
  return largest;
}

void Body::set_masses(const pyroclast::ModelOf<2>& model, const std::vector<double>& densities) {
  std::vector<double> real_mass(gridpoints_.size());
  for (int b = 0; b < model.block_count(); ++b)
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
      for (int g : zones_[z].gridpoint)
        real_mass[g] += densities[model.block_material[b]] * zones_[z].volume / 3.0;

  const auto k = stiffness();
  const double damped = 1.0 + parameters_.local_damping;
  const double safety = parameters_.safety;
  if (parameters_.mass == pyroclast::MassChoice::scaled) {
    time_step_ = parameters_.time_step;
    const double half = 0.5 * time_step_ / safety;
    for (std::size_t g = 0; g < k.size(); ++g) gridpoints_[g].mass = half * half * k[g] * damped;
  } else {
    time_step_ = std::numeric_limits<double>::max();
    for (std::size_t g = 0; g < k.size(); ++g) {
      gridpoints_[g].mass = real_mass[g];
      time_step_ = std::min(time_step_, safety * 2.0 * std::sqrt(real_mass[g] / (k[g] * damped)));
    }
  }
  for (std::size_t g = 0; g < k.size(); ++g)
    for (int i = 0; i < 2; ++i) gridpoints_[g].load[i] = parameters_.gravity[i] * real_mass[g];
}

void Body::prescribe_velocity(int gridpoint, int component, double velocity) {
  gridpoints_[gridpoint].prescribed[component] = true;
  gridpoints_[gridpoint].prescribed_velocity[component] = velocity;
}

void Body::release(int gridpoint, int component) {
  gridpoints_[gridpoint].prescribed[component] = false;
}

void Body::break_contact(int contact) {
  contacts_[contact].tension_damage = 1.0;
  contacts_[contact].shear_damage = 1.0;
}

void Body::advance(int steps) {
  for (int i = 0; i < steps; ++i) {
    for (Gridpoint& g : gridpoints_)
      for (int k = 0; k < 2; ++k) g.force[k] = g.load[k];
    strain_zones();
    update_contacts();
    move();
  }
}

/// Eqs. (4), (5): strains to stresses to forces.
void Body::strain_zones() {
  for (Zone& z : zones_) {
    double exx = -z.thermal_strain, eyy = -z.thermal_strain, gxy = 0.0;
    for (int n = 0; n < 3; ++n) {
      const double* u = gridpoints_[z.gridpoint[n]].displacement;
      exx += z.dx[n] * u[0];
      eyy += z.dy[n] * u[1];
      gxy += z.dy[n] * u[0] + z.dx[n] * u[1];
    }
    z.stress[0] = z.d11 * exx + z.d12 * eyy;
    z.stress[1] = z.d12 * exx + z.d11 * eyy;
    z.stress[2] = z.shear_modulus * gxy;
    for (int n = 0; n < 3; ++n) {
      double* f = gridpoints_[z.gridpoint[n]].force;
      f[0] -= z.volume * (z.stress[0] * z.dx[n] + z.stress[2] * z.dy[n]);
      f[1] -= z.volume * (z.stress[2] * z.dx[n] + z.stress[1] * z.dy[n]);
    }
  }
}

namespace {

/// Eqs. (10), (11), (15): opening to normal traction.
void update_normal(const Law& law, double opening, ContactPoint& c) {
  const auto& p = law.p;
  const double k = p.normal_stiffness;
  if (!law.fails) {
    c.normal_traction = k * opening;
    return;
  }
  if (opening + c.closure <= 0.0) {
    if (p.compression == pyroclast::Cohesive::Compression::reversible) {
      const double limit = p.compressive_limit / k;
      c.normal_traction =
          -opening > limit ? -p.compressive_limit + p.hardening * k * (opening + limit) : k * opening;
      return;
    }
    const double trial = k * (opening + c.closure);
    const double excess = -trial - (p.compressive_limit + law.yield_slope * c.closure);
    if (excess > 0.0) c.closure += excess / (k + law.yield_slope);
    c.normal_traction = k * (opening + c.closure);
    return;
  }
  const double stretch = opening + c.closure;
  if (law.held && c.tension_damage < 1.0) {
    const double softening = law.ultimate_opening - law.elastic_opening;
    c.tension_damage = std::min(1.0, std::max(c.tension_damage, (stretch - law.elastic_opening) / softening));
    const double furthest = law.elastic_opening + c.tension_damage * softening;
    c.normal_traction = (1.0 - c.tension_damage) * p.tensile_strength / furthest * stretch;
  } else {
    c.normal_traction = 0.0;
  }
}

/// Eqs. (12)-(14): elastic predictor, then return to the softening Mohr-Coulomb strength.
void update_shear(const Law& law, double opening, double tangential_jump, ContactPoint& c) {
  const auto& p = law.p;
  const double k = p.shear_stiffness;
  const double trial = c.shear_traction + k * (tangential_jump - c.tangential_jump);
  c.tangential_jump = tangential_jump;
  c.shear_traction = trial;
  if (!law.fails) return;
  if ((!law.held || c.tension_damage >= 1.0) && opening + c.closure > 0.0) {
    c.shear_traction = 0.0;
    return;
  }
  const double cohesion = p.coupled ? (1.0 - c.tension_damage) * p.cohesion : p.cohesion;
  const double peak = std::max(0.0, cohesion - c.normal_traction * law.friction);
  const double residual = std::min(peak, std::max(0.0, std::min(p.residual_cohesion, cohesion) -
                                                           c.normal_traction * law.residual_friction));
  const double drop = peak - residual;
  const double excess = std::abs(trial) - (peak - c.shear_damage * drop);
  if (excess <= 0.0) return;
  if (c.shear_damage < 1.0 && drop > 0.0) {
    const double slip_to_residual = 2.0 * p.mode_2_energy / drop;
    const double slip = excess / (k - drop / slip_to_residual);
    c.shear_damage = std::min(1.0, c.shear_damage + slip / slip_to_residual);
  }
  c.shear_traction = std::copysign(peak - c.shear_damage * drop, trial);
}

}  // namespace

void Body::update_contacts() {
  for (ContactPoint& c : contacts_) {
    Gridpoint& a = gridpoints_[c.a];
    Gridpoint& b = gridpoints_[c.b];
    const double jump[2] = {b.displacement[0] - a.displacement[0], b.displacement[1] - a.displacement[1]};
    const double opening = jump[0] * c.normal[0] + jump[1] * c.normal[1];
    update_normal(laws_[c.law], opening, c);
    update_shear(laws_[c.law], opening, jump[0] * c.tangent[0] + jump[1] * c.tangent[1], c);
    for (int i = 0; i < 2; ++i) {
      const double force = c.area * (c.normal_traction * c.normal[i] + c.shear_traction * c.tangent[i]);
      a.force[i] += force;
      b.force[i] -= force;
    }
  }
}

namespace {

double sign(double x) {
  if (x > 0.0) return 1.0;
  return x < 0.0 ? -1.0 : 0.0;
}

}  // namespace

/// Eqs. (3), (6)-(8).
void Body::move() {
  const double dt = time_step_;
  const double viscous = 0.5 * parameters_.viscous_damping * dt;
  const bool combined = parameters_.damping_form == pyroclast::DampingForm::combined;
  for (Gridpoint& g : gridpoints_)
    for (int i = 0; i < 2; ++i) {
      if (g.prescribed[i]) {
        g.velocity[i] = g.prescribed_velocity[i];
      } else {
        double against = sign(g.velocity[i]);
        if (combined) against = 0.5 * (against - sign(g.force[i] - g.previous_force[i]));
        const double force = g.force[i] - parameters_.local_damping * std::abs(g.force[i]) * against;
        g.velocity[i] = ((1.0 - viscous) * g.velocity[i] + force / g.mass * dt) / (1.0 + viscous);
      }
      g.previous_force[i] = g.force[i];
      g.displacement[i] += g.velocity[i] * dt;
    }
}

}  // namespace textbook
