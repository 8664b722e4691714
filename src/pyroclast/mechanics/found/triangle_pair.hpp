#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/mechanics/found/counted_share.hpp"

/// Two triangles of different blocks that press each other wherever they lie: the contact that is found, in
/// space.
///
/// Both run counter-clockwise as one sees them against the normal of their mean plane; so b runs clockwise
/// for its own block. They are seen along that normal. Their overlap is a polygon with 3 to 6 corners, and
/// each corner is a contact point with a share of the overlap: without slide, the three points of a joined
/// triangle. All numbers of the points are functions of the six corners of a and b, and the forces are minus
/// their exact gradient, so that triangles which slide, turn and leave each other neither gain nor lose
/// energy.
namespace pyroclast {

using Triangle = std::array<Vec<3>, 3>;

/// Corner of the overlap of two triangles.
struct OverlapCorner {
  enum class Kind : std::uint8_t {
    of_a,      ///< corner of a
    of_b,      ///< corner of b
    crossing,  ///< crossing of an edge of a and an edge of b
    /// Place that does not follow the edges: where they are almost parallel their crossing would run along
    /// them, and where they coincide rounding alone says which corner it is.
    fixed,
    steep  ///< such a place, where edges cross so steeply that they do not press, see Overlap::kSteepest
  };
  Kind kind = Kind::fixed;
  /// Edges of the overlap before and behind the corner. Edge i goes from corner i to the next one: 0 to 2 are
  /// edges of a, 3 to 5 those of b.
  int before = 0, behind = 0;
  std::array<double, 3> at_a{}, at_b{};  ///< weights of the corners of a and b at a fixed place

  bool has_fixed_place() const { return kind == Kind::fixed || kind == Kind::steep; }
  int edge_a() const { return std::min(before, behind); }      ///< edge of a that crosses
  int edge_b() const { return std::max(before, behind) - 3; }  ///< edge of b that crosses
};

/// Overlap of two triangles, as the names of its corners. These stay the same while the triangles move a
/// little.
struct Overlap {
  static constexpr int kMost = 6;  ///< most corners
  /// Sine of the angle between edges below which they count as parallel: their crossing would run along them
  /// a thousand times as fast as the triangles move.
  static constexpr double kParallel = 1e-3;
  /// Cosine of the angle between the mean normal and the common perpendicular of two edges below which they
  /// do not press where they cross: the gap there, which is taken along the normal, would change ten times as
  /// fast as the edges move. Edges of tilted triangles that lie in one outer side of their blocks are such.
  static constexpr double kSteepest = 0.1;
  /// Cosine from which on they press fully: between both a smooth share of their area counts.
  static constexpr double kUpright = 0.2;
  /// Overlap over the length of the sum of both area vectors above which there surely is one.
  static constexpr double kSurelyOne = 2e-11;

  int count = 0;  ///< number of corners; 0 where the triangles do not face each other or do not overlap
  std::array<OverlapCorner, kMost> corners{};
};

/// Returns the overlap of two triangles, seen along the normal of their mean plane.
Overlap overlap_of(const Triangle& a, const Triangle& b);

/// Names of the corners of eight overlaps side by side, as bits of lanes; a double reads the lowest one.
struct OverlapsInLanes {
  using Bits = std::uint8_t;
  template <class T>
  using OfCorner = std::array<T, Overlap::kMost>;

  int count = 0;                                       ///< number of corners of the overlap that has most
  OfCorner<Bits> exists{}, of_a{}, of_b{}, crosses{};  ///< what exists and is nothing else is fixed
  /// Corner of a that it is, or at which the edge of a begins that crosses there; likewise of b.
  OfCorner<std::array<Bits, 3>> on_a{}, on_b{};

  void put(int lane, const Overlap& overlap);
};

/// Condition that bits of lanes stand for.
template <class Real>
auto truth_of(unsigned bits) {
  if constexpr (std::is_same_v<Real, double>)
    return (bits & 1U) != 0;
  else
    return Real::Truth::from_bits(bits);
}

template <class Truth, class Real>
Vec<3, Real> select(const Truth& condition, const Vec<3, Real>& yes, const Vec<3, Real>& no) {
  return {
      {select(condition, yes[0], no[0]), select(condition, yes[1], no[1]), select(condition, yes[2], no[2])}};
}

/// Returns the bits of the overlaps of which a corner is fixed.
template <class Real>
unsigned fixed_in(const OverlapsInLanes& of, int k) {
  return of.exists[k] & ~static_cast<unsigned>(of.of_a[k] | of.of_b[k] | of.crosses[k]);
}
/// Returns the bits of the overlaps that end at a corner.
template <class Real>
unsigned ends_at(const OverlapsInLanes& of, int k) {
  return of.exists[k] & ~(k + 1 < of.count ? static_cast<unsigned>(of.exists[k + 1]) : 0U);
}

/// Adds a number or a vector where bits of lanes are set.
template <class Real, class Number>
void add_where(unsigned bits, Number& sum, const Number& more) {
  if (bits != 0) sum = select(truth_of<Real>(bits), sum + more, sum);
}

/// Places of two triangles whose overlap is known. Real is a double, or Lanes for eight pairs at once.
template <class Real>
struct TrianglePair {
  using Vector = Vec<3, Real>;
  template <class T>
  using OfPoint = std::array<T, Overlap::kMost>;

  std::array<Vector, 3> a, b;  ///< corners, m
  Vector area_a, area_b;       ///< area vectors, m²
  Real size_a, size_b, size;   ///< areas, and the length of the sum of the area vectors, m²
  Vector normal;               ///< unit vector along that sum, from a to b
  Real cosine;                 ///< cosine of the angle between the triangles
  Real overlap = 0.0;          ///< area of the overlap, m²
  Vector middle{};             ///< centroid of the overlap, seen from its first corner, m

  // The corners of the overlap.
  OfPoint<std::array<Real, 3>> at_a, at_b;  ///< weights of the corners of a and b
  OfPoint<Vector> place;                    ///< place on a, seen from the first corner, m
  OfPoint<Real> gap;                        ///< distance from a to b along the normal, m
  /// Direction by which a relative motion of a and b at these places changes the gap; its component along the
  /// normal is 1. A corner is met along the normal of the triangle over it, crossing edges across both.
  OfPoint<Vector> gap_slope;
  OfPoint<Real> upright;  ///< cosine between that direction and the normal; 1 but at crossings
  OfPoint<Real> part{};   ///< part of the overlap, m²
  /// Side of the overlap to the next corner, m, and the sum of the sides.
  OfPoint<Vector> side;
  Real outline = 0.0;

  /// Returns a point's place on a and that on b, m.
  Vector on_a(int k) const { return mixed(a, at_a[k]); }
  Vector on_b(int k) const { return mixed(b, at_b[k]); }

  /// Returns the place of the corner behind a corner.
  Vector next_place(const OverlapsInLanes& of, int k) const {
    return k + 1 < of.count ? select(truth_of<Real>(of.exists[k + 1]), place[k + 1], place[0]) : place[0];
  }

  static Vector mixed(const std::array<Vector, 3>& corners, const std::array<Real, 3>& weights) {
    return corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
  }
};

/// Returns the corner of a triangle that bits of lanes name, or one of the next ones.
template <class Real>
Vec<3, Real> named(const std::array<Vec<3, Real>, 3>& corners, const std::array<std::uint8_t, 3>& bits,
                   int next) {
  Vec<3, Real> corner = corners[next];
  for (int i = 1; i < 3; ++i)
    if (bits[i] != 0) corner = select(truth_of<Real>(bits[i]), corners[(i + next) % 3], corner);
  return corner;
}

/// Takes two triangles to the numbers of their overlap.
///
/// \param of  overlap of the triangles; of other ones the result has no meaning
/// \param p   in: weights at fixed corners
template <class Real>
void place_corners(const OverlapsInLanes& of, const std::array<Vec<3, Real>, 3>& a,
                   const std::array<Vec<3, Real>, 3>& b, TrianglePair<Real>& p) {
  using Vector = Vec<3, Real>;
  const Real zero = 0.0, one = 1.0, half = 0.5;
  const auto truth = [](unsigned bits) { return truth_of<Real>(bits); };
  p.a = a;
  p.b = b;
  p.area_a = cross(a[1] - a[0], a[2] - a[0]) * half;
  p.area_b = cross(b[1] - b[0], b[2] - b[0]) * half;
  p.size_a = norm(p.area_a);
  p.size_b = norm(p.area_b);
  p.cosine = dot(p.area_a, p.area_b) / (p.size_a * p.size_b);
  const Vector sum = p.area_a + p.area_b;
  p.size = norm(sum);
  p.normal = sum * (one / p.size);
  const Real over_a = one / dot(p.normal, p.area_a), over_b = one / dot(p.normal, p.area_b);
  for (int k = 0; k < of.count; ++k) {
    std::array<Real, 3> at_a{zero, zero, zero}, at_b{zero, zero, zero};
    Vector slope = p.normal;
    p.upright[k] = one;
    if ((of.of_a[k] | of.of_b[k]) != 0) {
      // a corner is met by the other triangle, where each of whose corners has the weight of the triangle
      // that the others make with that place
      const auto is_of_a = truth(of.of_a[k]);
      const Vector at = select(is_of_a, named(a, of.on_a[k], 0), named(b, of.on_b[k], 0));
      const Real over = select(is_of_a, over_b, over_a);
      std::array<Vector, 3> met;
      for (int i = 0; i < 3; ++i) met[i] = select(is_of_a, b[i], a[i]);
      for (int i = 0; i < 3; ++i) {
        const Vector &next = met[(i + 1) % 3], &last = met[(i + 2) % 3];
        const Real weight = dot(p.normal, cross(last - next, at - next)) * half * over;
        at_a[i] = select(is_of_a, select(truth(of.on_a[k][i]), one, zero), weight);
        at_b[i] = select(is_of_a, weight, select(truth(of.on_b[k][i]), one, zero));
      }
      slope = select(is_of_a, p.area_b * over_b, p.area_a * over_a);
    }
    if (of.crosses[k] != 0) {
      const auto crosses = truth(of.crosses[k]);
      const Vector from_a = named(a, of.on_a[k], 0), from_b = named(b, of.on_b[k], 0);
      const Vector edge_a = named(a, of.on_a[k], 1) - from_a, edge_b = named(b, of.on_b[k], 1) - from_b;
      const Vector across = cross(edge_a, edge_b), between = from_b - from_a;
      const Real over = one / dot(across, p.normal);
      const Real along_a = dot(p.normal, cross(between, edge_b)) * over;
      const Real along_b = dot(p.normal, cross(between, edge_a)) * over;
      const auto on_edge = [&](const std::array<std::uint8_t, 3>& begins, int i, const Real& along) {
        return select(truth(begins[i]), one - along, select(truth(begins[(i + 2) % 3]), along, zero));
      };
      for (int i = 0; i < 3; ++i) {
        at_a[i] = select(crosses, on_edge(of.on_a[k], i, along_a), at_a[i]);
        at_b[i] = select(crosses, on_edge(of.on_b[k], i, along_b), at_b[i]);
      }
      slope = select(crosses, across * over, slope);
      p.upright[k] = select(crosses, one / norm(slope), one);
    }
    if (fixed_in<Real>(of, k) != 0) {
      const auto fixed = truth(fixed_in<Real>(of, k));
      for (int i = 0; i < 3; ++i) {
        at_a[i] = select(fixed, p.at_a[k][i], at_a[i]);
        at_b[i] = select(fixed, p.at_b[k][i], at_b[i]);
      }
      slope = select(fixed, p.normal, slope);
    }
    const auto exists = truth(of.exists[k]);
    for (int i = 0; i < 3; ++i) {
      p.at_a[k][i] = select(exists, at_a[i], zero);
      p.at_b[k][i] = select(exists, at_b[i], zero);
    }
    p.gap_slope[k] = slope;
    const Vector on_a = p.on_a(k);
    p.gap[k] = dot(p.normal, p.on_b(k) - on_a);
    p.place[k] = on_a;
  }
  if (of.count == 0) return;
  const Vector first = p.place[0];
  for (int k = 0; k < of.count; ++k) p.place[k] -= first;
  // the triangles of the overlap's first corner and the edges that do not touch it
  Vector moment{};
  for (int k = 1; k + 1 < of.count; ++k) {
    const auto exists = truth(of.exists[k + 1]);
    const Real area = dot(p.normal, cross(p.place[k], p.place[k + 1])) * half;
    p.overlap = select(exists, p.overlap + area, p.overlap);
    moment = select(exists, moment + (p.place[k] + p.place[k + 1]) * (area * Real(1.0 / 3.0)), moment);
  }
  p.middle = moment * (one / p.overlap);
  // of the triangle of the centroid and an edge, each end of the edge has half: linear gaps keep their sum
  // and their moments, and nothing jumps where corners come and go
  for (int k = 0; k < of.count; ++k) {
    const Vector next = p.next_place(of, k);
    const Real area = dot(p.normal, cross(p.place[k] - p.middle, next - p.middle)) * Real(0.25);
    p.side[k] = next - p.place[k];
    add_where<Real>(of.exists[k], p.outline, norm(p.side[k]));
    add_where<Real>(of.exists[k], p.part[k], area);
    if (k + 1 < of.count) add_where<Real>(of.exists[k + 1], p.part[k + 1], area);
    add_where<Real>(ends_at<Real>(of, k), p.part[0], area);
  }
}

/// \param of  overlap of the triangles; of other ones the result has no meaning
TrianglePair<double> triangle_pair(const Overlap& of, const Triangle& a, const Triangle& b);

/// Tractions of the law at the points, and the energy of their normal part.
template <class Real>
struct PointTractions {
  std::array<Real, Overlap::kMost> normal{};         ///< Pa, tension positive
  std::array<Vec<3, Real>, Overlap::kMost> shear{};  ///< in the mean plane, Pa
  std::array<Real, Overlap::kMost> stored{};         ///< J/m²
};

/// Areas of the points: their parts of the overlap, where triangles do not lie parallel times the square of
/// the cosine, and times the shares that count, by depth and by the steepness of crossing edges.
template <class Real>
struct PointAreas {
  Real ratio = 0.0;        ///< ratio of the pair
  Real not_counted = 0.0;  ///< m²
  Real counted = 0.0;      ///< overlap less that of the pair's beginning, m²
  /// Length by which depths are divided, m: the side of a square overlap, and less the narrower an overlap
  /// is. Far sides of blocks that touch see each other across a band as narrow as blocks lie deep in each
  /// other, and are not to press.
  Real width = 0.0;
  /// True where the overlap is wider than that.
  decltype(Real(0.0) < Real(0.0)) is_wide = Real(0.0) < Real(0.0);
  std::array<CountedShare<Real>, Overlap::kMost> points{};
  std::array<Real, Overlap::kMost> upright{}, upright_slope{};  ///< share by steepness, and its slope
  std::array<Real, Overlap::kMost> area{};                      ///< m²

  PointAreas() = default;
  /// \param count        number of points
  /// \param of_pair      ratio of the pair's areas to these
  /// \param left_out     overlap that does not count, because the triangles lay in each other when the pair
  ///                     began, m²
  /// \param most_depth   depth from which on a point does not count, m
  /// \param gap          gap of each point from which its depth is taken, m
  PointAreas(int count, const TrianglePair<Real>& p, const Real& of_pair, const Real& left_out,
             const Real& most_depth, const std::array<Real, Overlap::kMost>& gap)
      : ratio(of_pair), not_counted(left_out), counted(p.overlap - left_out) {
    using std::sqrt;
    const Real some = larger(counted, Real(0.0)),
               of_outline = sqrt(Real(4.0) * some * sqrt(some) / p.outline);
    width = smaller(of_outline, most_depth * Real(1.0 / CountedShare<Real>::kMost));
    is_wide = width < of_outline;
    const Real of_part = factor(p);
    for (int k = 0; k < count; ++k) {
      points[k] = CountedShare<Real>((Real(0.0) - gap[k]) / width);
      constexpr double kOver = 1.0 / (Overlap::kUpright - Overlap::kSteepest);
      const Real y = smaller(larger((p.upright[k] - Overlap::kSteepest) * kOver, Real(0.0)), Real(1.0));
      upright[k] = y * y * (Real(3.0) - Real(2.0) * y);
      upright_slope[k] = Real(6.0 * kOver) * y * (Real(1.0) - y);
      area[k] = of_part * p.part[k] * points[k].share * upright[k];
    }
  }

  /// Returns the area of a point of which all counts over its part of the overlap.
  Real factor(const TrianglePair<Real>& p) const {
    return ratio * p.cosine * p.cosine * (counted / p.overlap);
  }
};

/// Returns the forces of the tractions at the points on the corners of a, then of b, N: minus the gradient of
/// their energy, where the points' areas move with the corners too. The shear acts as its area stands.
/// Tractions are zero where there is no point.
template <class Real>
std::array<Vec<3, Real>, 6> corner_forces(const OverlapsInLanes& of, const TrianglePair<Real>& p,
                                          const PointAreas<Real>& areas,
                                          const PointTractions<Real>& tractions) {
  using Vector = Vec<3, Real>;
  using OfCorners = std::array<Real, 3>;
  const Real zero = 0.0, one = 1.0, half = 0.5;
  const auto where = [](unsigned bits, const Vector& v) { return select(truth_of<Real>(bits), v, Vector{}); };
  std::array<Vector, 6> f{};
  // adds a force that acts on a, and against b, where the corners have these weights
  const auto press = [&](const Vector& force, const OfCorners& at_a, const OfCorners& at_b) {
    for (int i = 0; i < 3; ++i) {
      f[i] += force * at_a[i];
      f[3 + i] -= force * at_b[i];
    }
  };
  const Real over_overlap = one / p.overlap, of_part = areas.factor(p);
  // derivatives of the energy: by the normal, by the overlap's area and its outline, by the cosine, by the
  // parts of the points
  Vector by_normal{};
  Real by_overlap = zero, by_outline = zero, by_cosine = zero;
  std::array<Real, Overlap::kMost> by_part;
  for (int k = 0; k < of.count; ++k) {
    const CountedShare<Real>& counts = areas.points[k];
    const Real of_whole = of_part * tractions.stored[k] * areas.upright[k];
    const Real by_depth = of_whole * p.part[k] * counts.slope;
    const Real normal = tractions.normal[k] * areas.area[k] - by_depth / areas.width;
    const Vector force = p.gap_slope[k] * normal + tractions.shear[k] * areas.area[k];
    press(force, p.at_a[k], p.at_b[k]);
    by_normal -= force * p.gap[k];
    by_part[k] = of_whole * counts.share;
    const Real of_area = by_part[k] * p.part[k];
    const Real by_width = select(areas.is_wide, zero, by_depth * counts.depth);  // times the width
    by_overlap += (of_area * areas.not_counted * over_overlap - Real(0.75) * by_width) / areas.counted;
    by_outline += half * by_width / p.outline;
    by_cosine += Real(2.0) * of_area / p.cosine;
    const Real by_upright = of_part * tractions.stored[k] * counts.share * p.part[k] * areas.upright_slope[k];
    if (of.crosses[k] == 0 || !any(by_upright > zero)) continue;
    // crossing edges grow steeper as they and the normal turn
    const Vector edge_a = named(p.a, of.on_a[k], 1) - named(p.a, of.on_a[k], 0);
    const Vector edge_b = named(p.b, of.on_b[k], 1) - named(p.b, of.on_b[k], 0);
    const Vector across = cross(edge_a, edge_b), unit = p.gap_slope[k] * p.upright[k];
    const Vector by_across = (p.normal - unit * p.upright[k]) * (by_upright / dot(across, unit));
    const Vector by_edge_a = cross(edge_b, by_across), by_edge_b = cross(by_across, edge_a);
    for (int i = 0; i < 3; ++i) {
      const int last = (i + 2) % 3;
      f[i] += where(of.crosses[k] & of.on_a[k][i], by_edge_a) -
              where(of.crosses[k] & of.on_a[k][last], by_edge_a);
      f[3 + i] += where(of.crosses[k] & of.on_b[k][i], by_edge_b) -
                  where(of.crosses[k] & of.on_b[k][last], by_edge_b);
    }
    by_normal += unit * by_upright;
  }
  // The parts: triangles of the centroid and an edge, whose sum is the overlap.
  std::array<Vector, Overlap::kMost> by_place{};
  Vector by_middle{};
  for (int k = 0; k < of.count; ++k) {
    const bool is_last = k + 1 == of.count;
    const Real by_next =
        is_last ? by_part[0] : select(truth_of<Real>(of.exists[k + 1]), by_part[k + 1], by_part[0]);
    const Real by_area =
        select(truth_of<Real>(of.exists[k]), half * (half * (by_part[k] + by_next) + by_overlap), zero);
    const Vector here = p.place[k] - p.middle, there = p.next_place(of, k) - p.middle;
    const Vector by_here = cross(there, p.normal) * by_area, by_there = cross(p.normal, here) * by_area;
    const Real length = norm(p.side[k]);
    const Vector stretch = p.side[k] * select(length > zero, by_outline / length, zero);
    const Vector to_next = by_there + stretch;
    by_place[k] += by_here - stretch;
    if (!is_last) add_where<Real>(of.exists[k + 1], by_place[k + 1], to_next);
    add_where<Real>(ends_at<Real>(of, k), by_place[0], to_next);
    by_middle -= by_here + by_there;
    by_normal += cross(here, there) * by_area;
  }
  // The centroid: that of the triangles of the first corner and an edge.
  for (int k = 1; k + 1 < of.count; ++k) {
    const Vector &here = p.place[k], &there = p.place[k + 1];
    const Vector normal_area = cross(here, there) * half;
    const Vector from_middle = (here + there) * Real(1.0 / 3.0) - p.middle;
    const auto exists = truth_of<Real>(of.exists[k + 1]);
    const Real by_area = select(exists, half * dot(by_middle, from_middle) * over_overlap, zero);
    const Vector by_here = cross(there, p.normal) * by_area, by_there = cross(p.normal, here) * by_area;
    const Vector third =
        where(of.exists[k + 1], by_middle * (dot(p.normal, normal_area) * Real(1.0 / 3.0) * over_overlap));
    by_place[0] += third - by_here - by_there;
    by_place[k] += third + by_here;
    by_place[k + 1] += third + by_there;
    by_normal += normal_area * (Real(2.0) * by_area);
  }
  // The places on a follow the corners of a and b.
  for (int k = 0; k < of.count; ++k) {
    const Vector force = where(of.exists[k], -by_place[k]), on_b = where(of.of_b[k], force);
    const Vector on_a = force - on_b;
    for (int i = 0; i < 3; ++i) {
      f[i] += on_a * p.at_a[k][i];
      f[3 + i] += on_b * p.at_b[k][i];
    }
    // below a corner of b: along the normal by the gap
    Vector along = where(of.of_b[k], p.gap_slope[k] * dot(force, p.normal));
    if (of.crosses[k] != 0) {  // it runs along the edge of a
      const Vector edge_a = named(p.a, of.on_a[k], 1) - named(p.a, of.on_a[k], 0);
      const Vector edge_b = named(p.b, of.on_b[k], 1) - named(p.b, of.on_b[k], 0);
      const Vector on_edge =
          cross(edge_b, p.normal) * (zero - dot(force, edge_a) / dot(p.normal, cross(edge_a, edge_b)));
      along = select(truth_of<Real>(of.crosses[k]), on_edge, along);
    }
    press(along, p.at_a[k], p.at_b[k]);
    by_normal -= (along - on_b) * p.gap[k];
  }
  // The normal and the cosine follow the area vectors.
  const Vector turning = (by_normal - p.normal * dot(p.normal, by_normal)) * (one / p.size);
  const Real over_a = one / p.size_a, over_b = one / p.size_b;
  const Vector unit_a = p.area_a * over_a, unit_b = p.area_b * over_b;
  const Vector by_area_a = turning + (unit_b - unit_a * p.cosine) * (by_cosine * over_a);
  const Vector by_area_b = turning + (unit_a - unit_b * p.cosine) * (by_cosine * over_b);
  for (int i = 0; i < 3; ++i) {
    f[i] -= cross(p.a[(i + 1) % 3] - p.a[(i + 2) % 3], by_area_a) * half;
    f[3 + i] -= cross(p.b[(i + 1) % 3] - p.b[(i + 2) % 3], by_area_b) * half;
  }
  return f;
}

/// Returns how far the corners of two triangles that do not press must go at least until they may, m, but for
/// a factor that bounds the change of gaps and places by the ways of the corners; 0 or less where they may at
/// once.
///
/// \param most_depth  depth from which on nothing presses, m
/// \param within  largest way that is asked for, times that factor, m
double way_to_press(const Triangle& a, const Triangle& b, double most_depth, double within);
/// Returns the same of two triangles that overlap: until a gap may fall below a bound, or until they may
/// leave each other.
///
/// \param bound   gap, m
/// \param within  as above, m
double way_to_change(const Triangle& a, const Triangle& b, double bound, double within);

/// Returns unit vectors in the mean plane of a pair. The first one turns with the first edge of a.
///
/// \param normal  of the mean plane
template <class Real>
std::array<Vec<3, Real>, 2> tangents_of(const std::array<Vec<3, Real>, 3>& a, const Vec<3, Real>& normal) {
  const Vec<3, Real> edge = a[1] - a[0], along = edge - normal * dot(edge, normal);
  const Vec<3, Real> first = along * (Real(1.0) / norm(along));
  return {first, cross(normal, first)};
}

// Steps are compiled for several instruction sets, and these once: no set's code gets into another's.
extern template struct TrianglePair<double>;
extern template struct PointAreas<double>;
extern template void place_corners(const OverlapsInLanes&, const Triangle&, const Triangle&,
                                   TrianglePair<double>&);
extern template std::array<Vec<3>, 6> corner_forces(const OverlapsInLanes&, const TrianglePair<double>&,
                                                    const PointAreas<double>&, const PointTractions<double>&);
extern template std::array<Vec<3>, 2> tangents_of(const Triangle&, const Vec<3>&);
/// Returns the forces of one pair.
std::array<Vec<3>, 6> corner_forces(const Overlap& of, const TrianglePair<double>& p,
                                    const PointAreas<double>& areas, const PointTractions<double>& tractions);

}  // namespace pyroclast
