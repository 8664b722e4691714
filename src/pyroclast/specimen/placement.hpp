#pragma once

#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/room.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Tells whether a stone lies within a room and keeps a distance from the room's surface (m).
template <int Dim>
bool lies_within(const Stone<Dim>& stone, const Room<Dim>& room, double distance);

/// Takes and places: puts each stone (largest first) at a random centre in the room. There the stone keeps
/// `minimum_gap` to the others, to stones that stand already, and to the surface. Where a stone finds no
/// place within `attempts` centres, all of them begin anew, smaller, and grow while they push each other away
/// (grow). Throws Error when they do not fit in that way either.
template <int Dim>
std::vector<Stone<Dim>> place(const std::vector<Stone<Dim>>& stones, const Room<Dim>& room,
                              const AggregateParameters& parameters, const std::vector<Stone<Dim>>& standing,
                              Random& random);

/// Draws the stones of a kind, places them as above and adds them to those that stand.
template <int Dim>
void draw_and_place(const Room<Dim>& room, const AggregateParameters& parameters, int phase, int kind,
                    Random& random, std::vector<Stone<Dim>>& standing);

/// Throws Error when the placed fraction of aggregate is off by more than 0.01 from that asked for.
/// \param parameters  parameters that ask for aggregates, whose place and smallest diameter the message names
void require_placed(double placed, double asked, const AggregateParameters& parameters);

/// Puts each fibre at a random place, in a random direction, where it keeps `minimum_gap` to the aggregates
/// and to the outline; fibres may cross each other. Throws Error when a fibre finds no place.
template <int Dim>
std::vector<Fibre<Dim>> place_fibres(const FibreParameters& parameters, const OutlineOf<Dim>& outline,
                                     std::span<const Stone<Dim>> standing, Random& random);

}  // namespace pyroclast::specimen
