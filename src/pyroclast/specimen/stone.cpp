#include "pyroclast/specimen/stone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/shell.hpp"

namespace pyroclast::specimen {
namespace {

const Outline* as_outline(const Stone<2>& stone) {
  return dynamic_cast<const Outline*>(stone.shape.get());
}

/// Calls f(from, to) for each side of a stone's outline, where it lies, while it returns false. Tells whether
/// it returned true.
template <class F>
bool any_side(const Stone<2>& stone, F f) {
  const Outline* const outline = as_outline(stone);
  if (!outline) return false;
  Vec<2> from = stone.centre + outline->corners().back();
  for (const Vec<2>& corner : outline->corners()) {
    const Vec<2> to = stone.centre + corner;
    if (f(from, to)) return true;
    from = to;
  }
  return false;
}

/// Tells whether a segment lies deeper in a stone with an outline than `depth` (m) somewhere. Between two
/// places where it meets the outline, three places stand for all.
bool runs_through(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to, double depth) {
  constexpr double kSlack = 1e-9;  // share of a side by which the segment may miss the side
  if (!(distance_from_segment(stone.centre, from, to) < reach(stone) - depth)) return false;
  const Vec<2> along = to - from;
  std::vector<double> shares{0.0, 1.0};
  any_side(stone, [&](const Vec<2>& begin, const Vec<2>& end) {
    const double sine = cross(along, end - begin);
    if (sine == 0.0) return false;
    const double share = cross(begin - from, end - begin) / sine, of_side = cross(begin - from, along) / sine;
    if (share > 0.0 && share < 1.0 && of_side > -kSlack && of_side < 1.0 + kSlack) shares.push_back(share);
    return false;
  });
  std::ranges::sort(shares);
  for (std::size_t i = 1; i < shares.size(); ++i)
    for (const double part : {0.25, 0.5, 0.75})
      if (distance(stone, from + std::lerp(shares[i - 1], shares[i], part) * along) < -depth) return true;
  return false;
}

/// Side of an outline, m.
struct OutlineSide {
  Vec<2> from, to;
};

/// Returns the sides of a stone that may reach another one, from the distances of their ends; none at all
/// where a corner is closer to the other stone than `gap` (m).
std::optional<std::vector<OutlineSide>> sides_towards(const Stone<2>& stone, const Stone<2>& other,
                                                      double gap) {
  const double around = reach(other);
  const auto away = [&](const Vec<2>& corner) {
    const Vec<2> there = corner - other.centre;
    const double from_centre = norm(there);
    return from_centre < around + gap ? other.shape->nearest(there).distance : from_centre - around;
  };
  std::vector<OutlineSide> sides;
  std::optional<double> before;
  const bool is_closer = any_side(stone, [&](const Vec<2>& from, const Vec<2>& to) {
    if (!before) before = away(from);
    const double after = away(to);
    if (*before + after <= norm(to - from)) sides.push_back({from, to});
    before = after;
    return after < gap;
  });
  if (is_closer) return std::nullopt;
  return sides;
}

/// Tells whether two stones with outlines are closer to each other than `gap` (m). A stone within another
/// one, or on it, is closer.
bool are_closer_outlines(const Stone<2>& a, const Stone<2>& b, double gap) {
  if (are_surely_closer(a, b, gap)) return true;
  const auto of_b = sides_towards(b, a, gap);
  if (!of_b) return true;
  const auto of_a = sides_towards(a, b, gap);
  if (!of_a) return true;
  // with all corners apart, sides are closer only where they run through each other
  if (gap > 0.0)
    return std::ranges::any_of(*of_a, [&](const OutlineSide& side) {
      return std::ranges::any_of(*of_b, [&](const OutlineSide& other) {
        return cross_each_other(side.from, side.to, other.from, other.to);
      });
    });
  const auto run_through = [gap](const std::vector<OutlineSide>& sides, const Stone<2>& other) {
    return std::ranges::any_of(
        sides, [&](const OutlineSide& side) { return runs_through(other, side.from, side.to, -gap); });
  };
  return distance(b, place_within(a)) < gap || distance(a, place_within(b)) < gap || run_through(*of_a, b) ||
         run_through(*of_b, a);
}

/// Returns the least move along a normal of a side that parts the convex hulls of two outlines, whose corners
/// run counter-clockwise. A segment is an outline of two corners.
Approach<2> least_move(std::span<const Vec<2>> a, std::span<const Vec<2>> b) {
  Approach<2> least{-std::numeric_limits<double>::infinity(), {}};
  const auto most = [](std::span<const Vec<2>> points, const Vec<2>& direction) {
    double result = -std::numeric_limits<double>::infinity();
    for (const Vec<2>& point : points) result = std::max(result, dot(direction, point));
    return result;
  };
  const auto try_normals = [&](std::span<const Vec<2>> sides, double sign) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Vec<2> along = sides[(i + 1) % sides.size()] - sides[i];
      const Vec<2> normal = Vec<2>{{along[1], -along[0]}} * (sign / norm(along));
      const double gap = -most(b, -normal) - most(a, normal);
      if (gap > least.gap) least = {gap, normal};
    }
  };
  try_normals(a, 1.0);
  try_normals(b, -1.0);
  return least;
}

/// Returns the nearest approach of two lines of straight pieces as their corners tell it.
/// \param from_a  function of a place that returns the approach of `a` and the place
template <class FromA, class FromB>
Approach<2> approach_of_corners(std::span<const Vec<2>> a, FromA from_a, std::span<const Vec<2>> b,
                                FromB from_b) {
  Approach<2> least{std::numeric_limits<double>::infinity(), {}};
  for (const Vec<2>& corner : b)
    if (const Approach<2> near = from_a(corner); near.gap < least.gap) least = near;
  for (const Vec<2>& corner : a)
    if (const Approach<2> near = from_b(corner); near.gap < least.gap) least = {near.gap, -near.direction};
  return least;
}

/// Returns the function of a place that returns the approach of a stone with an outline and the place.
auto approach_from(const Stone<2>& stone) {
  return [&stone](const Vec<2>& place) -> Approach<2> {
    const auto nearest = stone.shape->nearest(place - stone.centre);
    return {nearest.distance, nearest.point.normal};
  };
}

Approach<2> approach_of_outlines(const Stone<2>& a, const Stone<2>& b) {
  const std::vector<Vec<2>> of_a = corners_of(a), of_b = corners_of(b);
  const Approach<2> least = approach_of_corners(of_a, approach_from(a), of_b, approach_from(b));
  const bool overlap = are_closer_outlines(a, b, -kTouching * std::min(a.diameter, b.diameter));
  // the deepest corner would push to and fro where two long stones cross
  return overlap ? least_move(of_a, of_b) : least;
}

const Shell& shell_of(const Stone<3>& stone) {
  return dynamic_cast<const Shell&>(*stone.shape);
}

bool are_closer_shells(const Stone<3>& a, const Stone<3>& b, double gap) {
  if (are_surely_closer(a, b, gap)) return true;
  const Vec<3> between = b.centre - a.centre;
  return shell_of(a).has_vertex_closer(shell_of(b), -between, gap) ||
         shell_of(b).has_vertex_closer(shell_of(a), between, gap);
}

/// Depth of an overlap over the lesser diameter from which on the line of the centres tells the way apart.
constexpr double kDeep = 0.25;

Approach<3> approach_of_shells(const Stone<3>& a, const Stone<3>& b) {
  const Vec<3> between = b.centre - a.centre;
  const auto of_b = shell_of(b).approach_of_vertices(shell_of(a), between);
  const auto of_a = shell_of(a).approach_of_vertices(shell_of(b), -between);
  Approach<3> least{of_b.distance, of_b.point.normal};
  if (of_a.distance < of_b.distance) least = {of_a.distance, -of_a.point.normal};
  if (const double apart = norm(between);
      apart > 0.0 && least.gap < -kDeep * std::min(a.diameter, b.diameter))
    least.direction = between * (1.0 / apart);
  return least;
}

}  // namespace

Vec<2> place_within(const Stone<2>& stone) {
  const Outline* const outline = as_outline(stone);
  return outline ? stone.centre + outline->place_within() : stone.centre;
}

std::vector<Vec<2>> corners_of(const Stone<2>& stone) {
  const Outline* const outline = as_outline(stone);
  if (!outline) return {};
  std::vector<Vec<2>> corners = outline->corners();
  for (Vec<2>& corner : corners) corner += stone.centre;
  return corners;
}

std::vector<Vec<3>> corners_of(const Stone<3>& stone) {
  const auto* const shell = dynamic_cast<const Shell*>(stone.shape.get());
  if (!shell) return {};
  std::vector<Vec<3>> corners = shell->vertices();
  for (Vec<3>& corner : corners) corner += stone.centre;
  return corners;
}

template <int Dim>
Approach<Dim> approach(const Stone<Dim>& a, const Stone<Dim>& b) {
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
  if (b.shape) {
    if constexpr (Dim == 2)
      return approach_of_outlines(a, b);
    else
      return approach_of_shells(a, b);
  }
  const auto from_a = a.shape->nearest(between);
  return {from_a.distance - 0.5 * b.diameter, from_a.point.normal};
}

template Approach<2> approach(const Stone<2>&, const Stone<2>&);
template Approach<3> approach(const Stone<3>&, const Stone<3>&);

Approach<2> approach(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to) {
  const std::vector<Vec<2>> corners = corners_of(stone), ends{from, to};
  const auto from_segment = [&](const Vec<2>& place) -> Approach<2> {
    const Vec<2> along = to - from;
    const double share = std::clamp(dot(place - from, along) / dot(along, along), 0.0, 1.0);
    const Vec<2> away = place - (from + share * along);
    const double distance = norm(away);
    return {distance, distance > 0.0 ? away * (1.0 / distance) : Vec<2>{}};
  };
  const Approach<2> least = approach_of_corners(corners, approach_from(stone), ends, from_segment);
  return runs_through(stone, from, to, 0.0) ? least_move(corners, ends) : least;
}

template <int Dim>
bool are_closer(const Stone<Dim>& a, const Stone<Dim>& b, double gap) {
  const Vec<Dim> between = b.centre - a.centre;
  const double closest = reach(a) + gap + reach(b);
  if (!(dot(between, between) < closest * closest)) return false;
  if (!a.shape && !b.shape) return true;
  if (a.shape && b.shape) {
    if constexpr (Dim == 2)
      return are_closer_outlines(a, b, gap);
    else
      return are_closer_shells(a, b, gap);
  }
  return approach(a, b).gap < gap;
}

template bool are_closer(const Stone<2>&, const Stone<2>&, double);
template bool are_closer(const Stone<3>&, const Stone<3>&, double);

bool are_closer(const Stone<2>& stone, const Vec<2>& from, const Vec<2>& to, double gap) {
  if (!(distance_from_segment(stone.centre, from, to) < reach(stone) + gap)) return false;
  if (!stone.shape) return true;
  if (!(gap > 0.0)) return runs_through(stone, from, to, -gap);
  return holds(stone, from) || any_side(stone, [&](const Vec<2>& begin, const Vec<2>& end) {
           return distance_of_segments(from, to, begin, end) < gap;
         });
}

bool are_closer(const Stone<3>& stone, const Vec<3>& from, const Vec<3>& to, double gap) {
  const double length = norm(to - from);
  for (double along = 0.0;;) {  // nothing of the stone is nearer than its distance: so far the way is free
    const double free = distance(stone, from + (to - from) * (along / length)) - gap;
    if (free < 0.0) return true;
    if (along >= length) return false;
    along = std::min(along + std::max(free, 1e-3 * stone.diameter), length);
  }
}

}  // namespace pyroclast::specimen
