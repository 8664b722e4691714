#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/moving_body.hpp"

namespace pyroclast {

/// Body of its own that a deck asks for.
struct ReadBody {
  Section section;
  LooseBody body;
  BearingInterface interface;
};

/// Reads [[bodies]].
/// \param block_size  of the specimen, the edge of a body that states none, m; 0 where it is not known
std::vector<ReadBody> read_bodies(const Section& root, const DeckSpace& space, double block_size);

/// Reads [[velocities]].
std::vector<StartVelocity> read_velocities(const Section& root, const DeckSpace& space);

}  // namespace pyroclast
