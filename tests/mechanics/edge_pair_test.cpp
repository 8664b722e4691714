#include "pyroclast/mechanics/found/edge_pair.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "gradient.hpp"
#include "pyroclast/base/random.hpp"

namespace pyroclast {
namespace {

constexpr double kNormalStiffness = 3.0, kShearStiffness = 2.0, kThickness = 0.8, kNotCounted = 0.02;
constexpr double kUnloadedA = 1.1, kUnloadedB = 0.9, kMostDepth = 0.9;

using Corners = std::array<Vec<2>, 4>;

EdgePair<double> pair_of(const Corners& x) {
  return edge_pair<double>({x[0], x[1]}, {x[2], x[3]}, kUnloadedA, kUnloadedB);
}
EndAreas<double> areas_of(const EdgePair<double>& p) {
  return {p, kThickness, kNotCounted, kMostDepth, p.gap};
}

/// Energy of the normal springs of both ends.
double normal_energy(const Corners& x) {
  const auto p = pair_of(x);
  const auto areas = areas_of(p);
  double energy = 0.0;
  for (int k = 0; k < 2; ++k)
    if (p.gap[k] < 0.0) energy += 0.5 * kNormalStiffness * p.gap[k] * p.gap[k] * areas.area[k];
  return energy;
}

/// Energy of shear springs on areas that stand.
double shear_energy(const Corners& x, const std::array<double, 2>& area) {
  const auto p = pair_of(x);
  double energy = 0.0;
  for (int k = 0; k < 2; ++k) energy += 0.5 * kShearStiffness * p.slide[k] * p.slide[k] * area[k];
  return energy;
}

EndTractions<double> tractions_of(const EdgePair<double>& p, bool shear) {
  EndTractions<double> t;
  for (int k = 0; k < 2; ++k) {
    const double pressed = std::min(p.gap[k], 0.0);
    if (shear)
      t.shear[k] = kShearStiffness * p.slide[k];
    else
      t.normal[k] = kNormalStiffness * pressed;
    t.stored[k] = shear ? 0.0 : 0.5 * kNormalStiffness * pressed * pressed;
  }
  return t;
}

constexpr double kGradientStep = 3e-5;  // m

/// Calls `f(corners, pair)` for random pairs that face each other and stand at no kink of the energy.
template <class F>
int for_random_pairs(F f) {
  Random random(1);
  const auto within = [&](double size) { return random.uniform(-size, size); };
  int taken = 0;
  while (taken < 20000) {
    const Corners x{{{{0.0, 0.0}},
                     {{1.0, within(0.3)}},
                     {{within(0.9), within(0.4)}},
                     {{1.0 + within(0.9), within(0.4)}}}};
    const auto p = pair_of(x);
    if (!p.face || p.overlap < 0.05) continue;
    const double counted = p.overlap - kNotCounted, width = std::min(counted, kMostDepth / 3.0);
    bool at_kink = std::abs(x[2][0]) < 1e-3 || std::abs(counted - kMostDepth / 3.0) < 1e-3;
    for (int k = 0; k < 2; ++k) {
      const double depth = -p.gap[k] / width;
      at_kink = at_kink || std::abs(p.gap[k]) < 1e-3 || std::abs(depth - 1.0) < 1e-2 ||
                std::abs(depth - 3.0) < 1e-2 || std::abs(p.at_a[k] - k) + std::abs(p.at_b[k] - k) < 1e-3;
    }
    if (at_kink) continue;
    ++taken;
    f(x, p);
  }
  return taken;
}

// Promise: forces are minus the exact gradient, and balanced in forces and moments.
TEST(EdgePairVerification, ForcesAreTheGradientOfTheirEnergy) {
  double worst_normal = 0.0, worst_shear = 0.0, out_of_balance = 0.0;
  for_random_pairs([&](const Corners& x, const EdgePair<double>& p) {
    const auto areas = areas_of(p);
    for (const bool shear : {false, true}) {
      const auto forces = corner_forces(p, areas, tractions_of(p, shear));
      const double error = gradient_error(kGradientStep, x, forces, [&](const Corners& y) {
        return shear ? shear_energy(y, areas.area) : normal_energy(y);
      });
      (shear ? worst_shear : worst_normal) = std::max(shear ? worst_shear : worst_normal, error);
      Vec<2> sum{};
      double moment = 0.0;
      for (int corner = 0; corner < 4; ++corner) {
        sum += forces[corner];
        moment += cross(x[corner], forces[corner]);
      }
      out_of_balance = std::max({out_of_balance, norm(sum), std::abs(moment)});
    }
  });
  // forces up to 1; central differences of fourth order leave 1e-16 / 3e-5
  EXPECT_LT(worst_normal, 1e-9);
  EXPECT_LT(worst_shear, 1e-9);
  EXPECT_LT(out_of_balance, 1e-14);
}

// Promise: no part of the forces is idle. Each one left out breaks the gradient that the test above measures.
TEST(EdgePairVerification, EveryPartOfTheForcesIsNeeded) {
  struct Fault {
    const char* what;
    std::function<void(EdgePair<double>&, EndAreas<double>&)> leave_out;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<Fault> faults{
      {"square of the cosine",
       [](auto& p, auto& areas) { areas.half_thickness /= p.cosine, p.cosine = 1.0; }},
      {"shares",
       [](auto&, auto& areas) {
         for (auto& end : areas.ends) end.share = 1.0;
       }},
      {"derivatives of the shares",
       [](auto&, auto& areas) {
         for (auto& end : areas.ends) end.slope = 0.0;
       }},
      {"largest depth", [](auto&, auto& areas) { areas.is_long = false; }},
      {"overlap of the beginning", [](auto&, auto& areas) { areas.counted += kNotCounted; }},
      {"ratio of areas", [](auto&, auto& areas) { areas.half_thickness /= kThickness; }},
      {"turning of the mean edge", [&](auto& p, auto&) { p.mean_length = infinite; }},
      {"slope of the edge that a corner meets", [](auto& p, auto&) { p.gap_slope = {}; }},
  };
  for (const Fault& fault : faults) {
    double worst = 0.0;
    for_random_pairs([&](const Corners& x, EdgePair<double> p) {
      auto areas = areas_of(p);
      const auto tractions = tractions_of(p, false);
      fault.leave_out(p, areas);
      worst = std::max(worst,
                       gradient_error(kGradientStep, x, corner_forces(p, areas, tractions), normal_energy));
    });
    EXPECT_GT(worst, 1e-3) << fault.what;
  }
}

// Promise: without slide the two ends are the points of a joined face: each has half of the edge.
TEST(EdgePair, CoincidingEdgesAreAFaceWithTwoPoints) {
  const Corners x{{{{0.0, 0.0}}, {{2.0, 0.0}}, {{0.0, -0.01}}, {{2.0, -0.02}}}};
  const auto p = edge_pair<double>({x[0], x[1]}, {x[2], x[3]}, 2.0, 2.0);
  EXPECT_TRUE(p.face);
  const EndAreas<double> areas(p, 1.0, 0.0, 1e3, p.gap);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(areas.area[k], 1.0, 1e-4);
    EXPECT_NEAR(p.slide[k], 0.0, 1e-4);
  }
  EXPECT_NEAR(p.gap[0], 0.01, 1e-4);
  EXPECT_NEAR(p.gap[1], 0.02, 1e-4);
}

TEST(EdgePair, EdgesThatPassOrTurnTheirBacksDoNotFaceEachOther) {
  const auto face = [](const Corners& x) { return pair_of(x).face; };
  EXPECT_TRUE(face({{{{0, 0}}, {{1, 0}}, {{0.5, -0.1}}, {{1.5, -0.1}}}}));
  EXPECT_FALSE(face({{{{0, 0}}, {{1, 0}}, {{1.1, -0.1}}, {{2.1, -0.1}}}}));  // beside it
  EXPECT_FALSE(face({{{{0, 0}}, {{1, 0}}, {{1.0, -0.1}}, {{0.0, -0.1}}}}));  // the back
}

}  // namespace
}  // namespace pyroclast
