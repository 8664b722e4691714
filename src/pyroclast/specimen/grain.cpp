#include "pyroclast/specimen/grain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pyroclast/specimen/outline.hpp"

namespace pyroclast::specimen {
double distance(const Grain<2>& grain, const Vec<2>& place) {
  const Vec<2> there = place - grain.centre;
  return grain.shape ? grain.shape->nearest(there).distance : norm(there) - 0.5 * grain.diameter;
}

std::vector<Vec<2>> corners_of(const Grain<2>& grain) {
  const auto* outline = dynamic_cast<const Outline*>(grain.shape.get());
  if (!outline) return {};
  std::vector<Vec<2>> corners = outline->corners();
  for (Vec<2>& corner : corners) corner += grain.centre;
  return corners;
}

std::vector<Vec<2>> outline_points(const Grain<2>& grain) {
  constexpr double kFine = 1.0 / 64.0;  // share of the outline's length
  std::vector<Vec<2>> points = corners_of(grain);
  if (grain.shape)
    for (const auto& point : grain.shape->points(kFine * grain.shape->size()))
      points.push_back(grain.centre + point.at);
  return points;
}

bool holds(const Grain<2>& grain, const Vec<2>& place) {
  if (!grain.shape) return norm(place - grain.centre) <= 0.5 * grain.diameter;
  return distance(grain, place) <= 0.0;
}

template <int Dim>
Approach<Dim> approach(const Grain<Dim>& a, const Grain<Dim>& b) {
  const Vec<Dim> between = b.centre - a.centre;
  if (!a.shape && !b.shape) {
    const double apart = norm(between);
    Vec<Dim> direction{};
    direction[0] = 1.0;
    return {apart - reach(a) - reach(b), apart > 0.0 ? between * (1.0 / apart) : direction};
  }
  if (!a.shape) {
    const Approach<Dim> other = approach(b, a);
    return {other.gap, -other.direction};
  }
  const auto from_a = a.shape->nearest(between);
  if (!b.shape) return {from_a.distance - 0.5 * b.diameter, from_a.point.normal};
  Approach<Dim> least{from_a.distance, from_a.point.normal};
  // the least distance of two polygons that do not cross is that of a corner of one from the other
  if constexpr (Dim == 2) {
    least.gap = std::numeric_limits<double>::infinity();
    for (const Vec<2>& corner : corners_of(b)) {
      const auto nearest = a.shape->nearest(corner - a.centre);
      if (nearest.distance < least.gap) least = {nearest.distance, nearest.point.normal};
    }
    for (const Vec<2>& corner : corners_of(a)) {
      const auto nearest = b.shape->nearest(corner - b.centre);
      if (nearest.distance < least.gap) least = {nearest.distance, -nearest.point.normal};
    }
  }
  return least;
}

template Approach<2> approach(const Grain<2>&, const Grain<2>&);
template Approach<3> approach(const Grain<3>&, const Grain<3>&);

template <int Dim>
bool are_closer(const Grain<Dim>& a, const Grain<Dim>& b, double gap) {
  const Vec<Dim> between = b.centre - a.centre;
  const double closest = reach(a) + gap + reach(b);
  if (!(dot(between, between) < closest * closest)) return false;
  return (!a.shape && !b.shape) || approach(a, b).gap < gap;
}

template bool are_closer(const Grain<2>&, const Grain<2>&, double);
template bool are_closer(const Grain<3>&, const Grain<3>&, double);

bool are_closer(const Grain<2>& grain, const Vec<2>& from, const Vec<2>& to, double gap) {
  if (!grain.shape) return distance_from_segment(grain.centre, from, to) < 0.5 * grain.diameter + gap;
  const auto corners = corners_of(grain);
  const auto is_near = [&](const Vec<2>& corner) { return distance_from_segment(corner, from, to) < gap; };
  if (std::ranges::any_of(corners, is_near)) return true;
  const int pieces = 2 + static_cast<int>(4.0 * norm(to - from) / grain.diameter);
  for (int i = 0; i <= pieces; ++i)
    if (distance(grain, from + (static_cast<double>(i) / pieces) * (to - from)) < gap) return true;
  return false;
}

}  // namespace pyroclast::specimen
