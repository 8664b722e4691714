#pragma once

#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Blocks that have left a body. Nothing acts on them and they act on nothing: their zones and contacts have
/// no stiffness, their gridpoints no mass and no velocity.
template <int Dim>
class GoneBlocks {
 public:
  explicit GoneBlocks(Body<Dim>& body) : body_(body) {}

  /// Books the work of the weight of blocks, and the energy of their motion, before they go.
  void book(const std::vector<int>& blocks);
  /// Lets blocks go.
  void remove(const std::vector<int>& blocks);
  /// Takes the parameters of gone blocks away.
  void leave_out_of(BodyProperties& properties) const;
  /// Shows the gone blocks to a visitor; a state lets them go from a body that has all of its own.
  void visit_state(StateVisitor& visitor);

 private:
  Body<Dim>& body_;
};

extern template class GoneBlocks<2>;
extern template class GoneBlocks<3>;

}  // namespace pyroclast
