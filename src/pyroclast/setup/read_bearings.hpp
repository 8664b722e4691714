#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

/// A bearing that a deck asks for.
struct ReadBearing {
  Section section;
  Bearing bearing;
  BearingInterface interface;
  std::optional<Vec<2>> at;  ///< middle of its seat, on the outline, m; without one it covers a side
  double width = 0.0;        ///< of the seat, straight from end to end, m
};

/// Reads [[bearings]]. A bearing that covers no whole side lies on the patch `<name>_seat`.
std::vector<ReadBearing> read_bearings(const Section& root);

}  // namespace pyroclast
