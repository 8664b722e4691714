#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "pyroclast/material/contact_law.hpp"
#include "pyroclast/material/zone_law.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Which mass moves.
enum class MassChoice : std::uint8_t {
  real,   ///< density times volume; the stiffest and lightest gridpoint sets the time step
  scaled  ///< density scaling: each gridpoint's mass makes its own limit the common step; quasi-static runs
          ///< only
};

/// Form of the local damping. The force opposing motion is lambda |F| times a sign.
enum class DampingForm : std::uint8_t {
  local,  ///< sgn(v), Eq. (8). A body in steady motion keeps vibrating, since v does not change sign, and is
          ///< dragged.
  combined  ///< (sgn(v) - sgn(dF/dt)) / 2: damps vibration about a steady motion too (Itasca's combined
            ///< damping)
};

template <int Dim>
struct MechanicsParameters {
  Vec<Dim> gravity{};          ///< m/s²
  double local_damping = 0.0;  ///< lambda of Eq. (8), in [0, 1)
  DampingForm damping_form = DampingForm::local;
  double viscous_damping = 0.0;  ///< xi of Eq. (3), 1/s
  Kinematics kinematics = Kinematics::small;
  MassChoice mass = MassChoice::real;
  double time_step = 0.0;  ///< s; the common step of MassChoice::scaled, not used with real mass
  double safety = 0.0;     ///< fraction of the stable step that is taken, in (0, 1]
};

/// Where the energy of a body went since the start, J. Work in = everything else; the rest is the ledger's
/// error.
struct EnergyLedger {
  // put in
  double loading = 0.0;  ///< work of prescribed motion and applied forces
  double gravity = 0.0;
  double heat = 0.0;  ///< change of stored and dissipated energy when properties or thermal strains change
  double mass_scaling = 0.0;  ///< change of kinetic energy when scaled masses follow the stiffness
  // held
  double zones = 0.0;     ///< elastic, in zones
  double contacts = 0.0;  ///< elastic, in contacts
  double kinetic = 0.0;
  // lost
  ContactDissipation dissipated;
  double local_damping = 0.0;
  double viscous_damping = 0.0;

  double work_in() const { return loading + gravity + heat + mass_scaling; }
  double accounted() const {
    return zones + contacts + kinetic + dissipated.total() + local_damping + viscous_damping;
  }
  double error() const { return work_in() - accounted(); }
  /// What the error is measured by: all that was put in or taken out, each by its size. Heat takes stored
  /// energy out where a body softens, so that work_in alone may be near zero.
  double turnover() const {
    return std::abs(loading) + std::abs(gravity) + std::abs(heat) + std::abs(mass_scaling);
  }
};

/// State of one contact point.
template <int Dim>
struct ContactState {
  ContactHistory<Dim> history;
  double opening = 0.0;               ///< u_n, m
  Tangential<Dim> tangential_jump{};  ///< u_s, m
  double normal_traction = 0.0;       ///< Pa, tension positive
  Tangential<Dim> shear_traction{};   ///< Pa
  double stored = 0.0;                ///< J/m²
  ContactDissipation dissipated;      ///< since the start, J/m²
};

/// Directions of a contact.
template <int Dim>
struct ContactFrame {
  Vec<Dim> normal;                         ///< unit, from a to b
  std::array<Vec<Dim>, Dim - 1> tangents;  ///< unit
  double length = 0.0;                     ///< of the edge that turns the frame, m; finite kinematics only
};

/// The stable step and the gridpoint that sets it.
struct TimeStepLimit {
  double step = 0.0;  ///< s
  int gridpoint = 0;
};

/// Parameters of a body at its present temperatures.
struct BodyProperties {
  std::vector<ZoneProperties> zones;        ///< of each zone
  std::vector<ContactProperties> contacts;  ///< each set that occurs, validated
  std::vector<int> of_contact;              ///< index into `contacts` of each contact
};

/// Contacts that differ by interface alone.
/// \param interfaces  contact properties of each interface, validated
template <int Dim>
BodyProperties by_interface(const Model<Dim>& model, std::vector<ZoneProperties> zones,
                            std::vector<ContactProperties> interfaces);

/// Explicit motion of a body of deformable blocks, paper Eqs. (3)-(15), small displacements.
///
/// Forces are gathered by the gridpoint that they act on and every sum has one order, so results are bitwise
/// the same for any number of threads.
template <int Dim>
class Mechanics {
 public:
  /// \param model        kept by reference; must outlive this
  /// \param densities    of each material, kg/m³
  Mechanics(const Model<Dim>& model, const std::vector<double>& densities, BodyProperties properties,
            const MechanicsParameters<Dim>& parameters);

  /// Takes the body to other temperatures: displacements, jumps and damage stay, stresses follow the new
  /// parameters and come back to the new envelopes (staggered coupling, paper Fig. 2). The energy that this
  /// adds or takes is `EnergyLedger::heat`. Scaled masses follow the stiffness.
  /// Throws Error when the body would get too stiff for the time step of its real mass.
  void set_properties(BodyProperties properties);

  /// Prescribes one component of a gridpoint's velocity, m/s, from the next step on.
  void prescribe_velocity(int gridpoint, int component, double velocity);
  /// Lets it move freely again.
  void release(int gridpoint, int component);
  /// Makes free gridpoints of one block share one component of their motion, as under a rigid plate; the
  /// velocity they start with is their mean, so tie them at rest.
  void tie(std::vector<int> gridpoints, int component);
  /// Ends all ties.
  void untie() { ties_.clear(); }
  /// Force on a gridpoint, N, until set again; free components only.
  void apply_force(int gridpoint, const Vec<Dim>& force);
  /// Starts a contact as broken: neither tension nor cohesion ever held it.
  void break_contact(int contact);

  /// Runs a number of steps.
  void advance(int steps);

  double time() const { return static_cast<double>(steps_) * time_step_; }
  std::int64_t steps() const { return steps_; }
  double time_step() const { return time_step_; }
  /// Stable step with real mass, paper Eq. (9).
  TimeStepLimit real_mass_limit() const;
  double mass_ratio() const { return moving_mass_ / real_mass_; }  ///< total moving mass over real mass

  const Model<Dim>& model() const { return model_; }
  const std::vector<Vec<Dim>>& displacement() const { return displacement_; }
  const std::vector<Vec<Dim>>& velocity() const { return velocity_; }
  /// Sum of all forces on each gridpoint at the last step, N; on a prescribed component minus the reaction.
  const std::vector<Vec<Dim>>& force() const { return force_; }
  const std::vector<Vec<Dim>>& applied_force() const { return applied_; }  ///< N
  const std::vector<SymmetricTensor<Dim>>& stress() const { return stress_; }
  const std::vector<ContactState<Dim>>& contacts() const { return contact_state_; }

  /// Energies at the displacements that the last step started from. With kinetic energy as half m v(t - dt/2)
  /// v(t + dt/2), central differences conserve their sum exactly in a linear body, so the ledger's error is
  /// that of the contacts.
  EnergyLedger energy() const;
  /// Mean unbalanced force over mean force applied to the gridpoints by zones, contacts and gravity.
  double unbalanced_ratio() const;
  /// Largest jump over the length of the face it stands on. Small-displacement contacts are exact while it is
  /// small.
  double largest_relative_jump() const;

 private:
  /// Work done on a block, J. The force of a step does half its work on the way to the step's displacement
  /// and half on the way from it; `begun` is the second half of the last step, which belongs to the next.
  struct BlockWork {
    double loading = 0.0, gravity = 0.0, local_damping = 0.0, viscous_damping = 0.0;

    void add(const BlockWork& o) {
      loading += o.loading;
      gravity += o.gravity;
      local_damping += o.local_damping;
      viscous_damping += o.viscous_damping;
    }
  };

  /// Gridpoints that share one component of their motion.
  struct Tie {
    int block;
    int component;
    std::vector<int> gridpoints;
    double mass;
  };

  void compute_stiffness();
  void set_masses(const std::vector<double>& densities);
  void scale_masses();
  void set_step_over_mass();
  void evaluate_forces();
  void update_face(int face);
  Vec<Dim> update_contact_point(int contact, const ContactFrame<Dim>& frame);
  ContactFrame<Dim> current_frame(int first_contact) const;
  void add_turning_force(int first_contact, const ContactFrame<Dim>& frame);
  void add_zone_forces(int block);
  Vec<Dim> contact_forces(int gridpoint) const;
  void complete_forces(int block);
  void move_gridpoints(int block);

  const Model<Dim>& model_;
  MechanicsParameters<Dim> parameters_;
  ZoneGeometry<Dim> geometry_;
  GridpointContacts gridpoint_contacts_;
  BodyProperties properties_;

  std::vector<double> gravity_mass_;    ///< real mass, which gravity acts on, kg
  std::vector<double> mass_;            ///< mass that moves, kg
  std::vector<double> step_over_mass_;  ///< s/kg
  std::vector<double> stiffness_;       ///< k_gp, N/m
  double real_mass_ = 0.0, moving_mass_ = 0.0, time_step_ = 0.0;

  std::int64_t steps_ = 0;
  std::vector<Vec<Dim>> displacement_, velocity_, force_, applied_;
  std::vector<Vec<Dim>> previous_force_;  ///< DampingForm::combined only
  std::vector<Vec<Dim>> prescribed_velocity_;
  std::vector<std::uint8_t> prescribed_;  ///< bit per component
  std::vector<SymmetricTensor<Dim>> stress_;
  std::vector<ContactState<Dim>> contact_state_;
  /// On the gridpoint of each side, N; numbered like GridpointContacts::contact_side.
  std::vector<Vec<Dim>> contact_force_;
  // per block, so that sums have one order
  std::vector<BlockWork> work_, begun_;
  std::vector<double> kinetic_;
  std::vector<Tie> ties_;
  double heat_ = 0.0, mass_scaling_ = 0.0;  ///< see EnergyLedger
  /// What a change of properties adds to them through the half step already begun; the next step books it.
  double begun_heat_ = 0.0, begun_mass_scaling_ = 0.0;
};

extern template BodyProperties by_interface<2>(const Model<2>&, std::vector<ZoneProperties>,
                                               std::vector<ContactProperties>);
extern template BodyProperties by_interface<3>(const Model<3>&, std::vector<ZoneProperties>,
                                               std::vector<ContactProperties>);
extern template class Mechanics<2>;
extern template class Mechanics<3>;

}  // namespace pyroclast
