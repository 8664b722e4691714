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

/// Which mass moves.
enum class MassChoice : std::uint8_t {
  real,   ///< density times volume; the stiffest and lightest gridpoint sets the time step
  scaled  ///< density scaling: each gridpoint's mass makes its own limit the common step; quasi-static runs
          ///< only
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
  InstructionSet instructions = best_instruction_set();
  // these change speed, not results
  LayoutParameters layout;
  int zones_for_a_thread = 500;  ///< with fewer a thread waits longer at barriers than it saves
};

/// State of one contact point at the displacements that the last forces belong to.
template <int Dim>
struct ContactState {
  const LawTable* law = nullptr;
  std::vector<double> internals;      ///< in the order of `law->internals(Dim)`
  std::vector<double> losses;         ///< since the start, in the order of `law->losses`
  double opening = 0.0;               ///< u_n, m
  Tangential<Dim> tangential_jump{};  ///< u_s, m
  double normal_traction = 0.0;       ///< Pa, tension positive
  Tangential<Dim> shear_traction{};   ///< Pa
  double stored = 0.0;                ///< J/m²

  // 0 where the law remembers no such thing
  double remembered(Remembers what) const;
  double remembered(std::string_view name) const;
  double lost(std::string_view name) const;  ///< 0 where the law loses no such thing
};

/// Directions of a contact.
template <int Dim>
struct ContactFrame {
  Vec<Dim> normal;                         ///< unit, from a to b
  std::array<Vec<Dim>, Dim - 1> tangents;  ///< unit
};

/// The stable step and the gridpoint that sets it.
struct TimeStepLimit {
  double step = 0.0;  ///< s
  int gridpoint = 0;
};

/// Parameters of a body at its present temperatures.
struct BodyProperties {
  std::vector<ZoneProperties> zones;  ///< of each zone
  ContactSets contacts;               ///< each set that occurs, validated
  std::vector<int> of_contact;        ///< index into `contacts` of each contact
  /// Of each zone, from these temperatures on; empty where none ever creeps.
  std::vector<CreepIncrement> creep;
};

/// Contacts that differ by interface alone.
/// \param interfaces  contact properties of each interface, validated
template <int Dim>
BodyProperties by_interface(const Model<Dim>& model, std::vector<ZoneProperties> zones,
                            const std::vector<ContactProperties>& interfaces);

/// Gridpoints over which something is summed, in the order of chunks.
struct GridpointSet {
  std::vector<int> gridpoints;
  std::vector<int> chunks;  ///< where those of each chunk begin
};

/// Explicit motion of a body of deformable blocks, paper Eqs. (3)-(15).
///
/// The state stands in lanes (see Layout); here is its view in the order of the model. Forces are gathered by
/// the gridpoint that they act on and every sum has one order, so results are bitwise the same for any number
/// of threads and any instruction set.
template <int Dim>
class Mechanics {
 public:
  /// \param model        kept by reference; must outlive this
  /// \param densities    of each material, kg/m³
  /// \param team         the threads of the run; one alone where there is none
  Mechanics(const Model<Dim>& model, const std::vector<double>& densities, BodyProperties properties,
            const MechanicsParameters<Dim>& parameters, std::shared_ptr<Team> team = nullptr);

  /// Takes the body to other temperatures: displacements, jumps and damage stay, stresses follow the new
  /// parameters and come back to the new envelopes (staggered coupling, paper Fig. 2). The energy that this
  /// adds or takes is `EnergyLedger::property_change`. Scaled masses follow the stiffness.
  ///
  /// Where `properties.creep` says so, zones creep from now on until `commit_creep`: by half with the stress
  /// that they have now, by half with the one to which they come (see CreepSplit). Until then they are softer
  /// by the second half. What was still creeping is committed before.
  ///
  /// Throws Error when the body would get too stiff for the time step of its real mass, or begins to creep
  /// and was made of what does not.
  void set_properties(BodyProperties properties);

  /// Ends the creep of the last `set_properties` with the stress of now, which stays as it is: the strain
  /// that was elastic until now is one that has crept. Its work is `dissipated` as "creep"; what closes the
  /// ledger is `property_change`. Nothing to do where nothing creeps.
  void commit_creep();

  /// Prescribes one component of a gridpoint's velocity, m/s, from the next step on.
  void prescribe_velocity(int gridpoint, int component, double velocity);
  /// Lets it move freely again.
  void release(int gridpoint, int component);
  bool is_prescribed(int gridpoint, int component) const;
  /// Makes free gridpoints of one block share one component of their motion, as under a rigid plate; the
  /// velocity they start with is their mean, so tie them at rest.
  void tie(std::vector<int> gridpoints, int component);
  /// Ends all ties.
  void untie();
  /// Force on a gridpoint, N, until set again; free components only.
  void apply_force(int gridpoint, const Vec<Dim>& force);
  /// Starts a contact as broken: neither tension nor cohesion ever held it. False where its law knows no
  /// damage, so that it holds.
  [[nodiscard]] bool break_contact(int contact);

  /// Runs a number of steps.
  void advance(int steps);

  /// Of a body of the same model and laws. Where the visitor replaces the state, all that lasts from step to
  /// step is filled with NaN first: what is missing does not pass for what was there.
  void visit_state(StateVisitor& visitor);

  double time() const { return static_cast<double>(steps_) * time_step(); }
  std::int64_t steps() const { return steps_; }
  double time_step() const { return state_.time_step; }
  /// Stable step with real mass, paper Eq. (9).
  TimeStepLimit real_mass_limit() const;
  double mass_ratio() const { return moving_mass_ / real_mass_; }  ///< total moving mass over real mass
  InstructionSet instructions() const { return parameters_.instructions; }

  const Model<Dim>& model() const { return model_; }
  const Layout<Dim>& layout() const { return *layout_; }
  const State<Dim>& state() const { return state_; }
  /// What `state` sees.
  const StateArrays<Dim, FlatArray>& storage() const { return storage_; }
  /// Bytes of all arrays of layout and state.
  std::size_t memory() const { return pyroclast::memory(*layout_) + pyroclast::memory(storage_); }
  /// Takes another compilation of the step from the next one on; for benches. Results stay the same bits as
  /// long as it is one of the templates of step/step.hpp.
  void use(const StepFunctions<Dim>& step);
  /// Of the contacts of this body, in the order that `State::law_of_faces` counts.
  const std::vector<const LawTable*>& laws() const { return laws_; }
  Vec<Dim> displacement(int gridpoint) const;  ///< m
  Vec<Dim> velocity(int gridpoint) const;      ///< m/s
  /// Sum of all forces at the last step, N; on a prescribed component minus the reaction.
  Vec<Dim> force(int gridpoint) const;
  Vec<Dim> applied_force(int gridpoint) const;  ///< N
  SymmetricTensor<Dim> stress(int zone) const;  ///< Pa, at the displacements of the last forces
  ContactState<Dim> contact(int contact) const;
  const LawTable& law_of(int contact) const {
    return properties_.contacts.law(properties_.of_contact[contact]);
  }
  /// Of a contact's internal variables; 0 where its law remembers no such thing.
  double remembered(int contact, Remembers what) const;
  /// What the laws of this body call the energies that they lose.
  const std::vector<std::string_view>& dissipations() const { return dissipations_; }
  double opening(int contact) const;  ///< u_n at the displacements of the last forces, m
  /// Directions of a contact at the displacements of the last forces.
  ContactFrame<Dim> frame_of_forces(int contact) const;
  /// With what creep makes it softer by until it is committed.
  ZoneProperties properties_of_zone(int zone) const;
  /// Whether zones of this body can creep.
  bool creeps() const { return !creep_strain_.empty(); }
  /// What a zone has crept, in the frame of the model, at the displacements of the last forces; while it
  /// creeps, the part that is known.
  SymmetricTensor<Dim> creep_strain(int zone) const;
  // of all, in the order of the model
  std::vector<Vec<Dim>> displacements() const;
  std::vector<Vec<Dim>> velocities() const;
  std::vector<Vec<Dim>> forces() const;
  std::vector<SymmetricTensor<Dim>> stresses() const;
  std::vector<ContactState<Dim>> contacts() const;

  // Sums over sets of gridpoints
  GridpointSet set_of(std::vector<int> gridpoints) const;
  Vec<Dim> mean_displacement(const GridpointSet& set) const;    ///< m
  Vec<Dim> total_force(const GridpointSet& set) const;          ///< N, as of `force`
  Vec<Dim> total_applied_force(const GridpointSet& set) const;  ///< N
  Vec<Dim> total_weight(const GridpointSet& set) const;         ///< N, of the real mass
  /// Sum of the forces on all free components: weight, loads and reactions together. Zero when the body as a
  /// whole is in equilibrium, N.
  Vec<Dim> net_force() const;
  double total_moving_mass(const GridpointSet& set) const;  ///< kg

  /// Energies at the displacements that the last step started from. With kinetic energy as half m v(t - dt/2)
  /// v(t + dt/2), central differences conserve their sum exactly in a linear body, so the ledger's error is
  /// that of the contacts.
  EnergyLedger energy() const;
  /// Mean unbalanced force over mean force applied to the gridpoints by zones, contacts and gravity. Forces
  /// below those of a strain of 1e-10 count as these: a body without load rests too.
  double unbalanced_ratio() const;
  double mean_unbalanced_force() const;  ///< of the gridpoints, N
  Kinematics kinematics() const { return parameters_.kinematics; }
  /// Largest jump over the length of the face it stands on. Small-displacement contacts are exact while it is
  /// small.
  double largest_relative_jump() const;

 private:
  static constexpr std::size_t kMostDissipations = 16;
  static constexpr std::size_t kMostLaws = 256;  ///< what State::law_of_faces can tell apart

  /// What a thread needs for a step.
  struct Worker {
    Share share;
    FlatArray<double> scratch;
  };
  /// Of a zone, between `set_properties` and `commit_creep`.
  struct CreepUnderWay {
    CreepSplit<Dim> split;
    double poisson = 0.0;           ///< nu_L
    SymmetricTensor<Dim> stress{};  ///< at the beginning, in the zone's own frame, Pa
  };
  /// A tie before its slots stand one after the other in the state.
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
  BodyProperties properties_;                       ///< of zones that do not creep just now
  std::vector<SymmetricTensor<Dim>> creep_strain_;  ///< of each zone, in its own frame; see State
  std::vector<CreepUnderWay> creep_under_way_;      ///< of each zone; empty where none creeps just now
  double creep_work_ = 0.0;                         ///< J
  ZoneGeometry<Dim> geometry_;
  std::unique_ptr<const Layout<Dim>> layout_;
  StateArrays<Dim, FlatArray> storage_;
  State<Dim> state_;  ///< sees layout and storage
  StepFunctions<Dim> step_;
  std::vector<const LawTable*> laws_;
  std::vector<PackFunctions<Dim>> law_functions_;  ///< of each law, by step_; the state sees them
  std::vector<Worker> workers_;                    ///< by thread
  std::vector<std::string_view> dissipations_;

  std::vector<int> made_constraints_;  ///< of each bundle that was ever held, driven or loaded; else -1
  std::vector<TieOfBundle> ties_;

  std::vector<double> gravity_mass_;  ///< real mass, which gravity acts on, kg
  std::vector<double> mass_;          ///< mass that moves, kg
  std::vector<double> stiffness_;     ///< k_gp, N/m
  double mean_height_ = 0.0;          ///< of zones, m
  double least_force_ = 0.0;          ///< of all gridpoints, N: forces that add up to less are none
  double real_mass_ = 0.0, moving_mass_ = 0.0;

  std::int64_t steps_ = 0;
  double property_change_ = 0.0, mass_scaling_ = 0.0;  ///< see EnergyLedger
  /// What a change of properties adds to them through the half step already begun; the next step books it.
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
