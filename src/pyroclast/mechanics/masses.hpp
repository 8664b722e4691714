#pragma once

#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Stable step and the gridpoint that sets it.
struct TimeStepLimit {
  double step = 0.0;  ///< s
  int gridpoint = 0;  ///< gridpoint that sets it; where several ranks hold the body, the strictest of a part
};

/// Sums over the whole body of what its masses rest on.
struct MassSums {
  double stiffness = 0.0;
  double moving = 0.0;   ///< scaled masses, kg
  double scaling = 0.0;  ///< kinetic energy that the change of the masses brings, J
  /// Stiffness of all gridpoints by their owners, where contacts are found on several ranks: the mass of a
  /// block counts in the damping of its pairs on every rank that has one.
  std::vector<double> of_owners = {};
};

/// Masses of a body, and the stiffness on which scaled masses and stable steps rest.
template <int Dim>
class Masses {
 public:
  explicit Masses(Body<Dim>& body) : body_(body) {}

  /// Sets masses and the time step of a body that begins.
  /// \param densities  density of each material, kg/m³
  void set(const std::vector<double>& densities);
  /// Computes k_gp of Eq. (9): for every gridpoint the largest sum of |stiffness| over a row of the assembled
  /// matrix, zones and contacts. By Gershgorin's theorem no natural frequency exceeds sqrt(k_gp / m), so the
  /// step is safe for any shape.
  void measure_stiffness();
  /// Measures the stiffness anew, and lets scaled masses follow it if it has risen somewhere by more than the
  /// margin of the time step: faces whose sides slide far on each other stiffen, see FaceFrames::stiffening.
  void follow_stiffness();
  /// Scales the masses to the stiffness, and returns those before; real masses stay. `take` ends it.
  std::vector<double> scale();
  /// Returns the sums of stiffness and masses: a collective, for `take`.
  /// \param before  masses before they were scaled
  MassSums sums(const std::vector<double>& before) const;
  void take(const MassSums& sums);
  /// Takes the mass of gone blocks away, see GoneBlocks.
  void forget_gone();
  /// Sets what follows from stiffness and parameters of a state that was read.
  void follow_state();
  /// Returns the stable step with real mass, paper Eq. (9).
  TimeStepLimit real_mass_limit() const;

 private:
  double scaled_mass(int gridpoint) const;
  bool are_scaled() const { return body_.parameters.mass == MassChoice::scaled; }
  void set_step_over_mass();

  Body<Dim>& body_;
};

extern template class Masses<2>;
extern template class Masses<3>;

}  // namespace pyroclast
