#pragma once

#include "pyroclast/base/state_copy.hpp"

namespace pyroclast {

/// Gives an object the state of another one of its kind.
template <class Visited>
void copy_state(Visited& from, Visited& to) {
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { from.visit_state(visitor); });
  copy.put([&](StateVisitor& visitor) { to.visit_state(visitor); });
}

}  // namespace pyroclast
