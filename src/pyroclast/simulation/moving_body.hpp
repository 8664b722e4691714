#pragma once

#include <optional>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/stress_free.hpp"

namespace pyroclast {

/// Parameters of a simulation that moves the body, beside those of every simulation.
struct MovingBody {
  std::vector<Bearing> bearings;
  ContactParameters contacts;
  std::optional<StrainOfConcrete> strain_of_concrete;  ///< strain of the concrete, where phases follow it
  OnCooling on_cooling = OnCooling::irreversible;
  std::optional<StressFree> stress_free;  ///< temperature without stress; else the reference temperature
  std::vector<PlaneOfSymmetry> symmetry;
  MechanicsParameters mechanics;
};

}  // namespace pyroclast
