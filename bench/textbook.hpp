#pragma once

#include <vector>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// The step of Mechanics as one writes it straight from the paper's equations: arrays of structures, one
/// thread, forces added to the gridpoints where they arise, incremental shear.
///
/// The bench compares speed with it, the tests compare results. So nothing here calls the laws of
/// `pyroclast`; only what goes in is shared. Small kinematics, constant properties, no ties, no energies.
namespace textbook {

template <int Dim>
struct Gridpoint {
  double displacement[Dim]{};    ///< m
  double velocity[Dim]{};        ///< m/s
  double force[Dim]{};           ///< N, sum at the last step
  double previous_force[Dim]{};  ///< N, one step before
  double load[Dim]{};            ///< weight and applied force, N
  double prescribed_velocity[Dim]{};
  bool prescribed[Dim]{};
  double mass = 0.0;  ///< kg
};

/// Numbers of a symmetric tensor: the diagonal, then xy, yz, zx.
template <int Dim>
inline constexpr int kTensor = Dim*(Dim + 1) / 2;

/// Zone of constant strain: a triangle in plane stress, or a tetrahedron.
template <int Dim>
struct Zone {
  int gridpoint[Dim + 1];
  double gradient[Dim + 1][Dim];  ///< derivatives of the shape functions, 1/m
  double volume;                  ///< m³
  double d11, d12;                ///< of sigma_xx = d11 e_xx + d12 (e_yy + e_zz), Pa
  double shear_modulus;
  double thermal_strain;
  double stress[kTensor<Dim>];  ///< Pa
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

template <int Dim>
struct ContactPoint {
  int a, b;
  double normal[Dim], tangent[Dim - 1][Dim];
  double area;  ///< m²
  int law;
  double tension_damage = 0.0, shear_damage = 0.0;
  double closure = 0.0;               ///< left behind by compression, m
  double tangential_jump[Dim - 1]{};  ///< of the last step, m
  double normal_traction = 0.0;       ///< Pa, tension positive
  double shear_traction[Dim - 1]{};   ///< Pa
};

template <int Dim>
class Body {
 public:
  /// As Mechanics<Dim>; masses and time step follow from the same rules. Throws pyroclast::Error for finite
  /// kinematics.
  Body(const pyroclast::ModelOf<Dim>& model, const std::vector<double>& densities,
       const pyroclast::BodyProperties& properties, const pyroclast::MechanicsParameters& parameters);

  /// Returns itself, so that both codes are held and driven by the same lines.
  Body& constraints() { return *this; }
  void prescribe_velocity(int gridpoint, int component, double velocity);
  void release(int gridpoint, int component);
  /// Starts a contact as broken.
  void break_contact(int contact);
  void advance(int steps);

  double time_step() const { return time_step_; }
  const std::vector<Gridpoint<Dim>>& gridpoints() const { return gridpoints_; }
  const std::vector<Zone<Dim>>& zones() const { return zones_; }
  const std::vector<ContactPoint<Dim>>& contacts() const { return contacts_; }

 private:
  void make_zones(const pyroclast::ModelOf<Dim>& model, const pyroclast::BodyProperties& properties);
  void make_contacts(const pyroclast::ModelOf<Dim>& model, const pyroclast::BodyProperties& properties);
  void set_masses(const pyroclast::ModelOf<Dim>& model, const std::vector<double>& densities);
  std::vector<double> stiffness() const;
  void strain_zones();
  void update_contacts();
  void move();

  pyroclast::MechanicsParameters parameters_;
  double time_step_ = 0.0;
  std::vector<Gridpoint<Dim>> gridpoints_;
  std::vector<Zone<Dim>> zones_;
  std::vector<Law> laws_;
  std::vector<ContactPoint<Dim>> contacts_;
};

extern template class Body<2>;
extern template class Body<3>;

}  // namespace textbook
