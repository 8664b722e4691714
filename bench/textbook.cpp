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

template <int Dim>
Body<Dim>::Body(const pyroclast::ModelOf<Dim>& model, const std::vector<double>& densities,
                const pyroclast::BodyProperties& properties, const pyroclast::MechanicsParameters& parameters)
    : parameters_(parameters), gridpoints_(model.position.size()) {
  if (parameters.kinematics != pyroclast::Kinematics::small)
    throw pyroclast::Error("the textbook step knows small kinematics only");
  make_zones(model, properties);
  make_contacts(model, properties);
  set_masses(model, densities);
}

namespace {

/// Inverse of a matrix by cofactors.
/// \return its determinant
double invert(const double (&m)[2][2], double (&inverse)[2][2]) {
  const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  inverse[0][0] = m[1][1] / determinant;
  inverse[0][1] = -m[0][1] / determinant;
  inverse[1][0] = -m[1][0] / determinant;
  inverse[1][1] = m[0][0] / determinant;
  return determinant;
}

double invert(const double (&m)[3][3], double (&inverse)[3][3]) {
  double cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  const double determinant = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse[j][i] = cofactor[i][j] / determinant;
  return determinant;
}

/// The two directions of each shear component.
constexpr int kShear[3][2] = {{0, 1}, {1, 2}, {2, 0}};

/// Row of the strain-displacement matrix B, with engineering shear: derivative of a strain by a displacement.
template <int Dim>
double strain_by(const Zone<Dim>& z, int strain, int corner, int direction) {
  const double* const g = z.gradient[corner];
  if (strain < Dim) return strain == direction ? g[direction] : 0.0;
  const auto [i, j] = kShear[strain - Dim];
  return direction == i ? g[j] : direction == j ? g[i] : 0.0;
}

}  // namespace

/// The shape functions are 1 at one corner and 0 at the others, so their derivatives come from the inverse of
/// the edges from the first corner.
template <int Dim>
void Body<Dim>::make_zones(const pyroclast::ModelOf<Dim>& model,
                           const pyroclast::BodyProperties& properties) {
  for (std::size_t i = 0; i < model.zones.size(); ++i) {
    Zone<Dim> z{};
    for (int n = 0; n <= Dim; ++n) z.gridpoint[n] = model.zones[i][n];
    double edge[Dim][Dim], inverse[Dim][Dim];
    for (int n = 0; n < Dim; ++n)
      for (int k = 0; k < Dim; ++k)
        edge[n][k] = model.position[z.gridpoint[n + 1]][k] - model.position[z.gridpoint[0]][k];
    const double determinant = invert(edge, inverse);
    for (int n = 0; n < Dim; ++n)
      for (int k = 0; k < Dim; ++k) {
        z.gradient[n + 1][k] = inverse[k][n];
        z.gradient[0][k] -= inverse[k][n];
      }
    z.volume = determinant / (Dim == 2 ? 2.0 : 6.0) * model.thickness;
    const auto& p = properties.zones[i];
    z.d11 = p.lambda + 2.0 * p.mu;
    z.d12 = p.lambda;
    z.shear_modulus = p.mu;
    z.thermal_strain = p.thermal_strain;
    zones_.push_back(z);
  }
}

template <int Dim>
void Body<Dim>::make_contacts(const pyroclast::ModelOf<Dim>& model,
                              const pyroclast::BodyProperties& properties) {
  for (int set = 0; set < properties.contacts.size(); ++set) laws_.emplace_back(properties.contacts[set]);
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    const auto& c = model.contacts[i];
    ContactPoint<Dim> point{};
    point.a = c.a;
    point.b = c.b;
    for (int k = 0; k < Dim; ++k) {
      point.normal[k] = c.normal[k];
      for (int t = 0; t + 1 < Dim; ++t) point.tangent[t][k] = c.tangents[t][k];
    }
    point.area = c.area;
    point.law = properties.of_contact[i];
    contacts_.push_back(point);
  }
}

/// Largest sum of |K_ij| over the rows of each gridpoint, N/m.
template <int Dim>
std::vector<double> Body<Dim>::stiffness() const {
  constexpr int kColumns = Dim * (Dim + 1);
  std::vector<double> row(Dim * gridpoints_.size());
  for (const Zone<Dim>& z : zones_) {
    const auto strain = [&](int s, int column) { return strain_by(z, s, column / Dim, column % Dim); };
    for (int i = 0; i < kColumns; ++i)
      for (int j = 0; j < kColumns; ++j) {
        double k = 0.0;
        for (int s = 0; s < Dim; ++s)
          for (int t = 0; t < Dim; ++t) k += strain(s, i) * (s == t ? z.d11 : z.d12) * strain(t, j);
        for (int s = Dim; s < kTensor<Dim>; ++s) k += strain(s, i) * z.shear_modulus * strain(s, j);
        row[Dim * z.gridpoint[i / Dim] + i % Dim] += std::abs(k) * z.volume;
      }
  }
  for (const ContactPoint<Dim>& c : contacts_) {
    const auto& p = laws_[c.law].p;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        double k = p.normal_stiffness * c.normal[i] * c.normal[j];
        for (const auto& tangent : c.tangent) k += p.shear_stiffness * tangent[i] * tangent[j];
        // the gridpoint's own displacement and the other's
        row[Dim * c.a + i] += 2.0 * std::abs(k) * c.area;
        row[Dim * c.b + i] += 2.0 * std::abs(k) * c.area;
      }
  }
  std::vector<double> largest(gridpoints_.size());
  for (std::size_t g = 0; g < largest.size(); ++g)
    largest[g] = *std::max_element(&row[Dim * g], &row[Dim * g] + Dim);
  return largest;
}

template <int Dim>
void Body<Dim>::set_masses(const pyroclast::ModelOf<Dim>& model, const std::vector<double>& densities) {
  std::vector<double> real_mass(gridpoints_.size());
  for (int b = 0; b < model.block_count(); ++b)
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
      for (int g : zones_[z].gridpoint)
        real_mass[g] += densities[model.block_material[b]] * zones_[z].volume / (Dim + 1);

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
    for (int i = 0; i < Dim; ++i) gridpoints_[g].load[i] = parameters_.gravity[i] * real_mass[g];
}

template <int Dim>
void Body<Dim>::prescribe_velocity(int gridpoint, int component, double velocity) {
  gridpoints_[gridpoint].prescribed[component] = true;
  gridpoints_[gridpoint].prescribed_velocity[component] = velocity;
}

template <int Dim>
void Body<Dim>::release(int gridpoint, int component) {
  gridpoints_[gridpoint].prescribed[component] = false;
}

template <int Dim>
void Body<Dim>::break_contact(int contact) {
  contacts_[contact].tension_damage = 1.0;
  contacts_[contact].shear_damage = 1.0;
}

template <int Dim>
void Body<Dim>::advance(int steps) {
  for (int i = 0; i < steps; ++i) {
    for (Gridpoint<Dim>& g : gridpoints_)
      for (int k = 0; k < Dim; ++k) g.force[k] = g.load[k];
    strain_zones();
    update_contacts();
    move();
  }
}

/// Eqs. (4), (5): strains to stresses to forces.
template <int Dim>
void Body<Dim>::strain_zones() {
  for (Zone<Dim>& z : zones_) {
    double strain[kTensor<Dim>]{};
    for (int i = 0; i < Dim; ++i) strain[i] = -z.thermal_strain;
    for (int n = 0; n <= Dim; ++n) {
      const double* const u = gridpoints_[z.gridpoint[n]].displacement;
      const double* const g = z.gradient[n];
      for (int i = 0; i < Dim; ++i) strain[i] += g[i] * u[i];
      for (int k = Dim; k < kTensor<Dim>; ++k) {
        const int i = kShear[k - Dim][0], j = kShear[k - Dim][1];
        strain[k] += g[j] * u[i] + g[i] * u[j];
      }
    }
    for (int i = 0; i < Dim; ++i) {
      z.stress[i] = z.d11 * strain[i];
      for (int j = 0; j < Dim; ++j)
        if (j != i) z.stress[i] += z.d12 * strain[j];
    }
    for (int k = Dim; k < kTensor<Dim>; ++k) z.stress[k] = z.shear_modulus * strain[k];
    for (int n = 0; n <= Dim; ++n) {
      double* const f = gridpoints_[z.gridpoint[n]].force;
      const double* const g = z.gradient[n];
      double traction[Dim];
      for (int i = 0; i < Dim; ++i) traction[i] = z.stress[i] * g[i];
      for (int k = Dim; k < kTensor<Dim>; ++k) {
        const int i = kShear[k - Dim][0], j = kShear[k - Dim][1];
        traction[i] += z.stress[k] * g[j];
        traction[j] += z.stress[k] * g[i];
      }
      for (int i = 0; i < Dim; ++i) f[i] -= z.volume * traction[i];
    }
  }
}

namespace {

/// Eqs. (10), (11), (15): opening to normal traction.
template <int Dim>
void update_normal(const Law& law, double opening, ContactPoint<Dim>& c) {
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
template <int Dim>
void update_shear(const Law& law, double opening, const double (&tangential_jump)[Dim - 1],
                  ContactPoint<Dim>& c) {
  const auto& p = law.p;
  const double k = p.shear_stiffness;
  auto& traction = c.shear_traction;
  for (int t = 0; t + 1 < Dim; ++t) {
    traction[t] += k * (tangential_jump[t] - c.tangential_jump[t]);
    c.tangential_jump[t] = tangential_jump[t];
  }
  if (!law.fails) return;
  if ((!law.held || c.tension_damage >= 1.0) && opening + c.closure > 0.0) {
    for (double& s : traction) s = 0.0;
    return;
  }
  const double cohesion = p.coupled ? (1.0 - c.tension_damage) * p.cohesion : p.cohesion;
  const double peak = std::max(0.0, cohesion - c.normal_traction * law.friction);
  const double residual = std::min(peak, std::max(0.0, std::min(p.residual_cohesion, cohesion) -
                                                           c.normal_traction * law.residual_friction));
  const double drop = peak - residual;
  double trial;
  if constexpr (Dim == 2)
    trial = std::abs(traction[0]);
  else
    trial = std::sqrt(traction[0] * traction[0] + traction[1] * traction[1]);
  const double excess = trial - (peak - c.shear_damage * drop);
  if (excess <= 0.0) return;
  if (c.shear_damage < 1.0 && drop > 0.0) {
    const double slip_to_residual = 2.0 * p.mode_2_energy / drop;
    const double slip = excess / (k - drop / slip_to_residual);
    c.shear_damage = std::min(1.0, c.shear_damage + slip / slip_to_residual);
  }
  const double strength = peak - c.shear_damage * drop;
  for (double& s : traction) {
    if constexpr (Dim == 2)
      s = std::copysign(strength, s);
    else
      s *= strength / trial;
  }
}

}  // namespace

template <int Dim>
void Body<Dim>::update_contacts() {
  for (ContactPoint<Dim>& c : contacts_) {
    Gridpoint<Dim>& a = gridpoints_[c.a];
    Gridpoint<Dim>& b = gridpoints_[c.b];
    double opening = 0.0, tangential_jump[Dim - 1]{};
    for (int i = 0; i < Dim; ++i) {
      const double jump = b.displacement[i] - a.displacement[i];
      opening += jump * c.normal[i];
      for (int t = 0; t + 1 < Dim; ++t) tangential_jump[t] += jump * c.tangent[t][i];
    }
    update_normal(laws_[c.law], opening, c);
    update_shear<Dim>(laws_[c.law], opening, tangential_jump, c);
    for (int i = 0; i < Dim; ++i) {
      double force = c.normal_traction * c.normal[i];
      for (int t = 0; t + 1 < Dim; ++t) force += c.shear_traction[t] * c.tangent[t][i];
      a.force[i] += c.area * force;
      b.force[i] -= c.area * force;
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
template <int Dim>
void Body<Dim>::move() {
  const double dt = time_step_;
  const double viscous = 0.5 * parameters_.viscous_damping * dt;
  const bool combined = parameters_.damping_form == pyroclast::DampingForm::combined;
  for (Gridpoint<Dim>& g : gridpoints_)
    for (int i = 0; i < Dim; ++i) {
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

template class Body<2>;
template class Body<3>;

}  // namespace textbook
