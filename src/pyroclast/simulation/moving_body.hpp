#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/motion.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/loose_bodies.hpp"
#include "pyroclast/simulation/acting/spalling.hpp"
#include "pyroclast/simulation/stress_free.hpp"

namespace pyroclast {

/// Velocity that the gridpoints of a set have when the run begins.
struct StartVelocity {
  std::string set;
  Vec<3> velocity{};       ///< m/s
  std::string deck_place;  ///< place in the deck that asks for it, for messages
};

/// Parameters of a simulation that moves the body, beside those of every simulation.
struct MovingBody {
  std::vector<Bearing> bearings;
  std::vector<LooseBody> bodies;  ///< bodies beside the specimen
  std::vector<StartVelocity> velocities;
  ContactParameters contacts;
  std::optional<StrainOfConcrete> strain_of_concrete;  ///< strain of the concrete, where phases follow it
  OnCooling on_cooling = OnCooling::irreversible;
  std::optional<StressFree> stress_free;  ///< temperature without stress; else the reference temperature
  std::vector<PlaneOfSymmetry> symmetry;
  std::optional<SpallingRule> spalling;  ///< rule by which pieces leave; empty where all blocks stay
  MechanicsParameters mechanics;
};

}  // namespace pyroclast
