#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/setup/read_space.hpp"

namespace pyroclast {

/// Bearing that a deck asks for.
struct ReadBearing {
  Section section;
  Bearing bearing;
  BearingInterface interface;
  /// Middle of the bearing's seat, on the outline, m; without it the bearing covers a side.
  std::optional<Vec<2>> at;
  std::optional<double> z;  ///< third coordinate of this middle, where a solid states it, m
  double width = 0.0;       ///< width of the seat, straight from end to end, m
};

/// Reads [[bearings]]. A bearing that covers no whole side lies on the patch `<name>_seat`.
std::vector<ReadBearing> read_bearings(const Section& root, const DeckSpace& space);

}  // namespace pyroclast
