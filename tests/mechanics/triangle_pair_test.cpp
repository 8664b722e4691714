#include "pyroclast/mechanics/found/triangle_pair.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gradient.hpp"
#include "pyroclast/base/lanes.hpp"
#include "pyroclast/base/random.hpp"

namespace pyroclast::triangles {
namespace {

using Corners = std::array<Vec<3>, 6>;  // of a, then of b
using Pair = TrianglePair<double>;
using Areas = PointAreas<double>;

/// Law and pair of the tests: springs, and what makes of an overlap the area that counts.
struct Springs {
  double normal = 3.0, shear = 2.0;  // Pa/m
  double ratio = 0.8, not_counted = 0.02, most_depth = 1.2;
};

struct Pressed {
  Overlap overlap;
  Pair pair;
  Areas areas;
};

Triangle first_of(const Corners& x) {
  return {x[0], x[1], x[2]};
}
Triangle second_of(const Corners& x) {
  return {x[3], x[4], x[5]};
}

Pressed pressed(const Corners& x, const Springs& s) {
  const Overlap overlap = overlap_of(first_of(x), second_of(x));
  const auto pair = triangle_pair(overlap, first_of(x), second_of(x));
  return {overlap, pair, Areas(overlap.count, pair, s.ratio, s.not_counted, s.most_depth, pair.gap)};
}

PointTractions<double> tractions_of(const Pressed& p, const Springs& s) {
  PointTractions<double> t;
  for (int k = 0; k < p.overlap.count; ++k) {
    const double gap = std::min(p.pair.gap[k], 0.0);
    t.normal[k] = s.normal * gap;
    t.stored[k] = 0.5 * s.normal * gap * gap;
  }
  return t;
}

double energy_of(const Pressed& p, const Springs& s) {
  const auto t = tractions_of(p, s);
  double energy = 0.0;
  for (int k = 0; k < p.overlap.count; ++k) energy += p.areas.area[k] * t.stored[k];
  return energy;
}
double energy(const Corners& x, const Springs& s) {
  return energy_of(pressed(x, s), s);
}
Corners forces_of(const Pressed& p, const Springs& s) {
  return corner_forces(p.overlap, p.pair, p.areas, tractions_of(p, s));
}

/// Sums of forces and moments over the largest force.
double out_of_balance(const Corners& x, const Corners& forces) {
  Vec<3> sum{}, moment{};
  double largest = 1.0;
  for (int i = 0; i < 6; ++i) {
    largest = std::max(largest, norm(forces[i]));
    sum += forces[i];
    moment += cross(x[i], forces[i]);
  }
  return std::max(norm(sum), norm(moment)) / largest;
}

constexpr double kGradientStep = 5e-5;  // m

Vec<3> within(Random& random, double x, double y, double z) {
  return {{random.uniform(-x, x), random.uniform(-y, y), random.uniform(-z, z)}};
}

/// Two triangles of any shape, place and tilt, b with its middle `depth` below that of a.
Corners random_corners(Random& random, double depth, double rise) {
  const double turn = random.uniform(-3.0, 3.0);
  const Vec<3> move = within(random, 0.7, 0.7, 0.0);
  Corners x;
  for (int i = 0; i < 3; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 3.0 + random.uniform(-0.6, 0.6);
    const double u = t + turn + random.uniform(-0.3, 0.3);
    x[i] = {{std::cos(t), std::sin(t), random.uniform(-rise, rise)}};
    x[3 + i] = Vec<3>{{0.8 * std::cos(u), 0.8 * std::sin(u), random.uniform(-rise, rise) - depth}} + move;
  }
  return x;
}

/// Tells whether the energy has a kink within the reach of the differences: where a point begins to press,
/// where shares begin or end to fall, and where corners come and go.
bool is_at_kink(const Pressed& p, const Springs& s) {
  const auto& pair = p.pair;
  bool kink = std::abs(std::sqrt(std::max(p.areas.counted, 0.0)) - s.most_depth / 3.0) < 2e-3;
  for (int k = 0; k < p.overlap.count; ++k) {
    const int next = (k + 1) % p.overlap.count;
    const double depth = p.areas.points[k].depth;
    kink = kink || std::abs(pair.gap[k]) < 1e-3 || std::abs(depth - 1.0) < 0.02 ||
           std::abs(depth - 3.0) < 0.02 || norm(pair.place[next] - pair.place[k]) < 0.01 ||
           p.overlap.corners[k].has_fixed_place() || std::abs(pair.upright[k] - Overlap::kSteepest) < 0.005 ||
           std::abs(pair.upright[k] - Overlap::kUpright) < 0.005;
    for (const auto& weights : {pair.at_a[k], pair.at_b[k]})
      for (const double weight : weights) kink = kink || (weight != 0.0 && weight < 0.005);
  }
  return kink;
}

/// Calls `f(corners, pressed)` for random pairs at no kink. Returns the number of pairs of each number of
/// corners.
template <class F>
std::array<int, Overlap::kMost + 1> for_random_pairs(int pairs, F f) {
  Random random(1);
  std::array<int, Overlap::kMost + 1> counts{};
  for (int taken = 0; taken < pairs;) {
    const Springs s{.not_counted = taken % 2 == 0 ? 0.02 : 0.0, .most_depth = taken % 3 == 0 ? 1.2 : 9.0};
    const double rise = taken % 4 == 3 ? 5.0 : 0.3;  // edges of tilted triangles cross steeply
    const Corners x = random_corners(random, random.uniform(-0.1, 0.6), rise);
    const Pressed p = pressed(x, s);
    if (p.overlap.count == 0 || p.pair.overlap < 0.05 || is_at_kink(p, s)) continue;
    ++taken;
    ++counts[p.overlap.count];
    f(x, p, s);
  }
  return counts;
}

// Promise: forces are minus the exact gradient, and balanced in forces and moments, with shear too.
TEST(TrianglePairVerification, ForcesAreTheGradientOfTheirEnergy) {
  double worst = 0.0, balance = 0.0, with_shear = 0.0;
  Random random(2);
  int pairs = 0;
  const auto counts = for_random_pairs(20000, [&](const Corners& x, const Pressed& p, const Springs& s) {
    const Corners forces = forces_of(p, s);
    const std::vector<int> corners{pairs % 3, 3 + pairs % 3};  // all of them take too long
    ++pairs;
    worst = std::max(worst,
                     gradient_error(
                         kGradientStep, x, forces, [&](const Corners& y) { return energy(y, s); }, corners));
    balance = std::max(balance, out_of_balance(x, forces));
    auto tractions = tractions_of(p, s);
    for (int k = 0; k < p.overlap.count; ++k) {
      const Vec<3> any = within(random, 1.0, 1.0, 1.0);
      tractions.shear[k] = any - p.pair.normal * dot(any, p.pair.normal);
    }
    with_shear =
        std::max(with_shear, out_of_balance(x, corner_forces(p.overlap, p.pair, p.areas, tractions)));
  });
  for (int corners = 3; corners <= Overlap::kMost; ++corners) EXPECT_GT(counts[corners], 500) << corners;
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(balance, 1e-14);
  EXPECT_LT(with_shear, 1e-14);
}

/// Returns the forces of eight pairs that go side by side, under springs.
std::array<Corners, kLanes> forces_in_lanes(const std::array<Corners, kLanes>& pairs,
                                            const std::array<Springs, kLanes>& springs) {
  using Real = Lanes<Portable>;
  const auto line = [](auto number_of) {
    Line numbers;
    for (int lane = 0; lane < kLanes; ++lane) numbers.number[lane] = number_of(lane);
    return Real::load(numbers.number);
  };
  std::array<Vec<3, Real>, 6> at;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) at[i][j] = line([&](int lane) { return pairs[lane][i][j]; });
  OverlapsInLanes names;
  for (int lane = 0; lane < kLanes; ++lane)
    names.put(lane, overlap_of(first_of(pairs[lane]), second_of(pairs[lane])));
  TrianglePair<Real> p;
  place_corners<Real>(names, {at[0], at[1], at[2]}, {at[3], at[4], at[5]}, p);
  const PointAreas<Real> areas(names.count, p, line([&](int lane) { return springs[lane].ratio; }),
                               line([&](int lane) { return springs[lane].not_counted; }),
                               line([&](int lane) { return springs[lane].most_depth; }), p.gap);
  PointTractions<Real> t;
  for (int k = 0; k < names.count; ++k) {
    const Real gap = smaller(p.gap[k], Real(0.0));
    t.normal[k] = line([&](int lane) { return springs[lane].normal; }) * gap;
    t.stored[k] = Real(0.5) * line([&](int lane) { return springs[lane].normal; }) * gap * gap;
  }
  const auto f = corner_forces(names, p, areas, t);
  std::array<Corners, kLanes> forces;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      Line numbers;
      f[i][j].store(numbers.number);
      for (int lane = 0; lane < kLanes; ++lane) forces[lane][i][j] = numbers.number[lane];
    }
  return forces;
}

// Promise: pairs that go side by side have the forces that each has alone, to the bit, whatever corners the
// overlaps beside them have.
TEST(TrianglePair, EightSideBySideAreAsEachAlone) {
  std::array<Corners, kLanes> pairs{}, alone{};
  std::array<Springs, kLanes> springs{};
  int taken = 0, compared = 0;
  for_random_pairs(800, [&](const Corners& x, const Pressed& p, const Springs& s) {
    const int lane = taken++ % kLanes;
    pairs[lane] = x;
    springs[lane] = s;
    alone[lane] = forces_of(p, s);
    if (lane + 1 < kLanes) return;
    const auto beside = forces_in_lanes(pairs, springs);
    for (int other = 0; other < kLanes; ++other, ++compared)
      EXPECT_TRUE(beside[other] == alone[other]) << "pair " << compared;
  });
  EXPECT_EQ(compared, 800);
}

// Promise: the shear does work along the change of the places on both triangles: along the relative motion at
// fixed weights, less the part by which the normal turns.
TEST(TrianglePairVerification, ShearWorksAlongTheSlide) {
  double worst = 0.0;
  for_random_pairs(1000, [&](const Corners& x, const Pressed& p, const Springs&) {
    const Vec<3> traction = p.pair.normal * -0.3 + Vec<3>{{0.4, -0.2, 0.1}};
    PointTractions<double> t;
    for (int k = 0; k < p.overlap.count; ++k)
      t.shear[k] = traction - p.pair.normal * dot(traction, p.pair.normal);
    const Corners forces = corner_forces(p.overlap, p.pair, p.areas, t);
    worst = std::max(worst, gradient_error(kGradientStep, x, forces, [&](const Corners& y) {
                       const auto now = triangle_pair(p.overlap, first_of(y), second_of(y));
                       double work = 0.0;
                       for (int k = 0; k < p.overlap.count; ++k) {
                         const Vec<3> apart = Pair::mixed(second_of(y), p.pair.at_b[k]) -
                                              Pair::mixed(first_of(y), p.pair.at_a[k]);
                         work += p.areas.area[k] * dot(t.shear[k], apart - now.normal * p.pair.gap[k]);
                       }
                       return work;
                     }));
  });
  EXPECT_LT(worst, 1e-9);
}

// Promise: no part of the forces is idle. Each one left out breaks the gradient that the test above measures.
TEST(TrianglePairVerification, EveryPartOfTheForcesIsNeeded) {
  struct Fault {
    const char* what;
    std::function<void(Pressed&)> leave_out;
  };
  const std::vector<Fault> faults{
      {"square of the cosine", [](auto& p) { p.areas.ratio /= p.pair.cosine, p.pair.cosine = 1.0; }},
      {"shares",
       [](auto& p) {
         for (auto& point : p.areas.points) point.share = 1.0;
       }},
      {"derivatives of the shares",
       [](auto& p) {
         for (auto& point : p.areas.points) point.slope = 0.0;
       }},
      {"largest depth", [](auto& p) { p.areas.is_wide = false; }},
      {"outline of the overlap", [](auto& p) { p.pair.outline = std::numeric_limits<double>::infinity(); }},
      {"share of steep edges",
       [](auto& p) {
         for (double& share : p.areas.upright)
           if (share > 0.0) share = 1.0;
       }},
      {"derivative of the share of steep edges", [](auto& p) { p.areas.upright_slope.fill(0.0); }},
      {"overlap of the beginning", [](auto& p) { p.areas.counted = p.pair.overlap; }},
      {"derivative of the share of the overlap that counts", [](auto& p) { p.areas.not_counted = 0.0; }},
      {"ratio of areas", [](auto& p) { p.areas.ratio = 1.0; }},
      {"turning of the mean plane", [](auto& p) { p.pair.size = std::numeric_limits<double>::infinity(); }},
      {"slope of what a corner meets", [](auto& p) { p.pair.gap_slope.fill(p.pair.normal); }},
      {"middle of the overlap", [](auto& p) { p.pair.middle = {}; }},
      {"places of crossings", [](auto& p) {
         for (auto& corner : p.overlap.corners)
           if (corner.kind == OverlapCorner::Kind::crossing) corner.kind = OverlapCorner::Kind::fixed;
       }}};
  for (const Fault& fault : faults) {
    double worst = 0.0;
    for_random_pairs(200, [&](const Corners& x, Pressed p, const Springs& s) {
      fault.leave_out(p);
      const Corners forces = corner_forces(p.overlap, p.pair, p.areas, tractions_of(p, s));
      worst = std::max(
          worst, gradient_error(kGradientStep, x, forces, [&](const Corners& y) { return energy(y, s); }));
    });
    EXPECT_GT(worst, 1e-3) << fault.what;
  }
}

/// Work of the forces along a way, and energies on it.
struct Way {
  double first = 0.0, last = 0.0, most = 0.0;   // energies
  double work = 0.0;                            // by the trapezoidal rule
  double smooth_step = 0.0, change_step = 0.0;  // largest changes of energy in a step
  int changes = 0;                              // steps in which corners come or go
};

bool same_corners(const Overlap& a, const Overlap& b) {
  bool same = a.count == b.count;
  for (int k = 0; same && k < a.count; ++k)
    same = a.corners[k].before == b.corners[k].before && a.corners[k].behind == b.corners[k].behind;
  return same;
}

/// Goes from corners along a straight way.
void go(Corners x, const Corners& way, int steps, const Springs& s, Way& result) {
  Pressed before{{}, {}, Areas({}, {}, 1.0, 0.0, 1.0, {})};
  Corners forces_before{};
  double energy_before = 0.0;
  for (int step = 0; step <= steps; ++step) {
    const Pressed now = pressed(x, s);
    const double energy = now.overlap.count > 0 ? energy_of(now, s) : 0.0;
    const Corners forces = now.overlap.count > 0 ? forces_of(now, s) : Corners{};
    if (step == 0) result.first = energy;
    if (step > 0) {
      for (int i = 0; i < 6; ++i) result.work += 0.5 / steps * dot(forces[i] + forces_before[i], way[i]);
      const bool same = same_corners(now.overlap, before.overlap);
      double& most = same ? result.smooth_step : result.change_step;
      most = std::max(most, std::abs(energy - energy_before));
      result.changes += same ? 0 : 1;
    }
    result.most = std::max(result.most, energy);
    result.last = energy_before = energy;
    forces_before = forces;
    before = now;
    for (int i = 0; i < 6; ++i) x[i] += way[i] * (1.0 / steps);
  }
}

// Promise: corners of the overlap that come and go change the energy no more than smooth steps do, and
// triangles that pass each other give back all energy that they take.
TEST(TrianglePairVerification, CornersComeAndGoWithoutAJump) {
  constexpr double kDepth = 0.01;
  const Springs s{.ratio = 1.0, .not_counted = 0.0, .most_depth = 9.0};
  Random random(7);
  double smooth = 0.0, change = 0.0, worst = 0.0, most = 0.0;
  int changes = 0;
  for (int path = 0; path < 30; ++path) {
    Corners x = random_corners(random, kDepth * random.uniform(0.5, 1.5), kDepth), way;
    const Vec<3> slide = within(random, 2.0, 2.0, 0.0);
    for (int i = 0; i < 6; ++i) {
      way[i] = within(random, 0.6, 0.6, kDepth);
      if (i >= 3) way[i] += slide;
      x[i] -= way[i] * 0.5;
    }
    Way result;
    go(x, way, 4000, s, result);
    smooth = std::max(smooth, result.smooth_step);
    change = std::max(change, result.change_step);
    changes += result.changes;
    most = std::max(most, result.most);
    worst = std::max(worst, std::abs(result.work + result.last - result.first));
  }
  EXPECT_GT(changes, 60);
  EXPECT_LT(change, 1.05 * smooth);
  EXPECT_LT(worst, 1e-3 * most);  // of the trapezoidal rule, where forces step
}

// Promise: two triangles at one place are a joined triangle, with a third of it at each corner, whatever
// rounding says of their edges; moments balance.
TEST(TrianglePair, CoincidingTrianglesAreAFaceWithThreePoints) {
  const Springs s{.ratio = 1.0, .not_counted = 0.0, .most_depth = 1e3};
  Random random(3);
  for (int pair = 0; pair < 2000; ++pair) {
    Corners x;
    const double tilt_x = random.uniform(-2e-3, 2e-3), tilt_y = random.uniform(-2e-3, 2e-3);
    for (int i = 0; i < 3; ++i) {
      const double t = 2.0 * std::numbers::pi * i / 3.0 + random.uniform(-0.5, 0.5);
      x[i] = {{std::cos(t), std::sin(t), 0.0}};
      x[3 + i] = x[i] + Vec<3>{{0.0, 0.0, tilt_x * x[i][0] + tilt_y * x[i][1] - 0.01}};
    }
    const Pressed p = pressed(x, s);
    const Corners forces = forces_of(p, s);
    const double third = p.pair.size_a / 3.0;
    double resultant = 0.0, worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double force = s.normal * third * (x[3 + i][2] - x[i][2]);
      resultant += force;
      worst = std::max(worst, std::abs(forces[i][2] - force));
    }
    EXPECT_LT(worst, 1e-3 * std::abs(resultant));
    EXPECT_LT(out_of_balance(x, forces), 1e-14);
  }
}

/// Two triangles with parallel sides, of which one is turned by an angle and slid.
Corners parallel_corners(double angle, const Vec<3>& slide) {
  const Triangle corners{Vec<3>{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
  Corners x;
  for (int i = 0; i < 3; ++i) {
    const Vec<3>& c = corners[i];
    x[i] = c;
    x[3 + i] = Vec<3>{{std::cos(angle) * c[0] - std::sin(angle) * c[1],
                       std::sin(angle) * c[0] + std::cos(angle) * c[1], -0.01 + 0.001 * c[0]}} +
               slide;
  }
  return x;
}

// Promise: triangles whose edges are parallel, or nearly so, give back all energy that they take, and their
// forces are in balance. Where they turn through the angle at which crossings begin to count, the energy
// steps by what lies between the edges.
TEST(TrianglePairVerification, ParallelEdgesKeepTheEnergy) {
  const Springs s{.ratio = 1.0, .not_counted = 0.0, .most_depth = 9.0};
  const auto error = [&](const Corners& from, const Corners& to) {
    Corners way;
    for (int i = 0; i < 6; ++i) way[i] = to[i] - from[i];
    Way result;
    go(from, way, 6000, s, result);
    return std::abs(result.work + result.last - result.first) / result.most;
  };
  for (const double angle : {0.0, 1e-6, 1e-4, 1e-2}) {
    for (const Vec<3>& slide : {Vec<3>{{0.3, 0, 0}}, Vec<3>{{0, 0.3, 0}}, Vec<3>{{0.2, 0.1, 0.001}}})
      EXPECT_LT(error(parallel_corners(angle, slide * -1.0), parallel_corners(angle, slide)), 2e-4)
          << angle;  // of the trapezoidal rule, where forces step
    const Corners x = parallel_corners(angle, {{1e-9, 1e-9, 0.0}});
    const Pressed p = pressed(x, s);
    EXPECT_LT(out_of_balance(x, forces_of(p, s)), 1e-14) << angle;
  }
  for (const double x : {0.0, 0.01, 0.1})
    EXPECT_LT(
        error(parallel_corners(-2e-3, {{x, 0.5 * x, 0.0}}), parallel_corners(2e-3, {{x, 0.5 * x, 0.0}})),
        1e-3)
        << x;
}

// Promise: where two edges cross, crossings alone press, along the common perpendicular of the edges.
TEST(TrianglePair, CrossedEdgesPressAtTheirCrossing) {
  const double depth = 1e-3;
  // two wedges, the edge of the lower one along x and that of the upper one along y
  const Vec<3> low{{-1, 0, 0}}, high{{1, 0, 0}};
  const Vec<3> begin{{0, -1, -depth}}, end{{0, 1, -depth}};
  double crossing = 0.0, others = 0.0;
  Vec<3> total{};
  for (const double side_a : {-1.0, 1.0})
    for (const double side_b : {-1.0, 1.0}) {
      Corners x;
      x[0] = side_a < 0.0 ? low : high;
      x[1] = side_a < 0.0 ? high : low;
      x[2] = {{0, side_a * -1.0, -1.0}};
      x[3] = side_b < 0.0 ? end : begin;
      x[4] = side_b < 0.0 ? begin : end;
      x[5] = {{side_b * -1.0, 0, 1.0 - depth}};
      if (cross(x[1] - x[0], x[2] - x[0])[2] < 0.0) std::swap(x[0], x[1]);
      if (cross(x[4] - x[3], x[5] - x[3])[2] < 0.0) std::swap(x[3], x[4]);
      const Springs s{.ratio = 1.0, .not_counted = 0.0, .most_depth = 9.0};
      const Pressed p = pressed(x, s);
      const auto tractions = tractions_of(p, s);
      for (int k = 0; k < p.overlap.count; ++k)
        (p.overlap.corners[k].kind == OverlapCorner::Kind::crossing ? crossing : others) -=
            tractions.normal[k] * p.areas.area[k];
      for (int i = 0; i < 3; ++i) total += forces_of(p, s)[i];
    }
  EXPECT_GT(crossing, 0.0);
  EXPECT_EQ(others, 0.0);
  EXPECT_LT(std::hypot(total[0], total[1]), 1e-12 * norm(total));
  EXPECT_LT(total[2], 0.0);
}

TEST(TrianglePair, TrianglesThatPassOrTurnTheirBacksDoNotOverlap) {
  const auto corners = [](const Corners& x) { return overlap_of(first_of(x), second_of(x)).count; };
  Corners x = parallel_corners(0.0, {{0.2, 0.2, 0.0}});
  EXPECT_EQ(corners(x), 3);
  std::swap(x[4], x[5]);
  EXPECT_EQ(corners(x), 0);  // the back
  EXPECT_EQ(corners(parallel_corners(0.0, {{1.2, 0.0, 0.0}})), 0);
}

}  // namespace
}  // namespace pyroclast::triangles
