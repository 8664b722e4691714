#include "pyroclast/specimen/outline_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast::specimen {
namespace {

// Lengths are in spacings.
constexpr double kOffset = 0.4;       ///< distance of a seed from the outline
constexpr double kFromCorner = 0.45;  ///< distance from a corner to the foot of a seed on the outline
constexpr double kAlong = 0.95;       ///< distance from seed to seed along a wall of a notch
/// Smallest distance of a free seed from a line with seeds of its own. These are at most sqrt(kOffset^2 +
/// (kAlong / 2)^2) = 0.62 from any point of the line, so a free seed is further away.
constexpr double kClear = 0.75;
constexpr double kApart = 0.6;  ///< smallest distance of a free seed from these seeds

constexpr double kNarrowestPatch = 0.9;

/// Largest angle of a corner that one cell may hold, radians: the cell is convex there, and not almost flat.
constexpr double kOfOneCell = std::numbers::pi * 170.0 / 180.0;
/// Largest angle of a corner that two cells may hold, radians: each has at most 145 degrees there.
constexpr double kNeedsThree = std::numbers::pi * 290.0 / 180.0;

Vec<2> turned_left(const Vec<2>& v) {
  return {{-v[1], v[0]}};
}

Vec<2> unit(const Vec<2>& v) {
  return v * (1.0 / norm(v));
}

/// Returns the interior angle at a corner of an outline that is walked with the body on its left, radians.
double angle_at(const Vec<2>& before, const Vec<2>& corner, const Vec<2>& after) {
  const Vec<2> back = before - corner, on = after - corner;
  double angle = std::atan2(back[1], back[0]) - std::atan2(on[1], on[0]);
  if (angle <= 0.0) angle += 2.0 * std::numbers::pi;
  return angle;
}

/// Returns the side of which a patch is a stretch, or the side itself.
int whole(const Region& region, int side) {
  const int of = region.sides()[side].part_of;
  return of >= 0 ? of : side;
}

/// Returns the largest distance from the ends of a straight patch to the feet of the seeds there, m: within a
/// narrow patch, they share its width. Throws Error where the patch is narrower than the blocks.
double foot_in_patch(const std::string& name, double width, double spacing) {
  if (width < kNarrowestPatch * spacing)
    throw Error(fmt::format("{}: it is {:.4g} mm wide, narrower than the blocks, {:.4g} mm", name,
                            1e3 * width, 1e3 * spacing));
  return 0.25 * width;
}

}  // namespace

double slot_point(double length, double width, double spacing) {
  const double point = std::max(2.0 * kFromCorner * spacing, 0.5 * width);
  return length - point < spacing ? length : point;
}

OutlineSeeds::OutlineSeeds(const Region& region, const BlockSizes& sizes) : region_(region), sizes_(sizes) {
  const auto& sides = region.sides();
  for (const Loop& loop : region.loops()) {
    const std::size_t n = loop.corners.size();
    double least = std::numeric_limits<double>::infinity();
    for (const Vec<2>& corner : loop.corners) least = std::min(least, sizes.at(corner));
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t previous = (i + n - 1) % n, next = (i + 1) % n;
      const Side &to_here = sides[loop.side[previous]], &from_here = sides[loop.side[i]];
      if (from_here.is_round) add_at_arc({loop.corners[i], loop.corners[next], loop.side[i]}, least);
      const bool within_one = whole(region, loop.side[previous]) == whole(region, loop.side[i]);
      if (within_one && (to_here.is_round || to_here.is_cut)) continue;
      const double spacing = sizes.at(loop.corners[i]);
      double foot = kFromCorner * spacing;
      for (const std::size_t piece : {previous, i})
        if (sides[loop.side[piece]].part_of >= 0)
          foot = std::min(foot,
                          foot_in_patch(sides[loop.side[piece]].name,
                                        norm(loop.corners[(piece + 1) % n] - loop.corners[piece]), spacing));
      add_at_corner(loop.corners[i], loop.corners[previous], loop.corners[next], foot);
    }
  }
  for (const Notch& notch : region.notches()) add_along_notch(notch);
}

void OutlineSeeds::add(const Vec<2>& point, double radius) {
  positions_.push_back(point);
  radii_.push_back(radius);
}

/// Adds a seed at the middle of an arc's piece. Both ends of all pieces have the same power, -offset² of the
/// smallest block: so the corner between two pieces is on the line between their cells, however long each
/// piece is. Where blocks are alike, the radius is half of the piece.
/// \param least  size of the smallest block along the loop, m
void OutlineSeeds::add_at_arc(const Piece& piece, double least) {
  const Vec<2> inward = turned_left(unit(piece.to - piece.from)), middle = 0.5 * (piece.from + piece.to);
  const double offset = kOffset * std::max(least, sizes_.at(middle)),
               half = 0.5 * norm(piece.to - piece.from);
  const double of_smallest = kOffset * least;
  add(middle + offset * inward, std::sqrt(half * half + (offset * offset - of_smallest * of_smallest)));
  guarded_.push_back({piece.from, piece.to});
}

void OutlineSeeds::add_at_corner(const Vec<2>& corner, const Vec<2>& before, const Vec<2>& after,
                                 double foot) {
  const double angle = angle_at(before, corner, after), spacing = sizes_.at(corner),
               offset = kOffset * spacing;
  if (angle < kOfOneCell) return;
  const double reach = std::hypot(foot, offset);
  const Vec<2> on = unit(after - corner), back = unit(before - corner);
  add(corner + foot * on + offset * turned_left(on), 0.5 * spacing);
  add(corner + foot * back - offset * turned_left(back), 0.5 * spacing);
  if (angle > kNeedsThree) {
    const double middle = std::atan2(on[1], on[0]) + 0.5 * angle;
    add(corner + Vec<2>{{reach * std::cos(middle), reach * std::sin(middle)}}, 0.5 * spacing);
  }
  guarded_.push_back({corner, corner + std::min(foot, norm(after - corner)) * on});
  guarded_.push_back({corner, corner + std::min(foot, norm(before - corner)) * back});
}

/// Returns the places of seeds along a wall, as distances from its beginning, m: from `begin` to `end`, or
/// only `begin` where there is no room for more.
std::vector<double> OutlineSeeds::places_along(const Vec<2>& from, const Vec<2>& along, double begin,
                                               double end) const {
  constexpr int kStretches = 1024;
  std::vector<double> steps{0.0};  // number of steps up to each part
  if (!sizes_.is_even())
    for (int part = 0; part < kStretches; ++part)
      steps.push_back(
          steps.back() +
          (end - begin) / kStretches /
              (kAlong * sizes_.at(from + (begin + (part + 0.5) * (end - begin) / kStretches) * along)));
  const double all = sizes_.is_even() ? (end - begin) / (kAlong * sizes_.mean()) : steps.back();
  const int more = std::max(0, static_cast<int>(std::lround(all)));
  const double step = more == 0 ? 0.0 : (end - begin) / more;
  std::vector<double> places;
  for (int i = 0; i <= more; ++i) {
    if (sizes_.is_even() || i == 0 || i == more) {
      places.push_back(begin + i * step);
      continue;
    }
    const auto after = std::ranges::upper_bound(steps, all * i / more);
    const auto part = static_cast<double>(after - steps.begin() - 1);
    const double share = (all * i / more - *(after - 1)) / (*after - *(after - 1));
    places.push_back(begin + (part + share) * (end - begin) / kStretches);
  }
  return places;
}

/// Adds pairs of seeds that are mirrored at the notch's axis, from the tip to the mouth, and one seed ahead
/// of the tip.
void OutlineSeeds::add_along_notch(const Notch& notch) {
  const double length = notch.length(), point = std::min(notch.point, length);
  const Vec<2> back = (notch.mouth - notch.tip) * (1.0 / length), left = turned_left(back);
  // seeds on both sides of a corner of the wall are as far from it, and as large
  struct AtCorner {
    double foot, spacing;
  };
  const double at_tip = sizes_.at(notch.tip);
  const auto add_wall = [&](const Vec<2>& from, const Vec<2>& to, const AtCorner& first,
                            bool to_mouth) -> AtCorner {
    const double wall = norm(to - from), at_end = sizes_.at(to);
    const Vec<2> along = unit(to - from);
    const std::vector<double> places = places_along(from, along, first.foot, wall - kFromCorner * at_end);
    double spacing = first.spacing;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (i > 0) spacing = i + 1 == places.size() ? at_end : sizes_.at(from + places[i] * along);
      const Vec<2> seed = from + places[i] * along + kOffset * spacing * turned_left(along);
      const double down = dot(seed - notch.tip, back), aside = dot(seed - notch.tip, left);
      add(notch.tip + down * back + aside * left, 0.5 * spacing);
      add(notch.tip + down * back - aside * left, 0.5 * spacing);
    }
    const double aside = dot(from - notch.tip, left), aside_to = dot(to - notch.tip, left);
    for (const double sign : {1.0, -1.0})
      guarded_.push_back({from + (sign - 1.0) * aside * left, to + (sign - 1.0) * aside_to * left});
    return to_mouth ? AtCorner{} : AtCorner{wall - places.back(), spacing};
  };
  const Vec<2> half = 0.5 * notch.width * left;
  if (notch.width == 0.0 || point == length) {
    add_wall(notch.tip, notch.mouth + half, {kFromCorner * at_tip, at_tip}, true);
  } else {
    const Vec<2> shoulder = notch.tip + point * back + half;
    const AtCorner from_shoulder = add_wall(notch.tip, shoulder, {kFromCorner * at_tip, at_tip}, false);
    add_wall(shoulder, notch.mouth + half, from_shoulder, true);
  }
  add(notch.tip - at_tip * std::hypot(kFromCorner, kOffset) * back, 0.5 * at_tip);
  guarded_.push_back({notch.mouth, notch.tip});
}

bool OutlineSeeds::leave_room_at(const Vec<2>& point) const {
  const double spacing = sizes_.at(point), clear = kClear * spacing, apart = kApart * spacing;
  for (const auto& [from, to] : guarded_)
    if (distance_from_segment(point, from, to) < clear) return false;
  for (const Vec<2>& seed : positions_)
    if (std::abs(point[0] - seed[0]) < apart && norm(point - seed) < apart) return false;
  return region_.distance(point) < 0.0;
}

}  // namespace pyroclast::specimen
