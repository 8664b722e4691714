#include "pyroclast/mechanics/found/carry_over.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace pyroclast {

namespace {

Triangle first_of(const TriangleCorners& x) {
  return {x[0], x[1], x[2]};
}
Triangle second_of(const TriangleCorners& x) {
  return {x[3], x[4], x[5]};
}

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
  /// Returns the mean of points by weights, with the sum of their areas and forces of damping.
  PointNumbers mean(const std::vector<std::pair<PointNumbers, double>>& points) const {
    double all = 0.0, area = 0.0;
    for (const auto& [point, weight] : points) {
      all += weight;
      area += point.area;
    }
    PointNumbers p;
    for (const auto& [point, weight] : points) {
      const double share = weight / all;
      p.held += point.held * share;
      p.shift += point.shift * share;
      p.offset += point.offset * share;
      p.rest = std::max(p.rest, point.rest);
      p.damped += point.damped;
      for (int i = 0; i < law_.internals; ++i) p.internals[i] += point.internals[i] * share;
    }
    if (law_.held_jump >= 0) p.internals[law_.held_jump] = norm(p.held);
    p.area = area;
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

using NumbersOfPoints = std::array<PointNumbers, Overlap::kMost>;

/// Returns what the points of an overlap take from those of an earlier one: each earlier point goes to the
/// nearest new one, which takes the mean by area; a new point to which none goes is like the nearest earlier
/// one. A point whose area is 0 follows points that rested.
NumbersOfPoints carried_over(const LanePoints& points, const Overlap& earlier,
                             const TrianglePair<double>& pair_then, const Overlap& overlap,
                             const TrianglePair<double>& pair) {
  const int count_then = earlier.count, count = overlap.count;
  std::array<Vec<3>, Overlap::kMost> then{}, places{};
  NumbersOfPoints numbers{}, carried{};
  double whole = 0.0;
  for (int k = 0; k < count_then; ++k) {
    then[k] = TrianglePair<double>::mixed(pair.a, pair_then.at_a[k]);  // it moves with a
    numbers[k] = points.take(k);
    whole += numbers[k].area;
  }
  std::array<std::vector<std::pair<PointNumbers, double>>, Overlap::kMost> come;
  for (int k = 0; k < count; ++k) places[k] = pair.on_a(k);
  for (int k = 0; k < count_then; ++k) {
    const double weight = whole > 0.0 ? numbers[k].area : 1.0;
    if (weight > 0.0) come[nearest(then[k], places, count)].emplace_back(numbers[k], weight);
  }
  for (int k = 0; k < Overlap::kMost; ++k) {
    if (k >= count) {
      carried[k] = points.fresh();
    } else if (!come[k].empty()) {
      carried[k] = points.mean(come[k]);
    } else {
      carried[k] = numbers[nearest(places[k], then, count_then)];
      carried[k].damped = 0.0;
    }
  }
  return carried;
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

void see_overlap(FoundRow<3>& row, int lane, const TriangleCorners& corners, double sides) {
  Overlap& seen = row.seen[lane];
  seen = overlap_of(first_of(corners), second_of(corners));
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
  const auto pair = triangle_pair(overlap, first_of(corners), second_of(corners));
  const auto pair_then = triangle_pair(earlier, first_of(then), second_of(then));
  LanePoints points(found, row, lane);
  double held_then = 0.0;
  bool bore = false;
  for (int k = 0; k < earlier.count; ++k) {
    held_then += points.held_energy(points.take(k));
    bore = bore || row.area[k].number[lane] > 0.0;
  }
  NumbersOfPoints carried = carried_over(points, earlier, pair_then, overlap, pair);
  const double most_depth = row.most_depth.number[lane];
  std::array<double, Overlap::kMost> gap{};
  bool touches = false;
  for (int k = 0; k < overlap.count; ++k) {
    gap[k] = pair.gap[k] + carried[k].offset;
    touches = touches || (gap[k] < carried[k].rest && -gap[k] < most_depth);
  }
  // points that rest stay those of the last overlap that pressed, whatever overlaps come between
  if (!touches && !bore) return false;
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
