#pragma once

#include <functional>
#include <span>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Room in which stones are placed: a box, or the part of it that a body takes.
template <int Dim>
struct Room {
  Vec<Dim> low, high;  ///< corners of the box, m
  double extent;       ///< area, m², or volume, m³, of the body
  /// Distance of a point from the surface of the body, m, negative within; empty where the body is the box.
  std::function<double(const Vec<Dim>&)> distance;
};

/// Returns the room in a region, which must outlive it, as it was before notches were cut: a saw goes through
/// aggregate.
Room<2> room_in(const Region& region);

/// Tells whether a grain lies within a room and keeps a distance from the room's surface (m).
template <int Dim>
bool lies_within(const Grain<Dim>& grain, const Room<Dim>& room, double distance);

/// Takes and places: puts each grain (largest first) at a random centre in the room. There the grain keeps
/// `minimum_gap` to the others, to grains that stand already, and to the surface. Where a grain finds no
/// place within `attempts` centres, all of them begin anew, smaller, and grow while they push each other away
/// (grow). Throws Error when they do not fit in that way either.
template <int Dim>
std::vector<Grain<Dim>> place(const std::vector<Grain<Dim>>& grains, const Room<Dim>& room,
                              const AggregateParameters& parameters, const std::vector<Grain<Dim>>& standing,
                              Random& random);

/// Draws the grains of a kind, places them as above and adds them to those that stand.
template <int Dim>
void draw_and_place(const Room<Dim>& room, const AggregateParameters& parameters, int phase, int kind,
                    Random& random, std::vector<Grain<Dim>>& standing);

/// Throws Error when the placed fraction of aggregate is off by more than 0.01 from that asked for.
/// \param d_min  smallest diameter, which the message names, m
void require_placed(double placed, double asked, double d_min);

/// Puts each fibre at a random place, in a random direction, where it keeps `minimum_gap` to the aggregates
/// and to the outline; fibres may cross each other. Throws Error when a fibre finds no place.
std::vector<Fibre> place_fibres(const FibreParameters& parameters, const Region& region,
                                std::span<const Aggregate> standing, Random& random);

}  // namespace pyroclast::specimen
