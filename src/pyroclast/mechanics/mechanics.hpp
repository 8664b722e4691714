#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/constraints.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/masses.hpp"
#include "pyroclast/mechanics/mover.hpp"
#include "pyroclast/mechanics/properties.hpp"
#include "pyroclast/mechanics/reader.hpp"
#include "pyroclast/mechanics/totals.hpp"

namespace pyroclast {

/// Explicit motion of a body of deformable blocks, paper Eqs. (3)-(15).
///
/// The state stands in lanes (see Body and Layout). Each gridpoint gathers the forces that act on it, and
/// every sum has one order. So results are bitwise the same for any number of threads and any instruction
/// set.
template <int Dim>
class Mechanics {
 public:
  /// \param model        model, kept by reference; must outlive this object
  /// \param densities    density of each material, kg/m³
  /// \param team         threads of the run; without a team the calling thread works alone
  Mechanics(const ModelOf<Dim>& model, const std::vector<double>& densities, BodyProperties properties,
            const MechanicsParameters& parameters, std::shared_ptr<Team> team = nullptr);

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
  /// \param look  reads the body then. It travels with the sums of the creep, see Ranks::together; so it may
  ///              be called twice.
  void commit_creep(const std::function<void()>& look = [] {});

  /// Takes blocks out of the body for good, with all that acts on them: they have no force, no mass and no
  /// motion any more. `EnergyLedger::removed` counts the energy that they hold, and what they cease to bear.
  /// Velocities, ties and forces that are prescribed must act on none of them. Needs
  /// `MechanicsParameters::loses_blocks`.
  void remove(const std::vector<int>& blocks);

  /// Notes the step for contacts that have cracked since the last call.
  void note_cracks() { pyroclast::note_cracks(*body_); }

  /// Gives the gridpoints their velocities, m/s, before the first step. The ledger counts their energy as
  /// loading.
  void begin_moving(const std::vector<Vec<Dim>>& velocities);
  /// Takes a number of steps.
  void advance(int steps);

  /// Shows the state to a visitor; another state must come from a body of the same model and laws. Where the
  /// visitor replaces the state, everything that lasts from step to step is first filled with NaN, so that a
  /// missing part cannot pass for what was there.
  void visit_state(StateVisitor& visitor);

  /// Uses another compilation of the step from the next step on; for benches. Results keep the same bits as
  /// long as it is one of the templates of step/step.hpp.
  void use(const StepFunctions<Dim>& step) { body_->use(step); }
  /// Breaks a contact from the start, see Properties.
  [[nodiscard]] bool break_contact(int contact) { return Properties<Dim>(*body_).break_contact(contact); }

  Constraints<Dim> constraints() { return Constraints<Dim>(*body_); }
  Reader<Dim> read() const { return Reader<Dim>(*body_); }
  Totals<Dim> totals() const { return Totals<Dim>(*body_); }
  /// Returns the stable step with real mass, paper Eq. (9).
  TimeStepLimit real_mass_limit() const { return Masses<Dim>(*body_).real_mass_limit(); }
  /// Returns the total moving mass over the real mass.
  double mass_ratio() const { return body_->moving_mass / body_->real_mass; }
  const Body<Dim>& body() const { return *body_; }

  const ModelOf<Dim>& model() const { return body_->model; }
  double time() const { return static_cast<double>(steps()) * time_step(); }
  std::int64_t steps() const { return body_->steps; }
  double time_step() const { return body_->time_step(); }

 private:
  /// Energies before properties or creep change.
  struct Before {
    double held, pushed;
  };
  /// What a change leaves to the call at which its sums have come.
  struct UnderChange {
    std::vector<Vec<Dim>> old_force;
    double begun = 0.0;  ///< time by which positions have run ahead of the forces, s
    std::vector<double> mass_before;
  };
  Before before_change() const;
  template <class Change>
  void change_properties(const Before& before, UnderChange& under_change, Change change);
  double held() const;
  double measure_at_last_forces();
  int steps_to_hand_over();
  void tear_faces();

  std::unique_ptr<Body<Dim>> body_;
  Mover<Dim> mover_;
};

extern template class Mechanics<2>;
extern template class Mechanics<3>;

}  // namespace pyroclast
