#include "pyroclast/mechanics/found/carry_over.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace pyroclast {

namespace {

bool have_same_corners(const Overlap& a, const Overlap& b) {
  bool same = a.count == b.count;
  for (int k = 0; same && k < a.count; ++k)
    same = a.corners[k].before == b.corners[k].before && a.corners[k].behind == b.corners[k].behind;
  return same;
}

/// Tells whether a point never presses: edges cross steeply there, or an unbroken contact joins the corner at
/// which it lies, and presses alone.
bool is_silent(const OverlapCorner& corner, unsigned joined) {
  const auto at = [&](int i) { return (joined >> static_cast<unsigned>(i) & 1U) != 0; };
  switch (corner.kind) {
    case OverlapCorner::Kind::of_a:
    case OverlapCorner::Kind::of_b:
      return at(corner.behind);
    case OverlapCorner::Kind::fixed:
      for (int i = 0; i < 3; ++i)
        if ((corner.at_a[i] > 0.5 && at(i)) || (corner.at_b[i] > 0.5 && at(3 + i))) return true;
      return false;
    case OverlapCorner::Kind::crossing:
      return false;
    case OverlapCorner::Kind::steep:
      return true;
  }
  return false;
}

/// Numbers that a point of a lane has in its row.
struct PointNumbers {
  double area = 0.0, offset = 0.0, rest = 0.0, damped = 0.0;
  Vec<2> held{}, shift{};
  std::array<double, LawOfRows::kMost> internals{};
};

/// From which points of an earlier overlap those of a new one take over: each earlier point goes to the
/// nearest new one; a new point to which none goes is like the nearest earlier one.
struct Heirs {
  std::array<std::array<int, Overlap::kMost>, Overlap::kMost> from{};  ///< earlier points of each new one
  std::array<int, Overlap::kMost> count{};     ///< number of them; 0 where none goes to it
  std::array<int, Overlap::kMost> like{};      ///< the nearest, where none goes to it
  std::array<double, Overlap::kMost> share{};  ///< weight of an earlier point in the mean of its new one

  std::span<const int> of(int k) const { return {from[k].data(), static_cast<std::size_t>(count[k])}; }
};

struct OffsetAndRest {
  double offset = 0.0, rest = 0.0;
};

/// Returns the offset and the rest of a new point.
OffsetAndRest rest_of(const FoundRow<3>& row, int lane, const Heirs& heirs, int k) {
  if (heirs.count[k] == 0)
    return {row.offset[heirs.like[k]].number[lane], row.rest[heirs.like[k]].number[lane]};
  OffsetAndRest mean;
  for (const int from : heirs.of(k)) {
    mean.offset += row.offset[from].number[lane] * heirs.share[from];
    mean.rest = std::max(mean.rest, row.rest[from].number[lane]);
  }
  return mean;
}

/// Points of one lane of a row.
class LanePoints {
 public:
  LanePoints(const FoundRows<3>& found, FoundRow<3>& row, int lane)
      : found_(found), row_(row), law_(found.laws[row.law]), lane_(lane) {}

  PointNumbers take(int k) const {
    PointNumbers p;
    each(k, p, [](double& number, const double& in_row) { number = in_row; });
    return p;
  }
  void put(int k, PointNumbers p) {
    each(k, p, [](const double& number, double& in_row) { in_row = number; });
  }
  /// Returns the numbers of a point that was never touched.
  PointNumbers fresh() const {
    PointNumbers p;
    std::copy_n(law_.broken, law_.internals, p.internals.begin());
    return p;
  }
  /// Returns the energy of the shear that points hold, J.
  double held_energy(const PointNumbers& p) const {
    return 0.5 * row_.shear_stiffness[0].number[lane_] * dot(p.held, p.held) * p.area;
  }
  /// Returns what a new point takes over: the mean of earlier ones, with the sum of their areas and forces of
  /// damping, or all but the damping of the one that it is like.
  PointNumbers carried(const Heirs& heirs, int k) const {
    if (heirs.count[k] == 0) {
      PointNumbers p = take(heirs.like[k]);
      p.damped = 0.0;
      return p;
    }
    PointNumbers p;
    for (const int from : heirs.of(k)) {
      const PointNumbers point = take(from);
      const double share = heirs.share[from];
      p.area += point.area;
      p.held += point.held * share;
      p.shift += point.shift * share;
      p.damped += point.damped;
      for (int i = 0; i < law_.internals; ++i) p.internals[i] += point.internals[i] * share;
    }
    const auto [offset, rest] = rest_of(row_, lane_, heirs, k);
    p.offset = offset;
    p.rest = rest;
    if (law_.held_jump >= 0) p.internals[law_.held_jump] = norm(p.held);
    return p;
  }

 private:
  template <class F>
  void each(int k, PointNumbers& p, F f) const {
    f(p.area, row_.area[k].number[lane_]);
    f(p.offset, row_.offset[k].number[lane_]);
    f(p.rest, row_.rest[k].number[lane_]);
    f(p.damped, row_.damped[k].number[lane_]);
    for (int i = 0; i < 2; ++i) {
      f(p.held[i], row_.held[k][i].number[lane_]);
      f(p.shift[i], row_.shift[k][i].number[lane_]);
    }
    for (int i = 0; i < law_.internals; ++i)
      f(p.internals[i], found_.internals[row_.first_internal + k * law_.internals + i].number[lane_]);
  }

  const FoundRows<3>& found_;
  FoundRow<3>& row_;
  const LawOfRows& law_;
  int lane_;
};

int nearest(const Vec<3>& to, const std::array<Vec<3>, Overlap::kMost>& places, int count) {
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < count; ++k)
    if (const Vec<3> way = places[k] - to; dot(way, way) < least) {
      least = dot(way, way);
      best = k;
    }
  return best;
}

/// Returns the heirs among the points of a new overlap.
///
/// \param weight  of the earlier points: their areas, or 1 of each where none bears
Heirs heirs_of(const Overlap& earlier, const TrianglePair<double>& pair_then, const Overlap& overlap,
               const TrianglePair<double>& pair, const std::array<double, Overlap::kMost>& weight) {
  std::array<Vec<3>, Overlap::kMost> then, places;
  for (int k = 0; k < earlier.count; ++k)
    then[k] = TrianglePair<double>::mixed(pair.a, pair_then.at_a[k]);  // it moves with a
  for (int k = 0; k < overlap.count; ++k) places[k] = pair.on_a(k);
  Heirs heirs;
  for (int k = 0; k < earlier.count; ++k) {
    if (!(weight[k] > 0.0)) continue;
    const int to = nearest(then[k], places, overlap.count);
    heirs.from[to][heirs.count[to]++] = k;
  }
  for (int k = 0; k < overlap.count; ++k) {
    if (heirs.count[k] == 0) heirs.like[k] = nearest(places[k], then, earlier.count);
    double all = 0.0;
    for (const int from : heirs.of(k)) all += weight[from];
    for (const int from : heirs.of(k)) heirs.share[from] = weight[from] / all;
  }
  return heirs;
}

void set_bit(std::uint32_t& bits, int lane, bool is_set) {
  const auto bit = 1U << static_cast<unsigned>(lane);
  bits = is_set ? bits | bit : bits & ~bit;
}

}  // namespace

TriangleCorners corners_in(const ShapesOfRow<3>::Places& places, int lane) {
  TriangleCorners corners;
  for (int i = 0; i < 6; ++i) corners[i] = places[i][lane];
  return corners;
}

Triangle triangle_a(const TriangleCorners& corners) {
  return {corners[0], corners[1], corners[2]};
}

Triangle triangle_b(const TriangleCorners& corners) {
  return {corners[3], corners[4], corners[5]};
}

Overlap overlap_of(const TriangleCorners& corners) {
  return overlap_of(triangle_a(corners), triangle_b(corners));
}

void see_overlap(FoundRow<3>& row, int lane, const TriangleCorners& corners, double sides) {
  Overlap& seen = row.seen[lane];
  seen = overlap_of(corners);
  row.names.put(lane, seen);
  bool is_lasting = seen.count > 0;  // places of fixed corners follow anew, and the size of tiny overlaps
  for (int k = 0; k < Overlap::kMost; ++k) {
    const bool is_point = k < seen.count;
    is_lasting = is_lasting && !(is_point && seen.corners[k].has_fixed_place());
    std::uint32_t silent = row.silent_points[k];
    set_bit(silent, lane, is_point && is_silent(seen.corners[k], row.joined[lane]));
    row.silent_points[k] = static_cast<std::uint8_t>(silent);
  }
  row.sides.number[lane] = is_lasting ? sides : -1.0;
  set_bit(row.changed, lane, row.overlap[lane].count > 0 && !have_same_corners(row.overlap[lane], seen));
  set_bit(row.renewed, lane, true);
}

bool carry_over(const FoundRows<3>& found, FoundRow<3>& row, int lane, const TriangleCorners& corners) {
  const Overlap &overlap = row.seen[lane], &earlier = row.overlap[lane];
  const TriangleCorners then = corners_in(row.pressed_at, lane);
  const auto pair = triangle_pair(overlap, triangle_a(corners), triangle_b(corners));
  const auto pair_then = triangle_pair(earlier, triangle_a(then), triangle_b(then));
  std::array<double, Overlap::kMost> weight{};
  bool bore = false;
  for (int k = 0; k < earlier.count; ++k) {
    weight[k] = row.area[k].number[lane];
    bore = bore || weight[k] > 0.0;
  }
  if (!bore) std::fill_n(weight.begin(), earlier.count, 1.0);
  const Heirs heirs = heirs_of(earlier, pair_then, overlap, pair, weight);
  const double most_depth = row.most_depth.number[lane];
  std::array<double, Overlap::kMost> gap{};
  bool touches = false;
  for (int k = 0; k < overlap.count; ++k) {
    const auto [offset, rest] = rest_of(row, lane, heirs, k);
    gap[k] = pair.gap[k] + offset;
    touches = touches || (gap[k] < rest && -gap[k] < most_depth);
  }
  // points that rest stay those of the last overlap that pressed, whatever overlaps come between
  if (!touches && !bore) return false;
  LanePoints points(found, row, lane);
  double held_then = 0.0;
  for (int k = 0; k < earlier.count; ++k) held_then += points.held_energy(points.take(k));
  std::array<PointNumbers, Overlap::kMost> carried{};
  for (int k = 0; k < Overlap::kMost; ++k)
    carried[k] = k < overlap.count ? points.carried(heirs, k) : points.fresh();
  const double not_counted = touches ? std::min(row.not_counted.number[lane], pair.overlap) : 0.0;
  PointAreas<double> areas;
  if (pair.overlap > not_counted)
    areas = PointAreas<double>(overlap.count, pair, row.thickness.number[lane], not_counted, most_depth, gap);
  // the shear holds on to the areas of the new points, and the rest of its energy is lost
  double held = 0.0;
  const bool is_handed_over = (row.handed_over >> static_cast<unsigned>(lane) & 1U) != 0;
  for (int k = 0; k < Overlap::kMost; ++k) {
    PointNumbers& point = carried[k];
    const bool counts = areas.area[k] > 0.0 && !is_silent(overlap.corners[k], row.joined[lane]);
    if (!counts && !is_handed_over) point = points.fresh();
    point.area = counts && point.area > 0.0 ? areas.area[k] : 0.0;
    points.put(k, point);
    held += points.held_energy(point);
  }
  row.lost_area.number[lane] += held_then - held;
  return true;
}

}  // namespace pyroclast
