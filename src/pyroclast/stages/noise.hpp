#pragma once

#include "pyroclast/mechanics/energy_ledger.hpp"

namespace pyroclast {

class StateVisitor;

/// Largest noise with which a peak counts, as a share of the force with which a stage drives the body.
inline constexpr double kMostNoise = 0.1;

/// Watch on the noise in a body that a stage drives: motion that was there before, or that its start makes.
/// Forces go with the root of an energy. So noise is below a share where the kinetic energy, at any look so
/// far, is below the square of that share of the work that loads and platens have done in the stage.
class Noise {
 public:
  /// Begins with the stage.
  void begin(const EnergyLedger& energy);
  bool is_below(double share, const EnergyLedger& energy);
  /// Returns the work of loads and platens when the stage began, J.
  double first_work() const { return first_work_; }
  void visit_state(StateVisitor& visitor);

 private:
  double first_work_ = 0.0;    ///< J
  double most_kinetic_ = 0.0;  ///< largest kinetic energy at a look so far, J
};

}  // namespace pyroclast
