#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Returns the extent of a round grain, from its diameter: the area of a circle, m², or the volume of a ball,
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

/// Returns the area of a grain, m², or its volume, m³.
template <int Dim>
double extent(const Grain<Dim>& grain) {
  return grain.shape ? grain.shape->extent() : extent_of_round<Dim>(grain.diameter);
}

/// Returns the radius of a ball around the grain's centre that holds the grain, m.
template <int Dim>
double reach(const Grain<Dim>& grain) {
  return grain.shape ? grain.shape->bounding_radius() : 0.5 * grain.diameter;
}

/// Returns the sum of the extents of grains.
template <int Dim>
double extent_of(std::span<const Grain<Dim>> grains) {
  double sum = 0.0;
  for (const Grain<Dim>& grain : grains) sum += extent(grain);
  return sum;
}

/// Returns the distance of a place from the surface of a grain, m: negative within.
template <int Dim>
double distance(const Grain<Dim>& grain, const Vec<Dim>& place) {
  const Vec<Dim> there = place - grain.centre;
  return grain.shape ? grain.shape->nearest(there).distance : norm(there) - 0.5 * grain.diameter;
}

/// Returns a place well within a grain.
Vec<2> place_within(const Grain<2>& grain);
inline Vec<3> place_within(const Grain<3>& grain) {
  return grain.centre;
}

/// Tells whether a place lies in a grain or on its surface.
template <int Dim>
bool holds(const Grain<Dim>& grain, const Vec<Dim>& place) {
  if (!grain.shape) return norm(place - grain.centre) <= 0.5 * grain.diameter;
  return distance(grain, place) <= 0.0;
}

/// Largest overlap of grains that touch each other or the surface of the body, as a share of the diameter: a
/// file of nine digits tells no more.
inline constexpr double kTouching = 1e-6;

/// Tells whether two grains are closer to each other than `gap` (m), or overlap; with a gap of 0 or less
/// whether they overlap by more than its length. Exact for circles, balls and the sides of outlines; two
/// shells are as near as their vertices tell.
template <int Dim>
bool are_closer(const Grain<Dim>& a, const Grain<Dim>& b, double gap);

/// Tells whether the balls within two grains are closer to each other than `gap` (m): then the grains are.
template <int Dim>
bool are_surely_closer(const Grain<Dim>& a, const Grain<Dim>& b, double gap) {
  const auto inner_of = [](const Grain<Dim>& grain) {
    return grain.shape ? grain.shape->inner_radius() : 0.5 * grain.diameter;
  };
  const Vec<Dim> between = b.centre - a.centre;
  const double inner_a = inner_of(a), inner_b = inner_of(b), inner = inner_a + inner_b + gap;
  return inner_a > 0.0 && inner_b > 0.0 && inner > 0.0 && dot(between, between) < inner * inner;
}

/// Nearest approach of two grains.
template <int Dim>
struct Approach {
  double gap;          ///< m; negative where they overlap: then a length of the move that parts them
  Vec<Dim> direction;  ///< unit vector in which the second one leaves the first soonest
};

/// Returns the nearest approach of two grains.
template <int Dim>
Approach<Dim> approach(const Grain<Dim>& a, const Grain<Dim>& b);

/// Returns the nearest approach of a grain with an outline and a segment.
Approach<2> approach(const Grain<2>& grain, const Vec<2>& from, const Vec<2>& to);

/// Returns the corners of a grain's outline where it lies, m; empty for a circle.
std::vector<Vec<2>> corners_of(const Grain<2>& grain);
/// Returns the vertices of a stone's shell where it lies, m; empty for a ball.
std::vector<Vec<3>> corners_of(const Grain<3>& grain);

/// Tells whether a segment comes closer to a grain than `gap` (m), or runs through the grain; with a gap of 0
/// or less whether the segment lies deeper in the grain than its length.
bool are_closer(const Grain<2>& grain, const Vec<2>& from, const Vec<2>& to, double gap);

}  // namespace pyroclast::specimen
