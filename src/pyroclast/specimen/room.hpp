#pragma once

#include <array>
#include <functional>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/region.hpp"

namespace pyroclast::specimen {

/// Room in which stones or seeds are placed: a box, or the part of it that a body takes.
template <int Dim>
struct Room {
  Vec<Dim> low, high;  ///< corners of the box, m
  double extent;       ///< area, m², or volume, m³, of the body
  /// Distance of a point from the surface of the body, m, negative within; empty where the body is the box.
  std::function<double(const Vec<Dim>&)> distance;
  /// Ends of the straight lines around a body in the plane that is no box, m, and of its slits: stones with
  /// an outline keep away from them.
  std::vector<std::array<Vec<Dim>, 2>> lines = {};
};

/// Returns the room of circles in a region, which must outlive it, as it was before notches were cut: a saw
/// goes through aggregate.
Room<2> room_in(const Region& region);

/// Returns the room of blocks in a region, which must outlive it, with its notches. Stones with an outline
/// lie there too: blocks could not follow a stone on both sides of a notch.
Room<2> room_of_blocks(const Region& region);

}  // namespace pyroclast::specimen
