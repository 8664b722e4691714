#include "pyroclast/specimen/shell.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/convex_hull.hpp"
#include "pyroclast/specimen/outline.hpp"

namespace pyroclast::specimen {
namespace {

/// Cosine of the angle between triangles above which they stand for a curved surface.
const double kCosineOfEdge = std::cos(std::numbers::pi / 6.0);
/// The same of a smooth surface: it has edges only where a side of the body cuts it.
constexpr double kCosineOfCut = 0.5;
/// Least area of a side that has a point, over that of a point.
constexpr double kLeastSide = 0.05;
/// Halvings of the edges of an icosahedron for a curved shape: 1,280 triangles.
constexpr int kHalvingsOfBall = 3;
/// Longest edge of a polyhedron's triangle, over the width: vertices stand for the surface where shells meet.
constexpr double kLongestEdge = 0.2;
/// Trial points of a surface for each point asked for, and rounds in which points move to the middle of their
/// parts.
constexpr int kTrialsOfPoint = 16, kRoundsOfPoints = 4;
/// Area of a point over the square of the distance to the next ones: of a hexagon.
constexpr double kAreaOfPoint = 0.866;
/// Least distance of a point from those of larger sides, in spacings.
constexpr double kApartFromLarger = 0.45;
/// Triangles in a leaf of the tree.
constexpr int kOfLeaf = 4;
/// Harmonics of a drawn shape: from 3 up to this one, each of so many poles.
constexpr int kHighest = 12, kPoles = 8;
/// Least radius of a shape of harmonics, over that of the ellipsoid.
constexpr double kLeastRadius = 0.3;

Vec<3> unit_of(const Vec<3>& v) {
  return v * (1.0 / norm(v));
}

/// Point of a triangle, and the part of it on which the point lies.
struct OnTriangle {
  std::array<double, 3> share;  ///< of the corners
  int part;                     ///< 0: inside; 1 to 3: the edge from that corner on; 4 to 6: a corner
};

/// Returns the point of a triangle that is nearest to a place (C. Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.5).
OnTriangle nearest_on(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  const Vec<3> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {{1.0, 0.0, 0.0}, 4};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return {{0.0, 1.0, 0.0}, 5};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return {{0.0, 0.0, 1.0}, 6};
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double share = d1 / (d1 - d3);
    return {{1.0 - share, share, 0.0}, 1};
  }
  if (of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double share = d2 / (d2 - d6);
    return {{1.0 - share, 0.0, share}, 3};
  }
  if (of_a <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0.0, 1.0 - share, share}, 2};
  }
  const double sum = of_a + of_b + of_c;
  return {{of_a / sum, of_b / sum, of_c / sum}, 0};
}

}  // namespace

/// Triangles around their centroid, and what is worked out of them once.
struct Shell::Mesh {
  /// Box of the tree around triangles that follow one another.
  struct Box {
    Vec<3> low, high;
    int first, count;     ///< triangles in `order` of a leaf; count 0: a branch
    int left, right = 0;  ///< boxes of a branch
  };
  struct Foot {
    int triangle = 0;
    OnTriangle on{};
    double square = std::numeric_limits<double>::infinity();
    Vec<3> at{};
  };

  std::vector<Vec<3>> vertices;
  std::vector<Triangle> triangles;
  std::vector<Vec<3>> normals;                    ///< of triangles
  std::vector<std::array<Vec<3>, 3>> normals_at;  ///< at the corners of triangles, of the curved surface
  std::vector<Vec<3>> normals_of_vertices;        ///< weighted by the angles of triangles
  std::vector<std::array<Vec<3>, 3>> normals_of_edges;  ///< of the edge from each corner on
  std::vector<double> areas;
  std::vector<int> side;  ///< of triangles
  bool is_smooth;
  Vec<3> given_centre{};
  int sides = 1;
  double volume = 0.0, area = 0.0, bounding = 0.0, inner = 0.0;
  std::vector<int> order;
  std::vector<Box> boxes;

  Mesh(std::vector<Vec<3>> at, std::vector<Triangle> of, bool smooth)
      : vertices(std::move(at)), triangles(std::move(of)), is_smooth(smooth) {
    centre();
    find_normals();
    order.resize(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    add_box(0, static_cast<int>(order.size()));
    for (const Vec<3>& v : vertices) bounding = std::max(bounding, norm(v));
    inner = std::max(0.0, -nearest({}).distance);
  }

  const Vec<3>& corner(int triangle, int i) const { return vertices[triangles[triangle][i]]; }

  void centre() {
    Vec<3> moment{};
    double six = 0.0;
    const Vec<3> origin = vertices.empty() ? Vec<3>{} : vertices.front();
    for (const Triangle& t : triangles) {
      const Vec<3> a = vertices[t[0]] - origin, b = vertices[t[1]] - origin, c = vertices[t[2]] - origin;
      const double its = dot(a, cross(b, c));
      six += its;
      moment += 0.25 * its * (a + b + c);
    }
    volume = six / 6.0;
    if (!(volume > 0.0)) throw Error("the surface of a stone holds no volume, or is turned inside out");
    const Vec<3> middle = origin + moment * (1.0 / six);
    for (Vec<3>& v : vertices) v -= middle;
    given_centre = middle;
  }

  void find_normals() {
    std::map<std::pair<int, int>, int> triangle_at;  // by the ends of an edge in its sense
    normals_of_vertices.resize(vertices.size());
    std::vector<std::vector<int>> around(vertices.size());
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
      const Vec<3> doubled = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
      areas.push_back(0.5 * norm(doubled));
      area += areas.back();
      normals.push_back(areas.back() > 0.0 ? unit_of(doubled) : Vec<3>{});
      for (int i = 0; i < 3; ++i) {
        const int from = triangles[t][i], to = triangles[t][(i + 1) % 3];
        if (!triangle_at.emplace(std::pair(from, to), t).second)
          throw Error("two triangles of the surface of a stone walk an edge the same way");
        around[from].push_back(t);
        const Vec<3> on = vertices[to] - vertices[from], back = corner(t, (i + 2) % 3) - vertices[from];
        normals_of_vertices[from] += std::atan2(norm(cross(on, back)), dot(on, back)) * normals[t];
      }
    }
    normals_of_edges.resize(triangles.size());
    normals_at.resize(triangles.size());
    side.assign(triangles.size(), -1);
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      for (int i = 0; i < 3; ++i) {
        const int from = triangles[t][i], to = triangles[t][(i + 1) % 3];
        const auto other = triangle_at.find({to, from});
        if (other == triangle_at.end()) throw Error("the surface of a stone is not closed");
        normals_of_edges[t][i] = normals[t] + normals[other->second];
        for (const int beside : around[from])
          if (!is_edge(beside, t)) normals_at[t][i] += areas[beside] * normals[beside];
      }
    sides = 0;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
      if (side[t] >= 0) continue;
      std::vector<int> open{t};
      side[t] = sides;
      while (!open.empty()) {
        const int here = open.back();
        open.pop_back();
        for (int i = 0; i < 3; ++i) {
          const int next = triangle_at.at({triangles[here][(i + 1) % 3], triangles[here][i]});
          if (side[next] >= 0 || is_edge(next, here)) continue;
          side[next] = sides;
          open.push_back(next);
        }
      }
      ++sides;
    }
  }

  /// Tells whether two triangles meet at an edge; one without an area has none.
  bool is_edge(int a, int b) const {
    return areas[a] > 0.0 && areas[b] > 0.0 &&
           dot(normals[a], normals[b]) <= (is_smooth ? kCosineOfCut : kCosineOfEdge);
  }

  int add_box(int first, int count) {
    Box box{vertices[triangles[order[first]][0]], vertices[triangles[order[first]][0]], first, count, 0};
    for (int i = first; i < first + count; ++i)
      for (const int v : triangles[order[i]])
        for (int d = 0; d < 3; ++d) {
          box.low[d] = std::min(box.low[d], vertices[v][d]);
          box.high[d] = std::max(box.high[d], vertices[v][d]);
        }
    const int number = static_cast<int>(boxes.size());
    boxes.push_back(box);
    if (count <= kOfLeaf) return number;
    const Vec<3> size = box.high - box.low;
    const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const auto middle = [&](int t) { return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis]; };
    const auto begin = order.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](int a, int b) { return std::pair(middle(a), a) < std::pair(middle(b), b); });
    const int left = add_box(first, count / 2), right = add_box(first + count / 2, count - count / 2);
    boxes[number].count = 0;
    boxes[number].left = left;
    boxes[number].right = right;
    return number;
  }

  void look_in(int number, const Vec<3>& place, Foot& foot) const {
    const Box& box = boxes[number];
    for (int i = box.first; i < box.first + box.count; ++i) {
      const int t = order[i];
      const OnTriangle on = nearest_on(place, corner(t, 0), corner(t, 1), corner(t, 2));
      const Vec<3> at = on.share[0] * corner(t, 0) + on.share[1] * corner(t, 1) + on.share[2] * corner(t, 2);
      const Vec<3> away = place - at;
      if (const double square = dot(away, away); square < foot.square) foot = {t, on, square, at};
    }
    if (box.count > 0) return;
    double left = square_to(boxes[box.left], place), right = square_to(boxes[box.right], place);
    int near = box.left, far = box.right;
    if (right < left) {
      std::swap(left, right);
      std::swap(near, far);
    }
    if (left < foot.square) look_in(near, place, foot);
    if (right < foot.square) look_in(far, place, foot);
  }

  static double square_to(const Box& box, const Vec<3>& place) {
    double square = 0.0;
    for (int d = 0; d < 3; ++d) {
      const double out = std::max({box.low[d] - place[d], 0.0, place[d] - box.high[d]});
      square += out * out;
    }
    return square;
  }

  Foot foot_of(const Vec<3>& place) const {
    Foot foot;
    look_in(0, place, foot);
    return foot;
  }

  /// Returns the nearest point; whether a place is inside tells the angle-weighted normal there (Bærentzen
  /// and Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243).
  NearestPoint<3> nearest(const Vec<3>& place) const {
    const Foot foot = foot_of(place);
    const int part = foot.on.part;
    const Vec<3>& normal = part == 0  ? normals[foot.triangle]
                           : part < 4 ? normals_of_edges[foot.triangle][part - 1]
                                      : normals_of_vertices[triangles[foot.triangle][part - 4]];
    const Vec<3> away = place - foot.at;
    const bool inside = dot(away, normal) < 0.0;
    const double distance = std::sqrt(foot.square);
    const Vec<3> out =
        distance > 1e-9 * bounding ? away * ((inside ? -1.0 : 1.0) / distance) : unit_of(normal);
    return {{foot.at, out}, inside ? -distance : distance};
  }

  /// Returns a point of a triangle with the normal of the curved surface.
  SurfacePoint<3> point_on(int t, const std::array<double, 3>& share) const {
    Vec<3> at{}, normal{};
    for (int i = 0; i < 3; ++i) {
      at += share[i] * corner(t, i);
      normal += share[i] * unit_of(normals_at[t][i]);
    }
    return {at, unit_of(normal)};
  }

  /// Returns points spread over triangles by their areas, in a fixed order.
  std::vector<SurfacePoint<3>> trials(const std::vector<int>& of, double whole, int count) const {
    std::vector<SurfacePoint<3>> result;
    double passed = 0.0;
    std::size_t at = 0;
    for (int k = 0; k < count; ++k) {
      const double up_to = whole * (k + 0.5) / count;
      while (at + 1 < of.size() && passed + areas[of[at]] < up_to) passed += areas[of[at++]];
      // the sequence R2 of M. Roberts (2018), after the plastic number
      double u = std::fmod(0.5 + 0.7548776662466927 * k, 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * k, 1.0);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      result.push_back(point_on(of[at], {1.0 - u - v, u, v}));
    }
    return result;
  }
};

namespace {

/// Spreads points over trial points: the farthest in turn, then to the middles of their parts.
/// \param taken  places that count as points, and stay
/// \param scale  factor of lengths beside each trial point
std::vector<std::size_t> spread_over(const std::vector<SurfacePoint<3>>& trials,
                                     std::span<const Vec<3>> taken, std::span<const double> scale,
                                     int count) {
  std::vector<double> square(trials.size(), std::numeric_limits<double>::infinity());
  const auto lower = [&](const Vec<3>& place) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const Vec<3> away = trials[i].at - place;
      square[i] = std::min(square[i], dot(away, away) * scale[i]);
    }
  };
  for (const Vec<3>& place : taken) lower(place);
  std::vector<std::size_t> chosen;
  while (static_cast<int>(chosen.size()) < count) {
    const auto next = static_cast<std::size_t>(std::ranges::max_element(square) - square.begin());
    if (!(square[next] > 0.0)) break;
    chosen.push_back(next);
    lower(trials[next].at);
  }
  std::vector<Vec<3>> places;
  for (int round = 0; round < kRoundsOfPoints; ++round) {
    places.assign(taken.begin(), taken.end());
    for (const std::size_t i : chosen) places.push_back(trials[i].at);
    std::vector<Vec<3>> sum(places.size());
    std::vector<double> weight(places.size());
    std::vector<std::size_t> owner(trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Vec<3> away = trials[i].at - places[k];
        if (const double its = dot(away, away); its < least) {
          least = its;
          owner[i] = k;
        }
      }
      sum[owner[i]] += scale[i] * trials[i].at;
      weight[owner[i]] += scale[i];
    }
    std::vector<double> nearest(places.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const std::size_t k = owner[i];
      if (k < taken.size()) continue;
      const Vec<3> away = trials[i].at - sum[k] * (1.0 / weight[k]);
      if (const double its = dot(away, away); its < nearest[k]) {
        nearest[k] = its;
        chosen[k - taken.size()] = i;
      }
    }
  }
  return chosen;
}

}  // namespace

Shell::Shell(std::vector<Vec<3>> vertices, std::vector<Triangle> triangles, bool is_smooth)
    : mesh_(std::make_shared<const Mesh>(std::move(vertices), std::move(triangles), is_smooth)) {}

NearestPoint<3> Shell::nearest(const Vec<3>& place) const {
  NearestPoint<3> found = mesh_->nearest(place * (1.0 / factor_));
  found.point.at *= factor_;
  found.distance *= factor_;
  return found;
}

double Shell::bounding_radius() const {
  return factor_ * mesh_->bounding;
}

double Shell::inner_radius() const {
  return factor_ * mesh_->inner;
}

double Shell::extent() const {
  return factor_ * factor_ * factor_ * mesh_->volume;
}

double Shell::size() const {
  return factor_ * factor_ * mesh_->area;
}

int Shell::corner_count() const {
  return mesh_->sides > 1 ? mesh_->sides : 0;
}

std::shared_ptr<const Surface<3>> Shell::scaled(double factor) const {
  return std::shared_ptr<const Surface<3>>(new Shell(mesh_, factor * factor_));
}

std::vector<Vec<3>> Shell::vertices() const {
  std::vector<Vec<3>> result = mesh_->vertices;
  for (Vec<3>& v : result) v *= factor_;
  return result;
}

const std::vector<Shell::Triangle>& Shell::triangles() const {
  return mesh_->triangles;
}

std::vector<SurfacePoint<3>> Shell::points(double spacing, std::span<const Vec<3>> taken,
                                           const Relative& relative) const {
  const double of_point = kAreaOfPoint * spacing * spacing / (factor_ * factor_);
  std::vector<std::vector<int>> sides(mesh_->sides);
  std::vector<double> area(sides.size());
  for (int t = 0; t < static_cast<int>(mesh_->triangles.size()); ++t) {
    sides[mesh_->side[t]].push_back(t);
    area[mesh_->side[t]] += mesh_->areas[t];
  }
  std::vector<int> order(sides.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int i) { return area[i]; });
  std::vector<std::vector<Vec<3>>> taken_on(sides.size());
  for (const Vec<3>& place : taken) {
    const auto foot = mesh_->foot_of(place * (1.0 / factor_));
    taken_on[mesh_->side[foot.triangle]].push_back(foot.at);
  }
  std::vector<SurfacePoint<3>> points;
  for (const int number : order) {
    double parts = area[number] / of_point;
    if (parts < kLeastSide && sides.size() > 1) continue;
    if (relative) {
      const auto few = mesh_->trials(sides[number], area[number], kTrialsOfPoint);
      double mean = 0.0;
      for (const auto& trial : few) {
        const double its = relative(factor_ * trial.at);
        mean += 1.0 / (its * its) / kTrialsOfPoint;
      }
      parts *= mean;
    }
    const int all = std::max(sides.size() == 1 ? 4 : 1, static_cast<int>(std::lround(parts)));
    const int count = all - static_cast<int>(taken_on[number].size());
    if (count <= 0) continue;
    const auto trials = mesh_->trials(sides[number], area[number], kTrialsOfPoint * all);
    std::vector<double> scale(trials.size(), 1.0);
    if (relative)
      for (std::size_t i = 0; i < trials.size(); ++i) {
        const double its = relative(factor_ * trials[i].at);
        scale[i] = 1.0 / (its * its);
      }
    const std::size_t of_larger = points.size();
    for (const std::size_t i : spread_over(trials, taken_on[number], scale, count)) {
      const SurfacePoint<3> point{factor_ * trials[i].at, trials[i].normal};
      const double apart = kApartFromLarger * spacing * (relative ? relative(point.at) : 1.0);
      if (std::none_of(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(of_larger),
                       [&](const auto& other) { return norm(other.at - point.at) < apart; }))
        points.push_back(point);
    }
  }
  return points;
}

double Shell::width() const {
  return width_across(
      *std::ranges::max_element(mesh_->vertices, {}, [](const Vec<3>& v) { return dot(v, v); }));
}

bool Shell::is_smooth() const {
  return mesh_->is_smooth;
}

const Vec<3>& Shell::given_centre() const {
  return mesh_->given_centre;
}

bool Shell::has_vertex_closer(const Shell& other, const Vec<3>& from, double gap) const {
  return has_vertex_closer(0, other, from, gap);
}

/// Tells the same of the vertices of a box of the tree. The distance from a surface changes by no more than
/// the way, so that of the middle bounds all.
bool Shell::has_vertex_closer(int number, const Shell& other, const Vec<3>& from, double gap) const {
  const Mesh::Box& box = mesh_->boxes[number];
  const Vec<3> middle = from + (0.5 * factor_) * (box.low + box.high);
  const double half = 0.5 * factor_ * norm(box.high - box.low);
  if (norm(middle) - half >= other.bounding_radius() + gap) return false;
  const double distance = other.nearest(middle).distance;
  if (distance - half >= gap) return false;
  if (distance + half < gap) return true;
  if (box.count == 0)
    return has_vertex_closer(box.left, other, from, gap) || has_vertex_closer(box.right, other, from, gap);
  for (int i = box.first; i < box.first + box.count; ++i)
    for (const int v : mesh_->triangles[mesh_->order[i]])
      if (other.nearest(from + factor_ * mesh_->vertices[v]).distance < gap) return true;
  return false;
}

NearestPoint<3> Shell::approach_of_vertices(const Shell& other, const Vec<3>& from) const {
  NearestPoint<3> least{{}, std::numeric_limits<double>::infinity()};
  find_approach(0, other, from, least);
  return least;
}

/// Finds the same among the vertices of a box of the tree, by the same bound.
void Shell::find_approach(int number, const Shell& other, const Vec<3>& from, NearestPoint<3>& least) const {
  const Mesh::Box& box = mesh_->boxes[number];
  const Vec<3> middle = from + (0.5 * factor_) * (box.low + box.high);
  const double half = 0.5 * factor_ * norm(box.high - box.low);
  if (norm(middle) - half - other.bounding_radius() >= least.distance ||
      other.nearest(middle).distance - half >= least.distance)
    return;
  if (box.count == 0) {
    const auto away = [&](int child) {
      return norm(from + (0.5 * factor_) * (mesh_->boxes[child].low + mesh_->boxes[child].high));
    };
    const bool is_left_nearer = away(box.left) <= away(box.right);
    find_approach(is_left_nearer ? box.left : box.right, other, from, least);
    find_approach(is_left_nearer ? box.right : box.left, other, from, least);
    return;
  }
  for (int i = box.first; i < box.first + box.count; ++i)
    for (const int v : mesh_->triangles[mesh_->order[i]])
      if (const auto near = other.nearest(from + factor_ * mesh_->vertices[v]);
          near.distance < least.distance)
        least = near;
}

double Shell::width_across(const Vec<3>& axis) const {
  constexpr int kDirections = 36;
  const Vec<3> along = unit_of(axis);
  Vec<3> any{};
  any[std::abs(along[0]) < 0.8 ? 0 : 1] = 1.0;
  const Vec<3> first = unit_of(cross(along, any)), second = cross(along, first);
  double width = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    const Vec<3> across = std::cos(angle) * first + std::sin(angle) * second;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec<3>& v : mesh_->vertices) {
      low = std::min(low, dot(v, across));
      high = std::max(high, dot(v, across));
    }
    width = std::max(width, high - low);
  }
  return factor_ * width;
}

template <>
std::vector<SurfacePoint<3>> Ball<3>::points(double spacing, std::span<const Vec<3>> taken,
                                             const Relative& relative) const {
  const auto number = [&](double area) {
    return std::max(4, static_cast<int>(std::lround(area / (kAreaOfPoint * spacing * spacing))));
  };
  std::vector<SurfacePoint<3>> trials;
  std::vector<double> scale;
  const auto make_trials = [&](int count) {
    trials.clear();
    scale.clear();
    for (const Vec<3>& at : points_of_ball(count, radius_)) {
      trials.push_back({at, at * (1.0 / radius_)});
      const double its = relative ? relative(at) : 1.0;
      scale.push_back(1.0 / (its * its));
    }
  };
  const int even = number(size());
  make_trials(kTrialsOfPoint * even);
  int count = even;
  if (relative) {
    double sum = 0.0;
    for (const double its : scale) sum += its;
    count = number(size() * sum / static_cast<double>(scale.size()));
    make_trials(kTrialsOfPoint * count);
  }
  count -= static_cast<int>(taken.size());
  std::vector<SurfacePoint<3>> points;
  for (const std::size_t i : spread_over(trials, taken, scale, count)) points.push_back(trials[i]);
  return points;
}

namespace {

/// Vertices and triangles of a surface.
struct Triangulated {
  std::vector<Vec<3>> vertices;
  std::vector<Shell::Triangle> triangles;

  /// Cuts each triangle into four at the middles of its edges.
  void halve() {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
      if (is_new) vertices.push_back(0.5 * (vertices[a] + vertices[b]));
      return at->second;
    };
    std::vector<Shell::Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Shell::Triangle& t : {Shell::Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(t);
    }
    triangles = std::move(finer);
  }

  double longest_edge() const {
    double longest = 0.0;
    for (const auto& t : triangles)
      for (int i = 0; i < 3; ++i)
        longest = std::max(longest, norm(vertices[t[i]] - vertices[t[(i + 1) % 3]]));
    return longest;
  }
};

/// Returns the surface of a convex polyhedron whose faces are triangles.
Triangulated triangulated(const ConvexPolyhedron& solid) {
  Triangulated surface{solid.corners, {}};
  for (const auto& face : solid.faces) surface.triangles.push_back({face[0], face[1], face[2]});
  return surface;
}

/// Returns a ball of radius 1 of triangles that are nearly alike.
Triangulated ball_of_triangles() {
  Triangulated ball = triangulated(icosahedron());
  for (int i = 0; i < kHalvingsOfBall; ++i) {
    ball.halve();
    for (Vec<3>& v : ball.vertices) v = unit_of(v);
  }
  return ball;
}

/// Rotation of space that is drawn at random.
class Turn {
 public:
  explicit Turn(Random& random) {
    // K. Shoemake, Uniform random rotations, Graphics Gems III, 1992
    const double share = random.uniform(), first = 2.0 * std::numbers::pi * random.uniform(),
                 second = 2.0 * std::numbers::pi * random.uniform();
    const double a = std::sqrt(1.0 - share), b = std::sqrt(share);
    vector_ = {{a * std::sin(first), a * std::cos(first), b * std::sin(second)}};
    scalar_ = b * std::cos(second);
  }
  Vec<3> operator()(const Vec<3>& v) const {
    const Vec<3> across = 2.0 * cross(vector_, v);
    return v + scalar_ * across + cross(vector_, across);
  }

 private:
  Vec<3> vector_;
  double scalar_;
};

Vec<3> direction(Random& random) {
  const double z = random.uniform(-1.0, 1.0), angle = 2.0 * std::numbers::pi * random.uniform();
  const double around = std::sqrt(1.0 - z * z);
  return {{around * std::cos(angle), around * std::sin(angle), z}};
}

/// Adds spherical harmonics to a ball: of each degree n the Legendre polynomials of some poles, in the root
/// mean square as large as D_n cos(n angle) of the plane.
void add_harmonics(double roughness, double decay, Random& random, std::vector<Vec<3>>& vertices) {
  std::vector<double> radius(vertices.size(), 1.0);
  for (int n = 3; n <= kHighest; ++n)
    for (int pole = 0; pole < kPoles; ++pole) {
      const Vec<3> at = direction(random);
      const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
      const double size =
          sign * roughness * std::pow(n / 3.0, -decay) * std::sqrt((2 * n + 1) / (2.0 * kPoles));
      for (std::size_t v = 0; v < vertices.size(); ++v) {
        const double x = dot(at, vertices[v]);
        double before = 1.0, here = x;
        for (int k = 2; k <= n; ++k)
          before = std::exchange(here, ((2 * k - 1) * x * here - (k - 1) * before) / k);
        radius[v] += size * here;
      }
    }
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] *= std::max(radius[v], kLeastRadius);
}

}  // namespace

std::vector<Vec<3>> points_of_ball(int count, double radius) {
  std::vector<Vec<3>> points;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, around = std::sqrt(1.0 - z * z);
    points.push_back(radius * Vec<3>{{around * std::cos(golden * i), around * std::sin(golden * i), z}});
  }
  return points;
}

Shell ball_of_shell(double radius) {
  Triangulated ball = ball_of_triangles();
  for (Vec<3>& v : ball.vertices) v *= radius;
  return {std::move(ball.vertices), std::move(ball.triangles), true};
}

std::shared_ptr<const Shell> draw_shell(const ShapeParameters& p, Random& random) {
  if (p.kind == StoneShape::circle) return nullptr;
  const double elongation = random.uniform(p.elongation.low, p.elongation.high);
  const double flatness = random.uniform(p.flatness.low, p.flatness.high);
  const Turn turn(random);
  Triangulated drawn;
  if (p.kind == StoneShape::polygon) {
    const int count = static_cast<int>(random.uniform(p.corners.low, p.corners.high + 1.0));
    std::vector<Vec<3>> corners = points_of_ball(count, 1.0);
    const double off = 1.0 / std::sqrt(static_cast<double>(count));
    for (Vec<3>& corner : corners) {
      const double way = off * random.uniform();
      corner = unit_of(corner + way * direction(random));
    }
    drawn = triangulated({corners, convex_hull(corners)});
  } else {
    drawn = ball_of_triangles();
    if (p.kind == StoneShape::harmonics)
      add_harmonics(random.uniform(p.roughness.low, p.roughness.high), p.decay, random, drawn.vertices);
  }
  for (Vec<3>& v : drawn.vertices) v = turn({{v[0] * elongation, v[1], v[2] / flatness}});
  if (p.kind == StoneShape::polygon)
    while (drawn.longest_edge() > 2.0 * kLongestEdge) drawn.halve();
  const Shell shell(std::move(drawn.vertices), std::move(drawn.triangles), p.kind != StoneShape::polygon);
  const double width = shell.width_across(turn({{1.0, 0.0, 0.0}}));
  return std::static_pointer_cast<const Shell>(shell.scaled(1.0 / width));
}

}  // namespace pyroclast::specimen
