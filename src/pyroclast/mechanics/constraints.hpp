#pragma once

#include <span>
#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Velocities, ties and forces that act on the gridpoints of a body from the next step on.
template <int Dim>
class Constraints {
 public:
  explicit Constraints(Body<Dim>& body) : body_(body) {}

  /// Prescribes one component of a gridpoint's velocity, m/s.
  void prescribe_velocity(int gridpoint, int component, double velocity);
  /// Lets one component of a gridpoint move freely again.
  void release(int gridpoint, int component);
  /// Ties free gridpoints of one block, which then share one component of their motion, as under a rigid
  /// plate. They start with their mean velocity, so tie them at rest. Throws Error where they are of several
  /// blocks.
  void tie(std::vector<int> gridpoints, int component);
  /// Ends all ties.
  void untie();
  /// Applies a force to a gridpoint, N, until set again; free components only.
  void apply_force(int gridpoint, const Vec<Dim>& force);

  /// Puts constraints into the order of their bundles, so that a state does not depend on the order in which
  /// they were made.
  void order();
  /// Shows constraints and ties to a visitor, those of own bundles.
  void visit_state(StateVisitor& visitor);

 private:
  void constrain(int gridpoint);
  void drop_if_free(int bundle);
  ConstraintPack<Dim>& constraint_pack(int gridpoint);
  void place_ties();
  void make(int bundle, bool act, double loading_work, std::span<const ConstraintPack<Dim>> packs);
  ListByChunk<int> ties_by_chunk() const;
  void take_ties(const StateVisitor& visitor, const ListByChunk<int>& ties);
  int first_slot_of(int bundle) const;

  Body<Dim>& body_;
};

extern template class Constraints<2>;
extern template class Constraints<3>;

}  // namespace pyroclast
