#pragma once

#include <vector>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// The step of Mechanics<2> as one writes it straight from the paper's equations: arrays of structures, one
/// thread, forces added to the gridpoints where they arise, incremental shear.
///
/// The bench compares speed with it, the tests compare results. So nothing here calls the laws of
/// `pyroclast`; only what goes in is shared. Small kinematics, constant properties, no ties, no energies.
namespace textbook {

struct Gridpoint {
  double displacement[2]{};    ///< m
  double velocity[2]{};        ///< m/s
  double force[2]{};           ///< N, sum at the last step
  double previous_force[2]{};  ///< N, one step before
  double load[2]{};            ///< weight and applied force, N
  double prescribed_velocity[2]{};
  bool prescribed[2]{};
  double mass = 0.0;  ///< kg
};

/// Constant strain triangle in plane stress.
struct Zone {
  int gridpoint[3];
  double dx[3], dy[3];  ///< derivatives of the shape functions, 1/m
  double volume;        ///< m³
  double d11, d12;      ///< of sigma_xx = d11 e_xx + d12 e_yy, Pa
  double shear_modulus;
  double thermal_strain;
  double stress[3];  ///< xx, yy, xy, Pa
};

/// Contact law, Eqs. (10)-(15), with what follows from its parameters.
struct Law {
  explicit Law(const pyroclast::ContactProperties& properties);

  pyroclast::Cohesive::Properties<double> p;
  bool fails = true;  ///< else elastic in every direction
  bool held = true;   ///< else neither tension nor cohesion ever held it
  double friction, residual_friction;
  double elastic_opening;   ///< u_e = f_t / K_n
  double ultimate_opening;  ///< u_f = 2 G_f1 / f_t
  double yield_slope;       ///< of the compressive limit over the closure, beta K_n / (1 - beta)
};

struct ContactPoint {
  int a, b;
  double normal[2], tangent[2];
  double area;  ///< m²
  int law;
  double tension_damage = 0.0, shear_damage = 0.0;
  double closure = 0.0;          ///< left behind by compression, m
  double tangential_jump = 0.0;  ///< of the last step, m
  double normal_traction = 0.0;  ///< Pa, tension positive
  double shear_traction = 0.0;   ///< Pa
};

class Body {
 public:
  /// As Mechanics<2>; masses and time step follow from the same rules. Throws pyroclast::Error for finite
  /// kinematics.
  Body(const pyroclast::ModelOf<2>& model, const std::vector<double>& densities,
       const pyroclast::BodyProperties& properties, const pyroclast::MechanicsParameters& parameters);

  /// Returns itself, so that both codes are held and driven by the same lines.
  Body& constraints() { return *this; }
  void prescribe_velocity(int gridpoint, int component, double velocity);
  void release(int gridpoint, int component);
  /// Starts a contact as broken.
  void break_contact(int contact);
  void advance(int steps);

  double time_step() const { return time_step_; }
  const std::vector<Gridpoint>& gridpoints() const { return gridpoints_; }
  const std::vector<Zone>& zones() const { return zones_; }
  const std::vector<ContactPoint>& contacts() const { return contacts_; }

 private:
  void make_zones(const pyroclast::ModelOf<2>& model, const pyroclast::BodyProperties& properties);
  void make_contacts(const pyroclast::ModelOf<2>& model, const pyroclast::BodyProperties& properties);
  void set_masses(const pyroclast::ModelOf<2>& model, const std::vector<double>& densities);
  std::vector<double> stiffness() const;
  void strain_zones();
  void update_contacts();
  void move();

  pyroclast::MechanicsParameters parameters_;
  double time_step_ = 0.0;
  std::vector<Gridpoint> gridpoints_;
  std::vector<Zone> zones_;
  std::vector<Law> laws_;
  std::vector<ContactPoint> contacts_;
};

}  // namespace textbook
