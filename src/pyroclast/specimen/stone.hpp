#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns the extent of a round stone, from its diameter: the area of a circle, m², or the volume of a ball,
/// m³.
template <int Dim>
double extent_of_round(double diameter) {
  if constexpr (Dim == 2)
    return 0.25 * std::numbers::pi * diameter * diameter;
  else
    return std::numbers::pi / 6.0 * diameter * diameter * diameter;
}

/// Returns the area of a circle, from its diameter.
inline double circle_area(double diameter) {
  return extent_of_round<2>(diameter);
}

/// Returns the area of a stone, m², or its volume, m³.
template <int Dim>
double extent(const Stone<Dim>& stone) {
  return stone.shape ? stone.shape->extent() : extent_of_round<Dim>(stone.diameter);
}

/// Returns the radius of a ball around the stone's centre that holds the stone, m.
template <int Dim>
double reach(const Stone<Dim>& stone) {
  return stone.shape ? stone.shape->bounding_radius() : 0.5 * stone.diameter;
}

/// Returns the sum of the extents of stones.
template <int Dim>
double extent_of(std::span<const Stone<Dim>> stones) {
  double sum = 0.0;
  for (const Stone<Dim>& stone : stones) sum += extent(stone);
  return sum;
}

/// Returns the distance of a place from the surface of a stone, m: negative within.
template <int Dim>
double distance(const Stone<Dim>& stone, const Vec<Dim>& place) {
  const Vec<Dim> there = place - stone.centre;
  return stone.shape ? stone.shape->nearest(there).distance : norm(there) - 0.5 * stone.diameter;
}

/// Returns a place well within a stone.
Vec<2> place_within(const Stone<2>& stone);
inline Vec<3> place_within(const Stone<3>& stone) {
  return stone.centre;
}

/// Tells whether a place lies in a stone or on its surface.
template <int Dim>
bool holds(const Stone<Dim>& stone, const Vec<Dim>& place) {
  if (!stone.shape) return norm(place - stone.centre) <= 0.5 * stone.diameter;
  return distance(stone, place) <= 0.0;
}

/// Largest overlap of stones that touch each other or the surface of the body, as a share of the diameter: a
/// file of nine digits tells no more.
inline constexpr double kTouching = 1e-6;

/// Tells whether two stones are closer to each other than `gap` (m), or overlap; with a gap of 0 or less
/// whether they overlap by more than its length. Exact for circles, balls and the sides of outlines; two
/// shells are as near as their vertices tell.
template <int Dim>
bool are_closer(const Stone<Dim>& a, const Stone<Dim>& b, double gap);

/// Tells whether the balls within two stones are closer to each other than `gap` (m): then the stones are.
template <int Dim>
bool are_surely_closer(const Stone<Dim>& a, const Stone<Dim>& b, double gap) {
  const auto inner_of = [](const Stone<Dim>& stone) {
    return stone.shape ? stone.shape->inner_radius() : 0.5 * stone.diameter;
  };
  const Vec<Dim> between = b.centre - a.centre;
  const double inner_a = inner_of(a), inner_b = inner_of(b), inner = inner_a + inner_b + gap;
  return inner_a > 0.0 && inner_b > 0.0 && inner > 0.0 && dot(between, between) < inner * inner;
}

/// Nearest approach of two stones.
template <int Dim>
struct Approach {
  double gap;          ///< m; negative where they overlap: then a length of the move that parts them
  Vec<Dim> direction;  ///< unit vector in which the second one leaves the first soonest
};

/// Returns the nearest approach of two stones.
template <int Dim>
Approach<Dim> approach(const Stone<Dim>& a, const Stone<Dim>& b);

/// Returns the nearest approach of a stone with an outline and a segment.
Approach<2> approach(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to);

/// Returns the corners of a stone's outline where it lies, m; empty for a circle.
std::vector<Vec<2>> corners_of(const Stone<2>& stone);
/// Returns the vertices of a stone's shell where it lies, m; empty for a ball.
std::vector<Vec<3>> corners_of(const Stone<3>& stone);

/// Tells whether a segment comes closer to a stone than `gap` (m), or runs through the stone; with a gap of 0
/// or less whether the segment lies deeper in the stone than its length. In space to a thousandth of the
/// stone's diameter.
bool are_closer(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to, double gap);
bool are_closer(const Stone<3>& stone, const Vec<3>& from, const Vec<3>& to, double gap);

}  // namespace pyroclast::specimen
