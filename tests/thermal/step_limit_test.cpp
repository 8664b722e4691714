#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "advance.hpp"
#include "bodies.hpp"
#include "known.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/thermal/time_stages.hpp"

/// What the solver's time step must be, and what ends or corners do: each against a closed form.
// of its own, as tests of a module are one unit
namespace pyroclast::step_limit_test {
namespace {

constexpr double kSide = 0.01, kConductivity = 2.0, kCapacity = 2e6;  // m, W/(m K), J/(m³ K)
constexpr double kSafety = 0.9;
constexpr double kRounding = 1e-9;  // of the tables of properties

HeatParameters parameters(double initial, double largest_change) {
  return heat_parameters({0.0, 1200.0}, initial, largest_change);
}

Curve over_temperature(std::vector<double> temperatures, std::vector<double> values) {
  return Curve::table(std::move(temperatures), std::move(values), temperature_axis());
}

HeatMaterial material(const Curve& conductivity, const Curve& capacity) {
  return {conductivity, capacity};
}

/// One square block: a fan of four triangles. Its centre has four conductances k to the corners, each a
/// corner one; the capacities are rho c a²/3 and rho c a²/6.
ModelOf<2> square() {
  return plane_body({.blocks = {1, 1}, .size = {kSide, kSide}});
}

/// Gershgorin of the centre: rows 8 k, so that the step of Euler is 2 (rho c a²/3) / (8 k).
double limit_of_centre(double conductivity, double capacity) {
  return kSafety * capacity * kSide * kSide / (12.0 * conductivity);
}

TEST(StepLimitVerification, IsThatOfGershgorinToRounding) {
  const auto model = square();
  const Conduction<2> heat(model, {material(Curve::constant(kConductivity), Curve::constant(kCapacity))},
                           parameters(100.0, 10.0));
  const double exact = limit_of_centre(kConductivity, kCapacity);
  expect_known(
      {"Stable step of heat conduction: a square of one block", "Gershgorin's theorem, by hand", "s"},
      heat.step_limit().step, exact, kRounding * exact);
}

// Promise: the step is stable for the least capacity and the greatest conductivity that the temperatures may
// come to within it, not for the present ones.
TEST(StepLimitVerification, ForeseesTheChangeOfTheProperties) {
  const auto model = square();
  const Curve falling = over_temperature({0.0, 102.0, 104.0, 1200.0},
                                         {kCapacity, kCapacity, 0.25 * kCapacity, 0.25 * kCapacity});
  const Conduction<2> lighter(model, {material(Curve::constant(kConductivity), falling)},
                              parameters(100.0, 10.0));
  const double exact = limit_of_centre(kConductivity, 0.25 * kCapacity);
  expect_known({"Stable step where the heat capacity is about to fall to a quarter",
                "Gershgorin's theorem, by hand", "s"},
               lighter.step_limit().step, exact, kRounding * exact);
  const Curve rising = over_temperature(
      {0.0, 102.0, 104.0, 1200.0}, {kConductivity, kConductivity, 4.0 * kConductivity, 4.0 * kConductivity});
  const Conduction<2> faster(model, {material(rising, Curve::constant(kCapacity))}, parameters(100.0, 10.0));
  const double exact_of_faster = limit_of_centre(4.0 * kConductivity, kCapacity);
  expect_known(
      {"Stable step where the conductivity is about to rise fourfold", "Gershgorin's theorem, by hand", "s"},
      faster.step_limit().step, exact_of_faster, kRounding * exact_of_faster);
}

// Promise: radiation counts with its derivative 4 eps sigma T³, at the hottest that the step may come to.
TEST(StepLimitVerification, RadiationCountsWithItsDerivative) {
  constexpr double kSigma = 5.670374419e-8, kPoor = 1e-6, kChange = 0.01;
  const auto model = square();
  Conduction<2> heat(model, {material(Curve::constant(kPoor), Curve::constant(kCapacity))},
                     parameters(900.0, kChange));
  heat.apply(heat.faces([](const auto&) { return true; }),
             Radiation{Curve::constant(0.7), Curve::constant(20.0)});
  const double kelvin = 900.0 + kChange + 273.15;
  const double slope = 4.0 * 0.7 * kSigma * kelvin * kelvin * kelvin;
  // a corner: capacity rho c a²/6, half of the length of two faces, and its conduction
  const double exact = kSafety * 2.0 * (kCapacity * kSide * kSide / 6.0) / (slope * kSide + 2.0 * kPoor);
  expect_known({"Stable step under radiation", "4 eps sigma T^3 and Gershgorin's theorem, by hand", "s"},
               heat.step_limit().step, exact, 1e-6 * exact);
}

// Promise: convection likewise, with its coefficient.
TEST(StepLimitVerification, ConvectionCountsWithItsCoefficient) {
  constexpr double kPoor = 1e-6;
  const auto model = square();
  Conduction<2> heat(model, {material(Curve::constant(kPoor), Curve::constant(kCapacity))},
                     parameters(900.0, 10.0));
  heat.apply(heat.faces([](const auto&) { return true; }),
             Convection{Curve::constant(25.0), Curve::constant(20.0)});
  const double exact = kSafety * 2.0 * (kCapacity * kSide * kSide / 6.0) / (25.0 * kSide + 2.0 * kPoor);
  expect_known({"Stable step under convection", "Gershgorin's theorem, by hand", "s"}, heat.step_limit().step,
               exact, kRounding * exact);
}

// Promise: a number of super-time-stepping stages is odd, so that the shortest wave, for which the step is
// just stable, is damped to less than half and does not stand.
TEST(TimeStagesVerification, TheShortestWaveIsDamped) {
  for (const double ratio : {0.3, 1.0, 2.5, 4.4, 7.0, 12.0, 40.0, 200.0, 1000.0}) {
    const std::int64_t count = fewest_stages(HeatScheme::super_time_stepping, ratio);
    EXPECT_EQ(count % 2, 1) << ratio;
    const TimeStages stages(HeatScheme::super_time_stepping, count);
    // of dy/dt = -2 y over the step: with `count` stages stable up to (n² + n - 2)/4 steps of Euler, each of
    // 1
    const auto n = static_cast<double>(count);
    const double longest = 0.25 * (n * n + n - 2.0);
    double before = 0.0, increment = 0.0;
    for (std::int64_t j = 0; j < count; ++j) {
      const TimeStage s = stages[j];
      const double next = s.previous * increment + s.before * before +
                          longest * (-2.0) * (s.rate * (1.0 + increment) + s.first_rate);
      before = increment;
      increment = next;
    }
    EXPECT_LT(std::abs(1.0 + increment), 0.5) << ratio;
  }
}

// Promise: where two prescribed temperatures meet, the later one holds.
TEST(Prescription, TheLaterOneHoldsAtACorner) {
  for (const bool left_is_later : {true, false}) {
    const auto model = plane_body({.blocks = {3, 3}, .size = {kSide, kSide}});
    Conduction<2> heat(model, {material(Curve::constant(kConductivity), Curve::constant(kCapacity))},
                       parameters(20.0, 10.0));
    const auto on_left = heat.faces([](const auto& face) { return face.centre[0] < 1e-9; });
    const auto on_bottom = heat.faces([](const auto& face) { return face.centre[1] < 1e-9; });
    if (!left_is_later) heat.prescribe_temperature(on_left, Curve::constant(100.0));
    heat.prescribe_temperature(on_bottom, Curve::constant(50.0));
    if (left_is_later) heat.prescribe_temperature(on_left, Curve::constant(100.0));
    advance_to(heat, 1.0);
    for (int node = 0; node < heat.nodes().count(); ++node)
      if (norm(model.position[heat.nodes().gridpoint[node]]) < 1e-9) {
        EXPECT_EQ(heat.temperature()[node], left_is_later ? 100.0 : 50.0);
      }
  }
}

// Promise: a zone conducts with the conductivity at its mean temperature. In a bar of one row of blocks whose
// conductivity is linear in the temperature, the middle of two halves held at their far ends comes to where
// Kirchhoff's transform says, to the second order of the mesh; with the conductivity of one corner it would
// be off by the first.
TEST(ConductivityVerification, AWallOfLinearConductivityFollowsKirchhoff) {
  constexpr double kCold = 100.0, kHot = 900.0, kSlope = 2e-3;  // k = 1 + slope (T - 100)
  const Curve conductivity = over_temperature({0.0, 1200.0}, {1.0 - kSlope * 100.0, 1.0 + kSlope * 1100.0});
  const auto error = [&](int blocks) {
    const auto model = plane_body({.blocks = {blocks, 1}, .size = {0.1, 0.1 / blocks}});
    auto p = parameters(500.0, 200.0);
    p.largest_step = 1e5;
    Conduction<2> heat(model, {material(conductivity, Curve::constant(1e3))}, p);
    heat.prescribe_temperature(heat.faces([](const auto& face) { return face.centre[0] < 1e-9; }),
                               Curve::constant(kHot));
    heat.prescribe_temperature(heat.faces([](const auto& face) { return face.centre[0] > 0.1 - 1e-9; }),
                               Curve::constant(kCold));
    EXPECT_TRUE(advance_to_steady(heat, 1e-12, 1e8));
    const double rise = kHot - kCold;
    double worst = 0.0;
    for (int node = 0; node < heat.nodes().count(); ++node) {
      const double share = 1.0 - model.position[heat.nodes().gridpoint[node]][0] / 0.1;
      // slope/2 t² + t = share (slope/2 rise² + rise)
      const double exact =
          kCold +
          (std::sqrt(1.0 + 2.0 * kSlope * share * (0.5 * kSlope * rise * rise + rise)) - 1.0) / kSlope;
      worst = std::max(worst, std::abs(heat.temperature()[node] - exact));
    }
    return worst;
  };
  const double coarse = error(8), fine = error(16);
  // K of 800; first order leaves some ten
  expect_known_field({"A wall of linear conductivity: temperatures", "Kirchhoff's transform", "K"}, fine,
                     kHot - kCold, 1.0);
  EXPECT_LT(fine, coarse / 3.0);  // second order
}

// Promise: a zone conducts at the mean of its three temperatures. In one square block with the left corners
// hot and the right ones cold, what comes to the centre from the left, the right, and above and below
// together is k_l (T_l - T) + k_r (T_r - T) + 2 k_m ((T_l + T_r) / 2 - T) = 0, each k at the mean of its own
// zone.
TEST(ConductivityVerification, AZoneConductsAtItsMeanTemperature) {
  constexpr double kLeft = 900.0, kRight = 100.0;
  const auto k = [](double t) { return 1.0 + 2e-3 * (t - 100.0); };
  const auto model = square();
  auto p = parameters(500.0, 200.0);
  p.largest_step = 1e5;
  Conduction<2> heat(
      model, {material(over_temperature({0.0, 1200.0}, {k(0.0), k(1200.0)}), Curve::constant(1e3))}, p);
  heat.prescribe_temperature(heat.faces([](const auto& face) { return face.centre[0] < 1e-9; }),
                             Curve::constant(kLeft));
  heat.prescribe_temperature(heat.faces([](const auto& face) { return face.centre[0] > kSide - 1e-9; }),
                             Curve::constant(kRight));
  EXPECT_TRUE(advance_to_steady(heat, 1e-12, 1e8));
  double exact = 500.0;
  for (int i = 0; i < 200; ++i) {
    const double left = k((2.0 * kLeft + exact) / 3.0), right = k((2.0 * kRight + exact) / 3.0);
    const double middle = k((kLeft + kRight + exact) / 3.0);
    exact = (left * kLeft + right * kRight + middle * (kLeft + kRight)) / (left + right + 2.0 * middle);
  }
  const int centre = node_at(model, heat, {{0.5 * kSide, 0.5 * kSide}});
  expect_known({"Temperature in the middle of a block whose conductivity rises with the temperature",
                "heat balance of its centre, by hand", "degC"},
               heat.temperature()[centre], exact, 1e-6);
}

}  // namespace
}  // namespace pyroclast::step_limit_test
