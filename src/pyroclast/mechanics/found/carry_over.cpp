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

/// Tells whether an unbroken contact joins the corner at which a point lies: it presses there alone.
bool is_joined(const OverlapCorner& corner, unsigned joined) {
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
                             const TrianglePair<double>& pair_then, const TouchedPair& now) {
  const int count_then = earlier.count, count = now.overlap.count;
  std::array<Vec<3>, Overlap::kMost> then{}, places{};
  NumbersOfPoints numbers{}, carried{};
  double whole = 0.0;
  for (int k = 0; k < count_then; ++k) {
    then[k] = TrianglePair<double>::mixed(now.pair.a, pair_then.at_a[k]);  // it moves with a
    numbers[k] = points.take(k);
    whole += numbers[k].area;
  }
  std::array<std::vector<std::pair<PointNumbers, double>>, Overlap::kMost> come;
  for (int k = 0; k < count; ++k) places[k] = now.pair.on_a(k);
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

}  // namespace

std::array<Vec<3>, 2> tangents_of(const TrianglePair<double>& pair) {
  const Vec<3> edge = pair.a[1] - pair.a[0], along = edge - pair.normal * dot(edge, pair.normal);
  const Vec<3> first = along * (1.0 / norm(along));
  return {first, cross(pair.normal, first)};
}

double TouchedPair::opening_velocity(int point, const TriangleCorners& velocity) const {
  Vec<3> apart{};
  for (int i = 0; i < 3; ++i)
    apart += velocity[3 + i] * pair.at_b[point][i] - velocity[i] * pair.at_a[point][i];
  return dot(pair.gap_slope[point], apart);
}

bool touch_pair(const FoundRows<3>& found, FoundRow<3>& row, int lane, const TriangleCorners& corners,
                TouchedPair& p) {
  const Triangle a = first_of(corners), b = second_of(corners);
  p.corners = corners;
  p.overlap = overlap_of(a, b);
  const int count = p.overlap.count;
  if (count == 0) return false;
  p.pair = triangle_pair<double>(p.overlap, a, b);
  p.tangents = tangents_of(p.pair);

  LanePoints points(found, row, lane);
  const Overlap& earlier = row.overlap[lane];
  const bool changes = earlier.count > 0 && !have_same_corners(earlier, p.overlap);
  double held_then = 0.0;
  bool bore = false;
  NumbersOfPoints carried;
  if (earlier.count > 0) {
    const Triangle a_then = first_of(row.pressed_at[lane]), b_then = second_of(row.pressed_at[lane]);
    const auto pair_then = triangle_pair<double>(earlier, a_then, b_then);
    if (changes) {
      for (int k = 0; k < earlier.count; ++k) {
        held_then += points.held_energy(points.take(k));
        bore = bore || row.area[k].number[lane] > 0.0;
      }
      carried = carried_over(points, earlier, pair_then, p);
    }
    const auto tangents_then = tangents_of(pair_then);
    for (int k = 0; k < count; ++k) {
      const Vec<3> apart = p.pair.on_b(k) - p.pair.on_a(k);
      const Vec<3> apart_then = TrianglePair<double>::mixed(b_then, p.pair.at_b[k]) -
                                TrianglePair<double>::mixed(a_then, p.pair.at_a[k]);
      for (int i = 0; i < 2; ++i)
        p.slide[k][i] = dot(p.tangents[i], apart) - dot(tangents_then[i], apart_then);
    }
  }

  const double most_depth = row.most_depth.number[lane];
  bool touches = false;
  for (int k = 0; k < count; ++k) {
    p.gap[k] = p.pair.gap[k] + (changes ? carried[k].offset : row.offset[k].number[lane]);
    const double rest = changes ? carried[k].rest : row.rest[k].number[lane];
    touches = touches || (p.gap[k] < rest && -p.gap[k] < most_depth);
  }
  // points that rest stay those of the last overlap that pressed, whatever overlaps come between
  if (changes && !touches && !bore) return true;
  double& not_counted = row.not_counted.number[lane];
  not_counted = touches ? std::min(not_counted, p.pair.overlap) : 0.0;
  if (p.pair.overlap > not_counted) {
    p.areas =
        PointAreas<double>(p.overlap, p.pair, row.thickness.number[lane], not_counted, most_depth, p.gap);
    for (int k = 0; k < count; ++k)
      p.counts[k] = p.areas.area[k] > 0.0 && !is_joined(p.overlap.corners[k], row.joined[lane]);
  }
  if (changes) {
    // the shear holds on to the areas of the new points, and the rest of its energy is lost
    double held = 0.0;
    const bool is_handed_over = (row.handed_over >> static_cast<unsigned>(lane) & 1U) != 0;
    for (int k = 0; k < Overlap::kMost; ++k) {
      PointNumbers& point = carried[k];
      if (!p.counts[k] && !is_handed_over) point = points.fresh();
      point.area = p.counts[k] && point.area > 0.0 ? p.areas.area[k] : 0.0;
      points.put(k, point);
      held += points.held_energy(point);
    }
    row.lost_area.number[lane] += held_then - held;
    p.is_carried_over = true;
  }
  return true;
}

}  // namespace pyroclast
