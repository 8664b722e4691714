#pragma once

#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/conduction.hpp"

/// Bodies in the plane as what they are, for tests that look at more than code of either dimension may.
namespace pyroclast::in_plane {

inline const ModelOf<2>& model(const Model& model) {
  return dynamic_cast<const ModelOf<2>&>(model);
}
inline Mechanics<2>& mechanics(Motion& motion) {
  return dynamic_cast<MotionOf<2>&>(motion).mechanics();
}
inline const Mechanics<2>& mechanics(const Motion& motion) {
  return dynamic_cast<const MotionOf<2>&>(motion).mechanics();
}
inline Conduction<2>& conduction(HeatSolver& solver) {
  return dynamic_cast<Conduction<2>&>(solver);
}
inline const Conduction<2>& conduction(const HeatSolver& solver) {
  return dynamic_cast<const Conduction<2>&>(solver);
}

}  // namespace pyroclast::in_plane
