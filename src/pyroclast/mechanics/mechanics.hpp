#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/base/team.hpp"
#include "pyroclast/laws/contact_properties.hpp"
#include "pyroclast/material/creep.hpp"
#include "pyroclast/mechanics/compiled_step.hpp"
#include "pyroclast/mechanics/energy_ledger.hpp"
#include "pyroclast/mechanics/state.hpp"
#include "pyroclast/mechanics/sweep.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Choice of the mass that moves.
enum class MassChoice : std::uint8_t {
  real,  ///< density times volume; the stiffest and lightest gridpoint sets the time step
  /// Density scaling: the mass of each gridpoint makes its own limit the common step; quasi-static runs only.
  scaled
};

template <int Dim>
struct MechanicsParameters {
  Vec<Dim> gravity{};          ///< m/s²
  double local_damping = 0.0;  ///< lambda of Eq. (8), in [0, 1)
  DampingForm damping_form = DampingForm::local;
  double viscous_damping = 0.0;  ///< xi of Eq. (3), 1/s
  Kinematics kinematics = Kinematics::small;
  MassChoice mass = MassChoice::real;
  double time_step = 0.0;  ///< time step, s: the common step of MassChoice::scaled, not used with real mass
  double safety = 0.0;     ///< fraction of the stable step that is taken, in (0, 1]
  InstructionSet instructions = best_instruction_set();
  // The parameters from here on change speed, not results.
  LayoutParameters layout;
  /// Least zones of a thread; with fewer a thread waits longer at barriers than it saves.
  int zones_for_a_thread = 500;
};

/// State of one contact point at the displacements of the last forces.
template <int Dim>
struct ContactState {
  const LawTable* law = nullptr;
  std::vector<double> internals;      ///< internal variables in the order of `law->internals(Dim)`
  std::vector<double> losses;         ///< losses since the start, in the order of `law->losses`
  double opening = 0.0;               ///< u_n, m
  Tangential<Dim> tangential_jump{};  ///< u_s, m
  double normal_traction = 0.0;       ///< Pa, tension positive
  Tangential<Dim> shear_traction{};   ///< Pa
  double stored = 0.0;                ///< J/m²

  // Returns an internal variable; 0 where the law has none of this meaning or name.
  double remembered(Remembers what) const;
  double remembered(std::string_view name) const;
  double lost(std::string_view name) const;  ///< Returns a loss; 0 where the law has none of this name.
};

/// Directions of a contact.
template <int Dim>
struct ContactFrame {
  Vec<Dim> normal;                         ///< unit normal, from a to b
  std::array<Vec<Dim>, Dim - 1> tangents;  ///< unit tangents
};

/// Stable step and the gridpoint that sets it.
struct TimeStepLimit {
  double step = 0.0;  ///< s
  int gridpoint = 0;
};

/// Parameters of a body at its present temperatures.
struct BodyProperties {
  std::vector<ZoneProperties> zones;  ///< parameters of each zone
  ContactSets contacts;               ///< sets of parameters that occur, each once, validated
  std::vector<int> of_contact;        ///< index into `contacts` of each contact
  /// Creep of each zone, from these temperatures on; empty where none ever creeps.
  std::vector<CreepIncrement> creep;
};

/// Returns the properties of a body whose contacts differ by interface alone.
/// \param interfaces  contact properties of each interface, validated
template <int Dim>
BodyProperties by_interface(const Model<Dim>& model, std::vector<ZoneProperties> zones,
                            const std::vector<ContactProperties>& interfaces);

/// Explicit motion of a body of deformable blocks, paper Eqs. (3)-(15).
///
/// The state stands in lanes (see Layout); this class shows it in the order of the model. Each gridpoint
/// gathers the forces that act on it, and every sum has one order. So results are bitwise the same for any
/// number of threads and any instruction set.
template <int Dim>
class Mechanics {
 public:
  /// \param model        model, kept by reference; must outlive this object
  /// \param densities    density of each material, kg/m³
  /// \param team         threads of the run; without a team the calling thread works alone
  Mechanics(const Model<Dim>& model, const std::vector<double>& densities, BodyProperties properties,
            const MechanicsParameters<Dim>& parameters, std::shared_ptr<Team> team = nullptr);

  /// Takes the body to other temperatures: displacements, jumps and damage stay, stresses follow the new
  /// parameters and return to the new envelopes (staggered coupling, paper Fig. 2).
  /// `EnergyLedger::property_change` counts the energy that this adds or takes. Scaled masses follow the
  /// stiffness. Returns the properties before, whose memory may serve the next ones.
  ///
  /// Where `properties.creep` says so, zones creep from now on until `commit_creep`: half with the stress
  /// that they have now, half with the stress to which they come (see CreepSplit). Until then the second half
  /// makes them softer. Creep that is still under way is committed first.
  ///
  /// Throws Error when the body would get too stiff for the time step of its real mass, or when it begins to
  /// creep and was made of materials that do not creep.
  BodyProperties set_properties(BodyProperties properties);

  /// Ends the creep of the last `set_properties` with the present stress, which stays as it is: strain that
  /// was elastic until now becomes creep strain. The ledger counts its work as "creep" in `dissipated`;
  /// `property_change` closes the ledger. Does nothing where no zone creeps.
  void commit_creep();

  /// Prescribes one component of a gridpoint's velocity, m/s, from the next step on.
  void prescribe_velocity(int gridpoint, int component, double velocity);
  /// Lets one component of a gridpoint move freely again.
  void release(int gridpoint, int component);
  bool is_prescribed(int gridpoint, int component) const;
  /// Ties free gridpoints of one block, which then share one component of their motion, as under a rigid
  /// plate. They start with their mean velocity, so tie them at rest.
  void tie(std::vector<int> gridpoints, int component);
  /// Ends all ties.
  void untie();
  /// Applies a force to a gridpoint, N, until set again; free components only.
  void apply_force(int gridpoint, const Vec<Dim>& force);
  /// Breaks a contact from the start: neither tension nor cohesion ever held it. Returns false where the law
  /// of the contact has no damage; the contact then holds.
  [[nodiscard]] bool break_contact(int contact);

  /// Takes a number of steps.
  void advance(int steps);

  /// Shows the state to a visitor; another state must come from a body of the same model and laws. Where the
  /// visitor replaces the state, everything that lasts from step to step is first filled with NaN, so that a
  /// missing part cannot pass for what was there.
  void visit_state(StateVisitor& visitor);

  double time() const { return static_cast<double>(steps_) * time_step(); }
  std::int64_t steps() const { return steps_; }
  double time_step() const { return state_.time_step; }
  /// Returns the stable step with real mass, paper Eq. (9).
  TimeStepLimit real_mass_limit() const;
  /// Returns the total moving mass over the real mass.
  double mass_ratio() const { return moving_mass_ / real_mass_; }
  InstructionSet instructions() const { return parameters_.instructions; }

  const Model<Dim>& model() const { return model_; }
  const Layout<Dim>& layout() const { return *layout_; }
  const State<Dim>& state() const { return state_; }
  /// Returns the arrays that `state` sees.
  const StateArrays<Dim, FlatArray>& storage() const { return storage_; }
  /// Returns the bytes of all arrays of layout and state.
  std::size_t memory() const { return pyroclast::memory(*layout_) + pyroclast::memory(storage_); }
  /// Uses another compilation of the step from the next step on; for benches. Results keep the same bits as
  /// long as it is one of the templates of step/step.hpp.
  void use(const StepFunctions<Dim>& step);
  /// Returns the laws of the contacts of this body, in the order that `State::law_of_faces` counts.
  const std::vector<const LawTable*>& laws() const { return laws_; }
  Vec<Dim> displacement(int gridpoint) const;  ///< m
  Vec<Dim> velocity(int gridpoint) const;      ///< m/s
  /// Returns the sum of all forces at the last step, N; on a prescribed component minus the reaction.
  Vec<Dim> force(int gridpoint) const;
  Vec<Dim> applied_force(int gridpoint) const;  ///< N
  SymmetricTensor<Dim> stress(int zone) const;  ///< Pa, at the displacements of the last forces
  ContactState<Dim> contact(int contact) const;
  const LawTable& law_of(int contact) const {
    return properties_.contacts.law(properties_.of_contact[contact]);
  }
  /// Returns an internal variable of a contact; 0 where its law has none of this meaning.
  double remembered(int contact, Remembers what) const;
  /// Returns the names that the laws of this body give the energies that they lose.
  const std::vector<std::string_view>& dissipations() const { return dissipations_; }
  double opening(int contact) const;  ///< Returns u_n at the displacements of the last forces, m.
  /// Returns the directions of a contact at the displacements of the last forces.
  ContactFrame<Dim> frame_of_forces(int contact) const;
  /// Returns the properties of a zone; until creep is committed, they include the compliance that it adds.
  ZoneProperties properties_of_zone(int zone) const;
  /// Tells whether zones of this body can creep.
  bool creeps() const { return !creep_strain_.empty(); }
  /// Returns the creep strain of a zone, in the frame of the model, at the displacements of the last forces;
  /// while the zone creeps, the known part of it.
  SymmetricTensor<Dim> creep_strain(int zone) const;
  // The next functions return a value of each gridpoint, zone or contact, in the order of the model.
  std::vector<Vec<Dim>> displacements() const;
  std::vector<Vec<Dim>> velocities() const;
  std::vector<Vec<Dim>> forces() const;
  std::vector<SymmetricTensor<Dim>> stresses() const;
  std::vector<ContactState<Dim>> contacts() const;

  // The next functions sum over sets of gridpoints.
  Vec<Dim> mean_displacement(const GridpointSet& set) const;    ///< m
  Vec<Dim> total_force(const GridpointSet& set) const;          ///< N, sum of `force`
  Vec<Dim> total_applied_force(const GridpointSet& set) const;  ///< N
  Vec<Dim> total_weight(const GridpointSet& set) const;         ///< N, weight of the real mass
  /// Sums the forces on all free components: weight, loads and reactions together, N. The sum is zero when
  /// the body as a whole is in equilibrium.
  Vec<Dim> net_force() const;
  double total_moving_mass(const GridpointSet& set) const;  ///< kg

  /// Returns the energies at the displacements from which the last step started. Kinetic energy is
  /// half m v(t - dt/2) v(t + dt/2). With it, central differences conserve the sum of energies exactly in a
  /// linear body, so the ledger's error comes from the contacts.
  EnergyLedger energy() const;
  /// Returns the mean unbalanced force over the mean force that zones, contacts and gravity apply to the
  /// gridpoints. An applied force below that of a strain of 1e-10 counts as that force: so a body without
  /// load is at rest too.
  double unbalanced_ratio() const;
  double mean_unbalanced_force() const;  ///< Returns the mean over the gridpoints, N.
  Kinematics kinematics() const { return parameters_.kinematics; }
  /// Returns the largest jump over the length of its face. Contacts with small displacements are exact while
  /// this ratio is small.
  double largest_relative_jump() const;

 private:
  static constexpr std::size_t kMostDissipations = 16;
  static constexpr std::size_t kMostLaws = 256;  ///< most laws that State::law_of_faces can tell apart

  /// Share and memory of a thread in a step.
  struct Worker {
    Share share;
    FlatArray<double> scratch;
  };
  /// Creep of a zone between `set_properties` and `commit_creep`.
  struct CreepUnderWay {
    CreepSplit<Dim> split;
    double poisson = 0.0;           ///< nu_L
    SymmetricTensor<Dim> stress{};  ///< stress at the beginning, in the zone's own frame, Pa
  };
  /// Tie before its slots stand one after the other in the state.
  struct TieOfBundle {
    int bundle, component;
    std::vector<int> slots;
  };

  void list_laws();
  void place_model();
  void place_internals();
  void place_properties();
  void place_creep_strain();
  void name_dissipations();
  void place_contact_properties();
  std::vector<int> find_sets_of_faces();
  void place_own_constants();
  void place_ties();
  void refresh_views();
  template <class T>
  FlatArray<T> made(std::size_t size) const {
    return FlatArray<T>(size, team_.get());
  }
  FlatArray<double> make_scratch() const;
  void compute_stiffness();
  void set_least_force();
  void set_masses(const std::vector<double>& densities);
  double scaled_mass(int gridpoint) const;
  void scale_masses();
  void set_moving_mass();
  void set_step_over_mass();
  void forget();
  template <class Change>
  void change_properties(Change change);
  void begin_creep(const std::vector<CreepIncrement>& creep);
  void end_creep();
  SymmetricTensor<Dim> stress_in_own_frame(int zone, Rotation<double>& rotation) const;
  void visit_properties(StateVisitor& visitor);
  void visit_ties(StateVisitor& visitor);
  template <class Array>
  void visit_array(StateVisitor& visitor, const char* name, Array& array);
  void require_constraints(const StateVisitor& visitor) const;
  int constraints_of(int gridpoint);
  void order_constraints();
  void drop_if_free(int bundle);
  ConstraintPack<Dim>& constraint_pack(int constraints, int gridpoint);
  int slot_in_bundle(int gridpoint) const;
  int bundle_of(int gridpoint) const;
  void sweep(int steps, Pass pass);
  const LawTable& law_of_pack(int face_pack) const { return *laws_[storage_.law_of_faces[face_pack]]; }
  Vec<Dim> jump_of_forces(int contact) const;
  Vec<Dim> displacement_of_force(int gridpoint) const;
  Dissipation dissipated() const;

  const Model<Dim>& model_;
  MechanicsParameters<Dim> parameters_;
  std::shared_ptr<Team> team_;
  BodyProperties properties_;  ///< properties without the softening by creep that is under way
  /// Creep strain of each zone, in its own frame; see State.
  std::vector<SymmetricTensor<Dim>> creep_strain_;
  /// Creep of each zone; empty where none creeps at present.
  std::vector<CreepUnderWay> creep_under_way_;
  double creep_work_ = 0.0;  ///< work of creep, J
  ZoneGeometry<Dim> geometry_;
  std::unique_ptr<const Layout<Dim>> layout_;
  StateArrays<Dim, FlatArray> storage_;
  State<Dim> state_;  ///< view of layout and storage
  StepFunctions<Dim> step_;
  std::vector<const LawTable*> laws_;
  std::vector<PackFunctions<Dim>> law_functions_;  ///< functions of each law, from step_; the state sees them
  std::vector<Worker> workers_;                    ///< workers by thread
  std::vector<std::string_view> dissipations_;

  /// Constraints of each bundle that was ever held, driven or loaded; else -1.
  std::vector<int> made_constraints_;
  bool constraints_are_in_order_ = true;
  std::vector<TieOfBundle> ties_;

  std::vector<double> gravity_mass_;  ///< real mass, on which gravity acts, kg
  std::vector<double> mass_;          ///< mass that moves, kg
  std::vector<double> stiffness_;     ///< k_gp, N/m
  double mean_height_ = 0.0;          ///< mean height of zones, m
  /// Sum over all gridpoints, N; a smaller sum of forces counts as no force.
  double least_force_ = 0.0;
  double real_mass_ = 0.0, moving_mass_ = 0.0;

  std::int64_t steps_ = 0;
  double property_change_ = 0.0, mass_scaling_ = 0.0;  ///< entries of EnergyLedger, J
  /// Parts that a change of properties adds to both entries through the half step already begun; the next
  /// step books them.
  double begun_property_change_ = 0.0, begun_mass_scaling_ = 0.0;
};

extern template BodyProperties by_interface<2>(const Model<2>&, std::vector<ZoneProperties>,
                                               const std::vector<ContactProperties>&);
extern template BodyProperties by_interface<3>(const Model<3>&, std::vector<ZoneProperties>,
                                               const std::vector<ContactProperties>&);
extern template struct ContactState<2>;
extern template struct ContactState<3>;
extern template class Mechanics<2>;
extern template class Mechanics<3>;

}  // namespace pyroclast
