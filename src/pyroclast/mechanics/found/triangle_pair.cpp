#include "pyroclast/mechanics/found/triangle_pair.hpp"

#include <limits>

namespace pyroclast {

namespace {

/// Overlap over the areas of both triangles below which there is none.
constexpr double kLeastOverlap = 1e-12;
static_assert(2.0 * kLeastOverlap < 0.2 * Overlap::kSurelyOne);
/// Radius of a disc over the root of twice both areas that surely makes such an overlap.
constexpr double kLeastDisc = 1e-5;
/// Corners of a triangle that is cut by three lines, with three more that rounding may make.
constexpr int kMostCut = Overlap::kMost + 3;

/// Corner of a polygon in the mean plane, and the edge that begins there.
struct FlatCorner {
  Vec<2> at;
  int edge = 0;
};
using FlatTriangle = std::array<FlatCorner, 3>;

/// Returns twice the area of a triangle: positive where `p` lies to the left of the line from u to v.
double left_of(const Vec<2>& p, const Vec<2>& u, const Vec<2>& v) {
  return cross(v - u, p - u);
}

std::array<double, 3> weights_in(const FlatTriangle& t, const Vec<2>& p) {
  const double whole = left_of(t[2].at, t[0].at, t[1].at);
  const double first = left_of(p, t[1].at, t[2].at) / whole, second = left_of(p, t[2].at, t[0].at) / whole;
  return {first, second, 1.0 - first - second};
}

/// Returns the weights of the corners of an edge at the place of the edge that is nearest to a point.
std::array<double, 3> weights_on_edge(const FlatTriangle& t, int edge, const Vec<2>& p) {
  const int next = (edge + 1) % 3;
  const Vec<2> along = t[next].at - t[edge].at;
  std::array<double, 3> weights{};
  weights[next] = std::clamp(dot(p - t[edge].at, along) / dot(along, along), 0.0, 1.0);
  weights[edge] = 1.0 - weights[next];
  return weights;
}

/// Polygon in the mean plane, counter-clockwise.
struct Polygon {
  int count = 0;
  std::array<FlatCorner, kMostCut> corners{};
};

/// Returns the part of a that lies in b: each edge of b cuts off what lies outside (Sutherland and Hodgman
/// 1974).
Polygon cut_to(const FlatTriangle& a, const FlatTriangle& b) {
  Polygon polygon{3, {}};
  std::array<FlatCorner, kMostCut> cut{};
  std::copy(a.begin(), a.end(), polygon.corners.begin());
  for (int j = 0; j < 3 && polygon.count > 0; ++j) {
    const Vec<2>&from = b[j].at, &to = b[(j + 1) % 3].at;
    int left = 0;
    for (int k = 0; k < polygon.count; ++k) {
      const FlatCorner& here = polygon.corners[k];
      const FlatCorner& next = polygon.corners[k + 1 == polygon.count ? 0 : k + 1];
      const double inside = left_of(here.at, from, to), next_inside = left_of(next.at, from, to);
      if (inside >= 0.0) cut[left++] = here;
      if ((inside >= 0.0) != (next_inside >= 0.0))
        cut[left++] = {here.at + (next.at - here.at) * (inside / (inside - next_inside)),
                       inside >= 0.0 ? b[j].edge : here.edge};
    }
    polygon.count = std::min(left, Overlap::kMost);
    std::copy_n(cut.begin(), polygon.count, polygon.corners.begin());
  }
  return polygon;
}

/// Mean plane of two triangles that face each other, and the triangles seen along its normal.
struct MeanPlane {
  Vec<3> area_a, area_b;       ///< twice the area vectors, m²
  Vec<3> normal;               ///< unit normal
  std::array<Vec<3>, 2> axes;  ///< any two axes of the plane
  FlatTriangle flat_a, flat_b;

  MeanPlane(const Triangle& a, const Triangle& b)
      : area_a(cross(a[1] - a[0], a[2] - a[0])), area_b(cross(b[1] - b[0], b[2] - b[0])) {
    const Vec<3> sum = area_a + area_b;
    normal = sum * (1.0 / norm(sum));
    const Vec<3> aside = cross(std::abs(normal[0]) < 0.6 ? Vec<3>{{1, 0, 0}} : Vec<3>{{0, 1, 0}}, normal);
    axes[0] = aside * (1.0 / norm(aside));
    axes[1] = cross(normal, axes[0]);
    const auto flat = [&](const Vec<3>& x) {
      return Vec<2>{{dot(x - a[0], axes[0]), dot(x - a[0], axes[1])}};
    };
    for (int i = 0; i < 3; ++i) {
      flat_a[i] = {flat(a[i]), i};
      flat_b[i] = {flat(b[i]), 3 + i};
    }
  }
};

/// Returns a triangle whose edges lie further out by a distance.
FlatTriangle grown(const FlatTriangle& t, double by) {
  std::array<double, 3> lengths{};  // of the edges across from the corners
  for (int i = 0; i < 3; ++i) lengths[i] = norm(t[(i + 2) % 3].at - t[(i + 1) % 3].at);
  const double round = lengths[0] + lengths[1] + lengths[2];
  Vec<2> centre{};  // of the inscribed circle
  for (int i = 0; i < 3; ++i) centre += t[i].at * (lengths[i] / round);
  const double radius = left_of(t[2].at, t[0].at, t[1].at) / round, factor = (radius + by) / radius;
  FlatTriangle larger = t;
  for (FlatCorner& corner : larger) corner.at = centre + (corner.at - centre) * factor;
  return larger;
}

/// Returns how far a triangle lies beside an edge of another one; negative where it does not.
double distance_beside(const FlatTriangle& t, const FlatTriangle& other) {
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vec<2>&from = t[i].at, &to = t[(i + 1) % 3].at;
    double nearest = std::numeric_limits<double>::infinity();
    for (const FlatCorner& corner : other)
      nearest = std::min(nearest, -left_of(corner.at, from, to) / norm(to - from));
    most = std::max(most, nearest);
  }
  return most;
}

/// Returns the lesser distance of a place from the edges of a triangle; negative outside.
double distance_within(const FlatTriangle& t, const Vec<2>& place) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vec<2>&from = t[i].at, &to = t[(i + 1) % 3].at;
    least = std::min(least, left_of(place, from, to) / norm(to - from));
  }
  return least;
}

/// Returns the least and the largest gap where both triangles, grown by a distance, lie over each other:
/// while corners go no further, all gaps of the overlap are gaps of this region.
std::array<double, 2> gaps_within(const MeanPlane& plane, const Vec<3>& from_a_to_b, double within) {
  // the gap is linear
  const double over_a = 1.0 / dot(plane.normal, plane.area_a), over_b = 1.0 / dot(plane.normal, plane.area_b);
  const auto gap = [&](const Vec<2>& at) {
    const Vec<3> place = plane.axes[0] * at[0] + plane.axes[1] * at[1];
    return dot(plane.area_b, from_a_to_b - place) * over_b + dot(plane.area_a, place) * over_a;
  };
  const Polygon region = cut_to(grown(plane.flat_a, within), grown(plane.flat_b, within));
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (int k = 0; k < region.count; ++k) {
    const double here = gap(region.corners[k].at);
    least = std::min(least, here);
    most = std::max(most, here);
  }
  return {least, most};
}

/// Returns the least height of a triangle.
double height(const Triangle& t) {
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, norm(t[(i + 1) % 3] - t[i]));
  return norm(cross(t[1] - t[0], t[2] - t[0])) / longest;
}

}  // namespace

Overlap overlap_of(const Triangle& a, const Triangle& b) {
  Overlap overlap;
  if (!(dot(cross(a[1] - a[0], a[2] - a[0]), cross(b[1] - b[0], b[2] - b[0])) > 0.0)) return overlap;
  const MeanPlane plane(a, b);
  const FlatTriangle &flat_a = plane.flat_a, &flat_b = plane.flat_b;
  const Polygon polygon = cut_to(flat_a, flat_b);
  const int count = polygon.count;
  double area = 0.0;
  for (int k = 1; k + 1 < count; ++k)
    area += 0.5 * cross(polygon.corners[k].at - polygon.corners[0].at,
                        polygon.corners[k + 1].at - polygon.corners[0].at);
  if (count < 3 || !(area > kLeastOverlap * norm(plane.area_a + plane.area_b))) return overlap;

  // Crossings of edges that are almost parallel stand on an almost straight side. They are left out, as long
  // as there are three others.
  std::array<OverlapCorner, kMostCut> corners{};
  std::array<bool, kMostCut> is_straight{};
  int straight = 0;
  for (int k = 0; k < count; ++k) {
    using Kind = OverlapCorner::Kind;
    OverlapCorner& corner = corners[k];
    const Vec<2>& at = polygon.corners[k].at;
    corner.before = polygon.corners[k == 0 ? count - 1 : k - 1].edge;
    corner.behind = polygon.corners[k].edge;
    const bool before_of_a = corner.before < 3, behind_of_a = corner.behind < 3;
    if (before_of_a != behind_of_a) {
      const int i = corner.edge_a(), j = corner.edge_b();
      const Vec<3> edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(j + 1) % 3] - b[j];
      const Vec<3> across = cross(edge_a, edge_b);
      const double along_normal = std::abs(dot(across, plane.normal));
      const double parallel = Overlap::kParallel * norm(edge_a) * norm(edge_b),
                   steep = Overlap::kSteepest * norm(across);
      if (along_normal >= std::max(parallel, steep)) {
        corner.kind = Kind::crossing;
      } else {
        corner.at_a = weights_on_edge(flat_a, i, at);
        corner.at_b = weights_on_edge(flat_b, j, at);
        if (along_normal < steep && norm(across) >= parallel) corner.kind = Kind::steep;
        is_straight[k] = dot(edge_a, edge_b) > 0.0;
        straight += is_straight[k] ? 1 : 0;
      }
    } else if (corner.behind % 3 == (corner.before + 1) % 3) {
      corner.kind = behind_of_a ? Kind::of_a : Kind::of_b;
    } else {  // rounding has taken a tiny edge away
      corner.at_a = weights_in(flat_a, at);
      corner.at_b = weights_in(flat_b, at);
    }
  }
  const bool keeps_straight = count - straight < 3;
  for (int k = 0; k < count; ++k)
    if (keeps_straight || !is_straight[k]) overlap.corners[overlap.count++] = corners[k];
  return overlap;
}

double way_to_press(const Triangle& a, const Triangle& b, double most_depth, double within) {
  const MeanPlane plane(a, b);
  const double cosine = dot(plane.area_a, plane.area_b) / (norm(plane.area_a) * norm(plane.area_b));
  if (!(cosine > 0.0)) return -cosine / (1.0 / height(a) + 1.0 / height(b));
  const double way =
      std::max(distance_beside(plane.flat_a, plane.flat_b), distance_beside(plane.flat_b, plane.flat_a));
  if (way >= within) return way;
  const auto [least, most] = gaps_within(plane, b[0] - a[0], within);
  return std::max({way, least, -most_depth - most});
}

double way_to_change(const Triangle& a, const Triangle& b, double bound, double within) {
  const MeanPlane plane(a, b);
  const double cosine = dot(plane.area_a, plane.area_b) / (norm(plane.area_a) * norm(plane.area_b));
  const Polygon overlap = cut_to(plane.flat_a, plane.flat_b);
  if (!(cosine > 0.0) || overlap.count == 0) return 0.0;
  // as long as both hold a disc they overlap
  Vec<2> middle{};
  for (int k = 0; k < overlap.count; ++k) middle += overlap.corners[k].at * (1.0 / overlap.count);
  const double radius =
      std::min(distance_within(plane.flat_a, middle), distance_within(plane.flat_b, middle));
  const double spare = radius - kLeastDisc * std::sqrt(norm(plane.area_a + plane.area_b));
  const double least = gaps_within(plane, b[0] - a[0], within)[0];
  return std::min({cosine / (1.0 / height(a) + 1.0 / height(b)), spare, least - bound});
}

void OverlapsInLanes::put(int lane, const Overlap& overlap) {
  const auto set = [&](Bits& bits, bool is_set) {
    const auto bit = 1U << static_cast<unsigned>(lane);
    bits = static_cast<Bits>(is_set ? bits | bit : bits & ~bit);
  };
  for (int k = 0; k < Overlap::kMost; ++k) {
    using Kind = OverlapCorner::Kind;
    const bool is_one = k < overlap.count;
    const OverlapCorner& corner = overlap.corners[k];
    const bool is_of_a = corner.kind == Kind::of_a, is_of_b = corner.kind == Kind::of_b;
    const bool is_crossing = corner.kind == Kind::crossing;
    set(exists[k], is_one);
    set(of_a[k], is_one && is_of_a);
    set(of_b[k], is_one && is_of_b);
    set(crosses[k], is_one && is_crossing);
    const int a = is_of_a ? corner.behind : corner.edge_a(),
              b = is_of_b ? corner.behind - 3 : corner.edge_b();
    for (int i = 0; i < 3; ++i) {
      set(on_a[k][i], is_one && (is_of_a || is_crossing) && a == i);
      set(on_b[k][i], is_one && (is_of_b || is_crossing) && b == i);
    }
  }
  count = 0;
  while (count < Overlap::kMost && exists[count] != 0) ++count;
}

TrianglePair<double> triangle_pair(const Overlap& of, const Triangle& a, const Triangle& b) {
  TrianglePair<double> p;
  OverlapsInLanes names;
  names.put(0, of);
  for (int k = 0; k < of.count; ++k) {
    p.at_a[k] = of.corners[k].at_a;
    p.at_b[k] = of.corners[k].at_b;
  }
  place_corners(names, a, b, p);
  return p;
}

std::array<Vec<3>, 6> corner_forces(const Overlap& of, const TrianglePair<double>& p,
                                    const PointAreas<double>& areas,
                                    const PointTractions<double>& tractions) {
  OverlapsInLanes names;
  names.put(0, of);
  return corner_forces(names, p, areas, tractions);
}

template struct TrianglePair<double>;
template struct PointAreas<double>;
template void place_corners(const OverlapsInLanes&, const Triangle&, const Triangle&, TrianglePair<double>&);
template std::array<Vec<3>, 6> corner_forces(const OverlapsInLanes&, const TrianglePair<double>&,
                                             const PointAreas<double>&, const PointTractions<double>&);
template std::array<Vec<3>, 2> tangents_of(const Triangle&, const Vec<3>&);

}  // namespace pyroclast
