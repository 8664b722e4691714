#include "pyroclast/thermal/conduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "advance.hpp"
#include "bodies.hpp"
#include "known.hpp"
#include "messages.hpp"
#include "model/small_specimen.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/thermal/fire_curves.hpp"
#include "specimen/solid_bodies.hpp"

namespace pyroclast {
namespace {

using std::numbers::pi;

constexpr Interval eurocode_range{20.0, 1200.0};

constexpr double kConductivity = 1.6;  // W/(m K)

// ---- Accuracy --------------------------------------------------------------------------------------------

/// Root of the mean square error of the nodes against a field, a function of their places.
template <int Dim, class Field>
double error_of(const Conduction<Dim>& heat, const ModelOf<Dim>& model, Field exact) {
  double sum = 0.0;
  for (int node = 0; node < heat.nodes().count(); ++node)
    sum += std::pow(heat.temperature()[node] - exact(model.position[heat.nodes().gridpoint[node]]), 2);
  return std::sqrt(sum / heat.nodes().count());
}

/// Largest error of the steady field of a box with the flux of a linear field through each face of its
/// outline. As much heat comes in as goes out, so the mean temperature stays that of the start.
template <int Dim>
double linear_field_error(const ModelOf<Dim>& model,
                          const std::vector<std::optional<HeatMaterial>>& materials, const Vec<Dim>& size,
                          bool limits = false) {
  constexpr double mean = 200.0;
  Vec<Dim> gradient{{100.0 / size[0], -70.0 / size[1]}};
  if constexpr (Dim == 3) gradient[2] = 40.0 / size[2];
  auto p = heat_parameters({-100.0, 500.0}, mean, 200.0);
  p.always_limits = limits;
  p.largest_step = 1e4;  // some times what the slowest wave needs to decay
  Conduction<Dim> heat(model, materials, p);
  for (int face = 0; face < static_cast<int>(heat.outline().size()); ++face)
    heat.apply({face}, HeatFlux{Curve::constant(kConductivity * dot(gradient, heat.outline()[face].normal))});
  EXPECT_TRUE(advance_to_steady(heat, 1e-15, 1e9));
  double worst = 0.0;
  for (int node = 0; node < heat.nodes().count(); ++node) {
    const auto& x = model.position[heat.nodes().gridpoint[node]];
    worst = std::max(worst, std::abs(heat.temperature()[node] - mean - dot(gradient, x - size * 0.5)));
  }
  return worst;
}

// Temperatures of some hundred degrees round at 1e-13 K; what is left of the transient is of that size too.
constexpr double round_off = 1e-10;  // K

TEST(ConductionVerification, CarriesALinearFieldExactlyThroughIrregularBlocks) {
  const auto model = plane_body({.blocks = {9, 7}, .size = {0.15, 0.12}, .jitter = 0.3});
  expect_known_field({"Steady heat through irregular blocks: temperatures", "linear field", "K"},
                     linear_field_error<2>(model, {constant_material(kConductivity, 2e6)}, {{0.15, 0.12}}),
                     100.0, round_off);
}

TEST(ConductionVerification, CarriesALinearFieldExactlyThroughTetrahedra) {
  const auto model = solid_body({.blocks = {4, 4, 4}, .size = {0.1, 0.1, 0.1}, .jitter = 0.2});
  expect_known_field({"Steady heat through tetrahedra: temperatures", "linear field", "K"},
                     linear_field_error<3>(model, {constant_material(kConductivity, 2e6)}, {{0.1, 0.1, 0.1}}),
                     100.0, round_off);
}

ModelOf<2> concrete_model() {
  specimen::SpecimenParameters p;
  p.outline = specimen::Region::rectangle(0.15, 0.3);
  p.seed = 3;
  p.aggregates = {.fraction = 0.2,
                  .d_min = 0.016,
                  .d_max = 0.032,
                  .fuller_exponent = 0.45,
                  .sieves = {0.016, 0.032},
                  .minimum_gap = 0.001,
                  .attempts = 100000};
  p.blocks.count = 300;
  p.blocks.radius_spread = 0.2;
  p.blocks.shortest_edge = 0.2;
  return between_platens(specimen::make_specimen(p), 0.03, 0.15);
}

TEST(ConductionVerification, CarriesALinearFieldExactlyThroughASpecimenWithoutItsPlatens) {
  const auto body = concrete_model();
  const auto material = constant_material(kConductivity, 2e6);
  expect_known_field(
      {"Steady heat through a specimen without its platens: temperatures", "linear field", "K"},
      linear_field_error<2>(body, {material, material, std::nullopt}, {{0.15, 0.3}}), 100.0, round_off);
}

/// Error of a square whose conductivity is D times its heat capacity c, both linear in the temperature. Its
/// heat H = T + T^2 / 20, the integral of c, then follows the linear equation of diffusion D (Kirchhoff's
/// transform): it decays as 3.45 + 1.5 exp(-t) cos(pi x) cos(pi y / 2). It is 3.45 on y = 1, so T is 3 there,
/// and symmetric about the other sides.
double kirchhoff_error(int blocks) {
  const auto model = plane_body({.blocks = {blocks, blocks}, .size = {1.0, 1.0}, .jitter = 0.2});
  const Curve capacity = Curve::expression("1 + T / 10", {0.0, 10.0}, temperature_axis());
  auto p = heat_parameters({0.0, 10.0}, 3.0);
  p.largest_change = 0.02;  // an error in time far below that in space
  Conduction<2> heat(model, {HeatMaterial{capacity * (0.8 / (pi * pi)), capacity}}, p);
  const auto exact = [](double t) {
    return [decay = std::exp(-t)](const Vec<2>& x) {
      const double stored = 3.45 + 1.5 * decay * std::cos(pi * x[0]) * std::cos(0.5 * pi * x[1]);
      return 10.0 * (std::sqrt(1.0 + stored / 5.0) - 1.0);
    };
  };
  set_field(heat, model, exact(0.0));
  heat.prescribe_temperature(heat.faces(on_plane<2>(1, 1.0, 1e-9)), Curve::constant(3.0));
  advance_to(heat, 0.3);
  return error_of(heat, model, exact(0.3));
}

TEST(ConductionVerification, IsOfSecondOrderInSpaceWithCurves) {
  const double coarse = kirchhoff_error(6), medium = kirchhoff_error(12), fine = kirchhoff_error(24);
  RecordProperty("errors", fmt::format("{:.3e} {:.3e} {:.3e}", coarse, medium, fine));
  RecordProperty("orders",
                 fmt::format("{:.3f} {:.3f}", std::log2(coarse / medium), std::log2(medium / fine)));
  EXPECT_GT(std::log2(coarse / medium), 1.9);
  expect_known({"Order of heat conduction in space, with curves over temperature",
                "decaying cosines by Kirchhoff's transform", "1"},
               std::log2(medium / fine), 2.0, 0.1);
}

/// L2 error of an insulated square whose temperatures 300 + 100 cos(pi x) cos(2 pi y) even out, K.
double decaying_error(int blocks, bool limits) {
  const auto model = plane_body({.blocks = {blocks, blocks}, .size = {1.0, 1.0}, .jitter = 0.3});
  auto p = heat_parameters({100.0, 500.0}, 300.0);
  p.largest_change = 0.2;  // an error in time far below that in space
  p.always_limits = limits;
  Conduction<2> heat(model, {constant_material(1.0, 1.0)}, p);
  const auto exact = [](double t) {
    return [decay = std::exp(-5.0 * pi * pi * t)](const Vec<2>& x) {
      return 300.0 + 100.0 * decay * std::cos(pi * x[0]) * std::cos(2.0 * pi * x[1]);
    };
  };
  set_field(heat, model, exact(0.0));
  advance_to(heat, 0.02);
  EXPECT_EQ(heat.work().limited_steps, limits ? heat.work().steps : 0);
  return error_of(heat, model, exact(0.02));
}

// Promise: limited flows lose no order where the temperatures are smooth.
TEST(ConductionVerification, IsOfSecondOrderInSpaceWithLimitedFlows) {
  const double medium = decaying_error(16, true), fine = decaying_error(32, true);
  expect_known({"Order of heat conduction in space with limited flows", "decaying cosines", "1"},
               std::log2(medium / fine), 2.0, 0.1);
}

/// L2 error of a bar in space one end of which comes to another temperature at once, over that jump, when
/// heat has gone through a third of its length: 1 - erf(x / sqrt(4 a t)) (Carslaw and Jaeger 1959, 2.5).
double bar_error(int blocks) {
  const auto model =
      solid_body({.blocks = {blocks, blocks / 4, blocks / 4}, .size = {1.0, 0.25, 0.25}, .jitter = 0.25});
  auto p = heat_parameters({-0.5, 1.5}, 0.0, 0.02);
  p.always_limits = true;
  Conduction<3> heat(model, {constant_material(1.0, 1.0)}, p);
  heat.prescribe_temperature(heat.faces(on_plane<3>(0, 0.0, 1e-9)), Curve::constant(1.0));
  const double duration = 1.0 / 36.0;
  advance_to(heat, duration);
  return error_of(heat, model, [&](const Vec<3>& x) { return std::erfc(x[0] / std::sqrt(4.0 * duration)); });
}

// Promise: limited flows lose no order in space either, though they act on the front at the start.
TEST(ConductionVerification, IsOfSecondOrderInTetrahedraWithLimitedFlows) {
  const double medium = bar_error(16), fine = bar_error(32);
  expect_known({"Order of heat conduction in tetrahedra with limited flows", "1 - erf(x / sqrt(4 a t))", "1"},
               std::log2(medium / fine), 2.0, 0.1);
}

TEST(ConductionVerification, CarriesALinearFieldExactlyWithLimitedFlows) {
  const auto plane = plane_body({.blocks = {9, 7}, .size = {0.15, 0.12}, .jitter = 0.3});
  const auto solid = solid_body({.blocks = {4, 4, 4}, .size = {0.1, 0.1, 0.1}, .jitter = 0.2});
  const double error = std::max(
      linear_field_error<2>(plane, {constant_material(kConductivity, 2e6)}, {{0.15, 0.12}}, true),
      linear_field_error<3>(solid, {constant_material(kConductivity, 2e6)}, {{0.1, 0.1, 0.1}}, true));
  expect_known_field({"Steady heat with limited flows: temperatures", "linear field", "K"}, error, 100.0,
                     round_off);
}

/// Concrete strip with one side in the standard fire for ten minutes.
struct Strip {
  ModelOf<2> model = plane_body({.blocks = {30, 4}, .size = {0.06, 0.008}, .jitter = 0.3});
  Conduction<2> heat;

  explicit Strip(const HeatParameters& p) : heat(model, {moist_concrete()}, p) {
    expose_to_fire(heat, heat.faces(on_plane<2>(0, 0.0, 1e-9)));
  }
};

TEST(Conduction, SuperTimeSteppingAgreesWithEulerAtAFractionOfTheCost) {
  auto p = heat_parameters(eurocode_range, 20.0, 5.0);
  Strip fast(p);
  p.scheme = HeatScheme::euler;
  Strip plain(p);
  advance_to(fast.heat, 600.0);
  advance_to(plain.heat, 600.0);
  double worst = 0.0;
  for (std::size_t node = 0; node < plain.heat.temperature().size(); ++node)
    worst = std::max(worst, std::abs(plain.heat.temperature()[node] - fast.heat.temperature()[node]));
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("euler_stages", std::to_string(plain.heat.work().stages));
  RecordProperty("super_stages", std::to_string(fast.heat.work().stages));
  RecordProperty("super_steps", std::to_string(fast.heat.work().steps));
  // Each has its own error in time; a tenth of a kelvin is 1e-4 of the fire.
  EXPECT_LT(worst, 0.1);
  EXPECT_LT(2 * fast.heat.work().stages, plain.heat.work().stages);
}

// ---- Conservation ----------------------------------------------------------------------------------------

TEST(Conduction, StoresAllTheHeatThatComesInByEveryWay) {
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping}) {
    auto p = heat_parameters(eurocode_range, 20.0);
    p.scheme = scheme;
    const auto two = [](const Vec<2>& x) { return x[0] + x[1] < 0.1 ? 0 : 1; };
    const auto model =
        plane_body({.blocks = {10, 10}, .size = {0.1, 0.1}, .jitter = 0.3, .material = two}, 2);
    Conduction<2> heat(model,
                       {moist_concrete(), HeatMaterial{moist_concrete().conductivity * 1.5,
                                                       en1992_specific_heat(0.0) * 2600.0}},
                       p);
    expose_to_fire(heat, heat.faces(on_plane<2>(0, 0.0, 1e-9)));
    heat.apply(heat.faces(on_plane<2>(1, 0.0, 1e-9)), HeatFlux{Curve::constant(2000.0)});
    heat.prescribe_temperature(heat.faces(on_plane<2>(1, 0.1, 1e-9)),
                               Curve::table({0.0, 3600.0}, {20.0, 320.0}, time_axis()));
    advance_to(heat, 1800.0);
    const HeatLedger ledger = heat.ledger();
    EXPECT_LT(std::abs(ledger.error()), 1e-10 * ledger.stored);
    RecordProperty(scheme == HeatScheme::euler ? "euler" : "super",
                   fmt::format("{:.1e}", ledger.error() / ledger.stored));
    // Every way took part, and the given flux is known: 2 kW/m² through 0.1 m² for half an hour.
    for (double part : {ledger.boundary.convection, ledger.boundary.radiation, ledger.prescribed})
      EXPECT_GT(std::abs(part), 0.001 * ledger.stored);
    EXPECT_NEAR(ledger.boundary.flux, 2000.0 * 0.1 * 1800.0, 1e-6);
  }
}

TEST(Conduction, DoesNotSkipTheMoisturePeakHoweverLargeTheStep) {
  // A body that conducts so well that it has one temperature: the integral of rho c is the heat that came in.
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  const HeatMaterial material{Curve::constant(1e6), en1992_specific_heat(3.0) * 2300.0};
  auto p = heat_parameters(eurocode_range, 20.0, 1000.0, 1e6);
  Conduction<2> heat(model, {material}, p);
  // From 20 to 300 degC at 3 % moisture, EN 1992-1-2 3.3.2.
  const double enthalpy = 2300.0 * (80.0 * 900.0 + 15.0 * 2020.0 + 85.0 * 1510.0 + 100.0 * 1025.0);
  // through the four sides in 1000 s
  heat.apply(heat.faces([](const auto&) { return true; }),
             HeatFlux{Curve::constant(enthalpy * 0.01 / 400.0)});
  advance_to(heat, 1000.0);
  EXPECT_LT(heat.work().steps, 30);
  for (double t : heat.temperature()) EXPECT_NEAR(t, 300.0, 1e-3);  // between the sides and the middle
}

TEST(Conduction, KeepsTheHeatOfAnInsulatedBodyAndEvensItOut) {
  const auto model = solid_body({.blocks = {3, 3, 3}, .size = {0.1, 0.1, 0.1}, .jitter = 0.2});
  Conduction<3> heat(model, {constant_material(2.0, 2e6)}, heat_parameters({0.0, 100.0}, 50.0));
  set_field(heat, model, [](const Vec<3>& x) { return 900.0 * x[0]; });
  ASSERT_TRUE(advance_to_steady(heat, 1e-9, 1e6));
  EXPECT_LT(std::abs(heat.ledger().stored), 1e-10 * 2e6 * 1e-3 * 50.0);
  for (double t : heat.temperature()) EXPECT_NEAR(t, heat.temperature().front(), 1e-4);  // 1e-9 K/s for hours
}

// ---- Reliability -----------------------------------------------------------------------------------------

TEST(Conduction, IsBitwiseTheSameOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const auto model = plane_body({.blocks = {88, 88}, .size = {0.15, 0.15}, .jitter = 0.3});
    Conduction<2> heat(model, {moist_concrete()}, heat_parameters(eurocode_range, 20.0),
                       std::make_shared<Team>(threads, WhenCrowded::stay));
    EXPECT_GE(heat.nodes().count(), 3 * fewest_for_threads);
    expose_to_fire(heat, heat.faces([](const auto&) { return true; }));
    advance_to(heat, 10.0);
    return heat.temperature();
  };
  const auto one = run(1), two = run(2), three = run(3);
  EXPECT_EQ(one, two);
  EXPECT_EQ(one, three);
}

TEST(Conduction, StaysStableWhenPropertiesChangeManifoldWithinAStep) {
  // Capacity falls and conductivity rises twentyfold within 50 K; the gas jumps. With a step that is too
  // long, neighbours would swing past each other and past the gas.
  const HeatMaterial wild{
      Curve::table({0.0, 200.0, 250.0, 1000.0}, {1.0, 1.0, 20.0, 20.0}, temperature_axis()),
      Curve::table({0.0, 300.0, 350.0, 1000.0}, {4e6, 4e6, 2e5, 2e5}, temperature_axis())};
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping})
    for (double change : {5.0, 50.0, 1000.0}) {
      auto p = heat_parameters({0.0, 1000.0}, 20.0);
      p.scheme = scheme;
      p.safety = 1.0;
      p.largest_change = change;
      p.largest_step = 1e6;
      const auto model = plane_body({.blocks = {20, 2}, .size = {0.1, 0.01}});
      Conduction<2> heat(model, {wild}, p);
      heat.apply(heat.faces(on_plane<2>(0, 0.0, 1e-9)),
                 Convection{Curve::constant(500.0), Curve::table({0.0, 500.0, 501.0, 4000.0},
                                                                 {20.0, 20.0, 900.0, 900.0}, time_axis())});
      double hottest = 0.0, coldest = 1000.0;
      for (int i = 1; i <= 40; ++i) {
        advance_to(heat, 100.0 * i);
        for (double t : heat.temperature()) {
          hottest = std::max(hottest, t);
          coldest = std::min(coldest, t);
        }
      }
      // A step of 1000 K may be inaccurate by some kelvin; an unstable one would leave the range at once.
      EXPECT_LE(hottest, 900.0 + 5.0) << change;
      EXPECT_GE(coldest, 20.0 - 5.0) << change;
      EXPECT_EQ(heat.work().largest_overshoot, 0.0);
    }
}

TEST(Conduction, TheStableStepIsTheOneOfTheSmallestBlockAndNotFarFromTheTrueOne) {
  // Squares of side a with a centre, k = conductivity. A centre has four conductances k and the capacity
  // rho c a²/3, a corner four and twice that; so corners against centres decay at k/(rho c) (12 + 6)/a².
  constexpr double side = 0.01, conductivity = 2.0, capacity = 2e6;
  auto p = heat_parameters({0.0, 100.0}, 0.0);
  p.safety = 1.0;
  const auto model = plane_body({.blocks = {6, 6}, .size = {6 * side, 6 * side}});
  const Conduction<2> heat(model, {constant_material(conductivity, capacity)}, p);
  const double exact = 2.0 * capacity * side * side / (conductivity * 18.0);
  EXPECT_LE(heat.step_limit().step, exact * (1.0 + 1e-12));
  EXPECT_GE(heat.step_limit().step, 0.5 * exact);

  const auto graded = [&](double jitter) {
    const auto irregular = plane_body({.blocks = {6, 6}, .size = {6 * side, 6 * side}, .jitter = jitter});
    return Conduction<2>(irregular, {constant_material(conductivity, capacity)}, p).step_limit().step;
  };
  EXPECT_LT(graded(0.3), graded(0.0));
}

TEST(Conduction, ConvectionAndRadiationShortenTheStableStep) {
  const auto model = plane_body({.blocks = {4, 4}, .size = {0.01, 0.01}});
  const auto limit = [&](double coefficient, double emissivity) {
    Conduction<2> heat(model, {constant_material(0.1, 2e6)}, heat_parameters({0.0, 1200.0}, 1100.0));
    const auto faces = heat.faces([](const auto&) { return true; });
    heat.apply(faces, Convection{Curve::constant(coefficient), Curve::constant(20.0)});
    heat.apply(faces, Radiation{Curve::constant(emissivity), Curve::constant(20.0)});
    return heat.step_limit();
  };
  EXPECT_LT(limit(1000.0, 0.0).step, limit(0.0, 0.0).step);
  EXPECT_LT(limit(1000.0, 1.0).step, limit(1000.0, 0.0).step);
}

TEST(Conduction, RunsWithTheSameExchangeTimesHoweverTheyAreAskedFor) {
  // The mechanics asks for heat at its own times; that must not spoil the result.
  auto p = heat_parameters(eurocode_range, 20.0, 5.0);
  Strip often(p), once(p);
  for (int i = 1; i <= 60; ++i) advance_to(often.heat, 10.0 * i);
  advance_to(once.heat, 600.0);
  EXPECT_EQ(often.heat.time(), 600.0);
  for (std::size_t node = 0; node < once.heat.temperature().size(); ++node)
    EXPECT_NEAR(often.heat.temperature()[node], once.heat.temperature()[node], 0.1);  // error in time
}

// ---- Batches ---------------------------------------------------------------------------------------------

/// Ten minutes of fire, with a prescribed temperature that jumps when the run begins, in steps
/// towards each minute. A batch takes at most so many stages; after every so many batches what was begun is
/// dropped.
HeatState heat_in_batches(HeatScheme scheme, std::int64_t stages, int batches_to_drop) {
  auto p = heat_parameters(eurocode_range, 20.0);
  p.scheme = scheme;
  p.largest_change = 4.0;
  Strip strip(p);
  Conduction<2>& heat = strip.heat;
  heat.apply(heat.faces(on_plane<2>(1, 0.0, 1e-9)),  // a jump, so that a step is taken back
             Convection{Curve::constant(500.0),
                        Curve::table({0.0, 315.0, 316.0, 600.0}, {20.0, 20.0, 900.0, 900.0}, time_axis())});
  heat.prescribe_temperature(heat.faces(on_plane<2>(0, 0.06, 1e-9)),
                             Curve::table({0.0, 600.0}, {60.0, 90.0}, time_axis()));
  int batches = 0;
  std::int64_t dropped = -1;
  for (double minute = 60.0; minute <= 600.0; minute += 60.0)
    while (heat.time() < minute) {
      const HeatState before = heat.state();
      std::int64_t left = stages;
      const bool completed = heat.advance_step(minute, left);
      EXPECT_GE(left, 0);
      if (!completed) {
        EXPECT_EQ(left, 0);
        EXPECT_EQ(heat.state(), before);
        if (++batches % batches_to_drop == 0 && heat.work().steps != dropped) {
          heat.drop_trial();
          dropped = heat.work().steps;  // each step once: one that is always dropped comes to no end
        }
      }
    }
  return heat.state();
}

TEST(Conduction, LimitedFlowsAreBitwiseTheSameOnAnyNumberOfThreads) {
  const auto model = plane_body({.blocks = {60, 60}, .size = {0.1, 0.1}, .jitter = 0.4});
  const auto state = [&](int threads) {
    auto p = heat_parameters({-250.0, 1300.0}, 20.0, 2.0);
    Conduction<2> heat(model, {constant_material(1.5, 2.2e6)}, p,
                       std::make_shared<Team>(threads, WhenCrowded::stay));
    heat.prescribe_temperature(heat.faces(on_plane<2>(0, 0.0, 1e-9)), Curve::constant(1000.0));
    advance_to(heat, 1.0);
    EXPECT_GT(heat.work().limited_steps, 0);
    return heat.state();
  };
  const HeatState alone = state(1);
  EXPECT_EQ(state(2), alone);
  EXPECT_EQ(state(3), alone);
}

TEST(Conduction, IsBitwiseTheSameInBatchesOfAnySizeAndWhenABatchIsDropped) {
  constexpr int never = std::numeric_limits<int>::max();
  constexpr auto all = std::numeric_limits<std::int64_t>::max();
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping}) {
    const HeatState whole = heat_in_batches(scheme, all, never);
    EXPECT_GT(whole.retries, 0);
    EXPECT_EQ(heat_in_batches(scheme, 1, never), whole);
    EXPECT_EQ(heat_in_batches(scheme, 7, never), whole);
    EXPECT_EQ(heat_in_batches(scheme, 2, 2), whole);
  }
}

TEST(Conduction, ABatchOfALargeBodyByEulerIsShort) {
  // A step towards the end of the wall of 5 m takes some 1e4 stages; a batch must not.
  auto p = heat_parameters({0.0, 100.0}, 20.0);
  p.scheme = HeatScheme::euler;
  p.largest_change = 100.0;
  p.largest_step = 1e9;
  const auto model = plane_body({.blocks = {100, 2}, .size = {5.0, 0.1}, .jitter = 0.3});
  Conduction<2> heat(model, {constant_material(40.0, 2e6)}, p);
  set_field(heat, model, [](const Vec<2>& x) { return 20.0 + 0.001 * x[0]; });
  constexpr double end = 1e8;
  std::int64_t left = std::numeric_limits<std::int64_t>::max();
  while (heat.state().next_step < 1e4 * heat.step_limit().step) heat.advance_step(end, left);
  const HeatState before = heat.state();
  constexpr std::int64_t batch = 1000;
  for (int i = 0; i < 5; ++i) {
    left = batch;
    EXPECT_FALSE(heat.advance_step(end, left));
    EXPECT_EQ(left, 0);
    EXPECT_EQ(heat.state(), before);
  }
}

TEST(Conduction, ABatchHasFewerStagesTheMoreZonesThereAre) {
  const auto stages = [](int blocks) {
    const auto model = plane_body({.blocks = {blocks, blocks}, .size = {0.1, 0.1}});
    return Conduction<2>(model, {constant_material(1.0, 1e6)}, heat_parameters({0.0, 100.0}, 20.0))
        .stages_per_batch();
  };
  EXPECT_NEAR(static_cast<double>(stages(5)) / static_cast<double>(stages(50)), 100.0, 0.2);  // whole stages
}

TEST(Conduction, RefusesToStepTowardsAnotherTimeBeforeAStepIsCompleted) {
  Strip strip(heat_parameters(eurocode_range, 20.0));
  std::int64_t left = 1;
  ASSERT_FALSE(strip.heat.advance_step(60.0, left));
  left = 1;
  expect_in("step under way", message([&] { strip.heat.advance_step(120.0, left); }));
  strip.heat.drop_trial();
  EXPECT_FALSE(strip.heat.advance_step(120.0, left));
}

// ---- Outline and materials -------------------------------------------------------------------------------

TEST(Conduction, FindsTheOutlineAndItsSides) {
  auto model = plane_body({.blocks = {5, 4}, .size = {0.5, 0.8}, .jitter = 0.3});
  model.thickness = 0.2;
  const Conduction<2> heat(model, {constant_material(1.0, 1.0)}, heat_parameters({0.0, 1.0}, 0.0));
  const auto area = [&](const std::vector<int>& faces) {
    double sum = 0.0;
    for (int face : faces) sum += heat.outline()[face].area;
    return sum;
  };
  const auto left = heat.faces(on_plane<2>(0, 0.0, 1e-9));
  EXPECT_EQ(left.size(), 4u);
  EXPECT_NEAR(area(left), 0.8 * 0.2, 1e-12);
  for (int face : left) EXPECT_NEAR(heat.outline()[face].normal[0], -1.0, 1e-12);
  EXPECT_NEAR(area(heat.faces([](const auto&) { return true; })), 2.6 * 0.2, 1e-12);
  EXPECT_NEAR(
      area(heat.faces(in_box<2>({{0.4, -0.1}}, {{0.6, 0.9}}))),
      area(heat.faces(on_plane<2>(0, 0.5, 1e-9))) + area(heat.faces(in_box<2>({{0.4, -0.1}}, {{0.49, 0.9}}))),
      1e-12);
}

TEST(Conduction, FindsTheOutlineInThreeDimensions) {
  const auto model = solid_body({.blocks = {3, 2, 2}, .size = {0.3, 0.2, 0.4}, .jitter = 0.2});
  const Conduction<3> heat(model, {constant_material(1.0, 1.0)}, heat_parameters({0.0, 1.0}, 0.0));
  double area = 0.0;
  Vec<3> closed{};
  for (const auto& face : heat.outline()) {
    area += face.area;
    closed += face.normal * face.area;
    const Vec<3>&a = model.position[face.gridpoints[0]], &b = model.position[face.gridpoints[1]],
          &c = model.position[face.gridpoints[2]];
    EXPECT_NEAR(0.5 * dot(cross(b - a, c - a), face.normal), face.area, 1e-15);  // right-handed
  }
  EXPECT_NEAR(area, 2.0 * (0.3 * 0.2 + 0.3 * 0.4 + 0.2 * 0.4), 1e-12);
  EXPECT_LT(norm(closed), 1e-15);
}

TEST(Conduction, LeavesOutBlocksOfMaterialsThatDoNotConduct) {
  const auto body = concrete_model();
  const auto material = constant_material(kConductivity, 2e6);
  const Conduction<2> heat(body, {material, material, std::nullopt}, heat_parameters(eurocode_range, 50.0));
  double area = 0.0;
  for (const auto& face : heat.outline()) area += face.area;
  EXPECT_NEAR(area, 2.0 * (0.15 + 0.3) * 0.15, 1e-12);  // the specimen's own outline
  const auto temperature = heat.gridpoint_temperatures(20.0);
  for (int b = 0; b < body.block_count(); ++b)
    for (int g = body.block_gridpoints[b]; g < body.block_gridpoints[b + 1]; ++g)
      ASSERT_EQ(temperature[g], body.is_of_bearing(b) ? 20.0 : 50.0);

  const Conduction<2> all(body, {material, material, material}, heat_parameters(eurocode_range, 50.0));
  area = 0.0;
  for (const auto& face : all.outline()) area += face.area;
  EXPECT_NEAR(area, 2.0 * (0.15 + 0.3 + 2 * 0.03) * 0.15, 1e-12);  // with platens of 0.03 m
}

TEST(Conduction, GivesJoinedGridpointsOneTemperature) {
  Strip strip(heat_parameters(eurocode_range, 20.0));
  advance_to(strip.heat, 300.0);
  const auto temperature = strip.heat.gridpoint_temperatures(0.0);
  for (const auto& contact : strip.model.contacts) EXPECT_EQ(temperature[contact.a], temperature[contact.b]);
  EXPECT_EQ(strip.heat.nodes().count(), 31 * 5 + 30 * 4);  // corners and centres of the blocks
}

// ---- Blocks that leave -----------------------------------------------------------------------------------

// Promise: what is left takes the fire where it is bared, as a body that never had the others.
TEST(Conduction, GoesOnWithoutBlocksThatLeaveAsABodyThatNeverHadThem) {
  const auto fire = [](Conduction<2>& heat, double left) {
    heat.apply(heat.faces(on_plane<2>(0, left, 1e-9)),
               Convection{Curve::constant(25.0), fire_curves().at("iso834").curve});
    heat.apply(heat.faces(on_plane<2>(0, left, 1e-9)),
               Radiation{Curve::constant(0.7), fire_curves().at("iso834").curve});
    heat.prescribe_temperature(heat.faces(on_plane<2>(0, 0.12, 1e-9)), Curve::constant(20.0));
    heat.prescribe_temperature(heat.faces(on_plane<2>(1, 0.0, 1e-9)), Curve::constant(30.0));
  };
  const auto parameters = [] {
    auto p = heat_parameters(eurocode_range, 20.0);
    p.loses_blocks = true;
    return p;
  }();
  const auto material = constant_material(1.6, 2.2e6);
  const auto whole = plane_body({.blocks = {6, 3}, .size = {0.12, 0.06}});
  auto rest = plane_body({.blocks = {5, 3}, .size = {0.10, 0.06}});
  for (auto& x : rest.position) x[0] += 0.02;
  Conduction<2> heat(whole, {material}, parameters), alone(rest, {material}, parameters);
  fire(heat, 0.0);
  fire(alone, 0.02);
  heat.remove({0, 6, 12});  // the column on the left
  EXPECT_EQ(heat.ledger().removed, 0.0);
  advance_to(heat, 600.0);
  advance_to(alone, 600.0);
  const auto t = heat.gridpoint_temperatures(-1.0), t_alone = alone.gridpoint_temperatures(-1.0);
  const std::vector<int> block_of = gridpoint_blocks(whole);
  std::size_t of_rest = 0;
  for (int g = 0; g < whole.gridpoint_count(); ++g) {
    const bool is_gone = block_of[g] % 6 == 0;
    EXPECT_NEAR(t[g], is_gone ? -1.0 : t_alone[of_rest++], 1e-6);
  }
  EXPECT_EQ(of_rest, t_alone.size());
}

TEST(Conduction, BooksTheHeatOfBlocksThatLeaveAndKeepsThatOfTheOthers) {
  auto p = heat_parameters(eurocode_range, 20.0);
  p.loses_blocks = true;
  const auto model = solid_body({.blocks = {4, 3, 2}, .size = {0.08, 0.06, 0.04}, .jitter = 0.2});
  const auto make = [&] {
    auto heat = std::make_unique<Conduction<3>>(model, std::vector{std::optional{moist_concrete()}}, p);
    heat->apply(heat->faces(on_plane<3>(0, 0.0, 1e-9)),
                Convection{Curve::constant(25.0), fire_curves().at("iso834").curve});
    return heat;
  };
  auto heat = make();
  advance_to(*heat, 300.0);
  const HeatLedger before = heat->ledger();
  const auto t = heat->gridpoint_temperatures(-1.0);
  heat->remove({0, 4});
  heat->remove({12});
  const HeatLedger after = heat->ledger();
  EXPECT_GT(after.removed, 0.05 * before.stored);
  EXPECT_NEAR(after.stored + after.removed, before.stored, 1e-12 * before.stored);
  EXPECT_NEAR(after.error(), before.error(), 1e-12 * before.stored);
  const auto now = heat->gridpoint_temperatures(-1.0);
  for (std::size_t g = 0; g < t.size(); ++g) {
    EXPECT_TRUE(now[g] == -1.0 || now[g] == t[g]);
  }
  // a state of the smaller body goes on alike
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { heat->visit_state(visitor); });
  auto other = make();
  other->remove({0, 4});
  other->remove({12});
  copy.put([&](StateVisitor& visitor) { other->visit_state(visitor); });
  advance_to(*heat, 600.0);
  advance_to(*other, 600.0);
  EXPECT_EQ(heat->state(), other->state());
  const HeatLedger last = heat->ledger();
  EXPECT_EQ(last.removed, after.removed);
  EXPECT_GT(last.boundary.convection, before.boundary.convection * 1.3);
  EXPECT_NEAR(last.error(), 0.0, 1e-11 * last.stored);
}

// ---- Refusals --------------------------------------------------------------------------------------------

TEST(Conduction, RefusesARangeThatTheCurvesDoNotCover) {
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  expect_in("material 0: the conductivity", message([&] {
              Conduction<2>(model, {moist_concrete()}, heat_parameters({0.0, 800.0}, 20.0));
            }));
}

TEST(Conduction, RefusesParametersOutOfRange) {
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  const auto refusal = [&](auto change) {
    auto p = heat_parameters({0.0, 100.0}, 20.0);
    change(p);
    return message([&] { Conduction<2>(model, {constant_material(1.0, 1.0)}, p); });
  };
  expect_in("initial temperature is 120", refusal([](auto& p) { p.initial_temperature = 120.0; }));
  expect_in("safety factor is 1.5", refusal([](auto& p) { p.safety = 1.5; }));
  expect_in("largest change per step [K] is 0", refusal([](auto& p) { p.largest_change = 0.0; }));
  expect_in("largest step [s] is -1", refusal([](auto& p) { p.largest_step = -1.0; }));
  expect_in("temperature range is 100 to 0", refusal([](auto& p) { p.temperature_range = {100.0, 0.0}; }));
}

TEST(Conduction, RefusesBoundaryValuesThatMakeNoSense) {
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  Conduction<2> heat(model, {constant_material(1.0, 1e6)}, heat_parameters({0.0, 100.0}, 20.0));
  const auto faces = heat.faces(on_plane<2>(0, 0.0, 1e-9));
  const Curve air = Curve::constant(20.0);
  expect_in("coefficient", message([&] { heat.apply(faces, Convection{Curve::constant(-1.0), air}); }));
  expect_in("emissivity", message([&] { heat.apply(faces, Radiation{Curve::constant(1.1), air}); }));
  expect_in("function of T", message([&] {
              heat.apply(faces, HeatFlux{Curve::table({0.0, 1.0}, {0.0, 1.0}, temperature_axis())});
            }));
  heat.prescribe_temperature(faces, Curve::constant(200.0));
  expect_in("prescribed temperature", message([&] { advance_to(heat, 1.0); }));
}

TEST(Conduction, RefusesToRunBeyondTheEndOfABoundaryCurve) {
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  Conduction<2> heat(model, {constant_material(1.0, 1e6)}, heat_parameters({0.0, 100.0}, 20.0));
  heat.apply(heat.faces(on_plane<2>(0, 0.0, 1e-9)),
             Convection{Curve::constant(25.0), Curve::table({0.0, 60.0}, {20.0, 80.0}, time_axis())});
  advance_to(heat, 60.0);
  expect_in("gas temperature", message([&] { advance_to(heat, 61.0); }));
}

TEST(Conduction, StopsWhenTheBodyLeavesTheTemperatureRangeAndSaysWhere) {
  const auto model = plane_body({.blocks = {10, 2}, .size = {0.1, 0.02}});
  Conduction<2> heat(model, {constant_material(1.0, 1e6)}, heat_parameters({0.0, 100.0}, 20.0));
  heat.apply(heat.faces(on_plane<2>(0, 0.1, 1e-9)), HeatFlux{Curve::constant(10000.0)});
  const std::string text = message([&] { advance_to(heat, 1e4); });
  expect_in("leaves the run's range of 0 to 100 degC", text);
  expect_in("(0.1, ", text);
  for (double t : heat.temperature()) EXPECT_LE(t, 100.0);
}

TEST(Conduction, HoldsOvershootsOfASharpFrontAtTheEndOfTheRange) {
  // A shock of 980 K over one zone makes obtuse zones undershoot; the solution itself cannot.
  const auto model = plane_body({.blocks = {20, 20}, .size = {0.1, 0.1}, .jitter = 0.35});
  auto p = heat_parameters(eurocode_range, 20.0);
  Conduction<2> heat(model, {moist_concrete()}, p);
  heat.prescribe_temperature(heat.faces([](const auto&) { return true; }), Curve::constant(1000.0));
  advance_to(heat, 100.0);
  EXPECT_GT(heat.work().largest_overshoot, 0.0);
  for (double t : heat.temperature())
    EXPECT_TRUE(20.0 <= t && t <= 1000.0 + heat.work().largest_overshoot) << t;
  EXPECT_LT(std::abs(heat.ledger().error()), 1e-10 * heat.ledger().stored);
}

/// Faces of the outline at 0 along an axis, by their places along the next one.
template <int Dim>
auto patch_on(int axis, double from, double to) {
  return [=](const OutlineFace<Dim>& face) {
    const double across = face.centre[(axis + 1) % Dim];
    return std::abs(face.centre[axis]) < 1e-9 && from <= across && across <= to;
  };
}

/// How far temperatures leave those of the start and of the patch that is held, K.
template <int Dim, class Patch>
double excess_of_patch(const ModelOf<Dim>& model, const Patch& patch, double duration, double start = 20.0,
                       double held = 1000.0, double largest_change = 2.0) {
  auto p = heat_parameters({-250.0, 1300.0}, start, largest_change);
  Conduction<Dim> heat(
      model,
      std::vector<std::optional<HeatMaterial>>(model.material_names.size(), constant_material(1.5, 2.2e6)),
      p);
  heat.prescribe_temperature(heat.faces(patch), Curve::constant(held));
  const auto [least, greatest] = std::minmax(start, held);
  double beyond = 0.0;
  for (int i = 1; i <= 20; ++i) {
    advance_to(heat, duration * i * i / 400.0);
    for (const double t : heat.temperature()) beyond = std::max({beyond, least - t, t - greatest});
  }
  EXPECT_GT(heat.work().limited_steps, 0);
  EXPECT_LE(std::abs(heat.ledger().error()), 1e-10 * std::abs(heat.ledger().stored));
  return beyond;
}

// Promise: no temperature leaves those of the start and of what is prescribed, however obtuse the zones.
TEST(Conduction, ASharpFrontStaysWithinItsBounds) {
  const auto plane = plane_body({.blocks = {20, 20}, .size = {0.1, 0.1}, .jitter = 0.45});
  EXPECT_LE(excess_of_patch(plane, patch_on<2>(0, 0.03, 0.07), 600.0), Conduction<2>::kAllowedBeyond);
  EXPECT_LE(excess_of_patch(plane, patch_on<2>(0, 0.0, 0.1), 600.0, 600.0, 20.0),
            Conduction<2>::kAllowedBeyond);
  const auto slender = plane_body({.blocks = {40, 5}, .size = {0.1, 0.1}, .jitter = 0.3});
  EXPECT_LE(excess_of_patch(slender, patch_on<2>(1, 0.03, 0.07), 600.0), Conduction<2>::kAllowedBeyond);
}

TEST(Conduction, ASharpFrontInTetrahedraStaysWithinItsBounds) {
  const auto solid = solid_body({.blocks = {8, 8, 8}, .size = {0.1, 0.1, 0.1}, .jitter = 0.25});
  EXPECT_LE(excess_of_patch(solid, patch_on<3>(0, 0.0, 0.1), 600.0), Conduction<3>::kAllowedBeyond);
  EXPECT_LE(excess_of_patch(solid, patch_on<3>(2, 0.03, 0.07), 600.0, 600.0, 20.0),
            Conduction<3>::kAllowedBeyond);
  const auto flat = solid_body({.blocks = {14, 3, 4}, .size = {0.1, 0.1, 0.1}, .jitter = 0.2});
  EXPECT_LE(excess_of_patch(flat, patch_on<3>(2, 0.0, 0.1), 600.0), Conduction<3>::kAllowedBeyond);
}

/// Concrete of polyhedral blocks as they come, with edges of any length.
ModelOf<3> raw_cells(int blocks) {
  specimen::SpecimenParameters p;
  p.seed = 1;
  p.blocks.count = blocks;
  p.blocks.radius_spread = 0.3;
  return make_model(specimen::made_in(p, specimen::cuboid(0.1, 0.1, 0.1)));
}

TEST(Conduction, ASharpFrontInRawCellsStaysWithinItsBounds) {
  const auto solid = raw_cells(500);
  EXPECT_LE(excess_of_patch(solid, patch_on<3>(0, 0.0, 0.1), 0.2, 20.0, 1000.0, 20.0),
            Conduction<3>::kAllowedBeyond);
}

// Promise: a heat flux of 0 is none: it widens no bounds, excuses nothing, and changes no bit.
TEST(Conduction, AFluxOfZeroIsNone) {
  const auto model = plane_body({.blocks = {12, 12}, .size = {0.1, 0.1}, .jitter = 0.35});
  const auto temperatures = [&](bool with_flux) {
    auto p = heat_parameters({20.0, 1100.0}, 20.0, 2.0);
    Conduction<2> heat(model, {constant_material(1.5, 2.2e6)}, p);
    heat.prescribe_temperature(heat.faces(on_plane<2>(0, 0.0, 1e-9)), Curve::constant(1000.0));
    if (with_flux)
      heat.apply(heat.faces(on_plane<2>(0, 0.1, 1e-9)),
                 HeatFlux{Curve::table({0.0, 1e3}, {0.0, 0.0}, time_axis())});
    advance_to(heat, 60.0);
    EXPECT_EQ(heat.bounds(), (Interval{20.0, 1000.0}));
    return heat.temperature();
  };
  EXPECT_EQ(temperatures(true), temperatures(false));
}

// Promise: a flux and a gas take temperatures where they do; the bounds say so.
TEST(Conduction, WhatHeatsWidensTheBounds) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto model = plane_body({.blocks = {6, 6}, .size = {0.1, 0.1}, .jitter = 0.2});
  const auto bounds = [&](const auto& act) {
    Conduction<2> heat(model, {constant_material(1.5, 2.2e6)}, heat_parameters({-100.0, 900.0}, 20.0));
    act(heat, heat.faces(on_plane<2>(0, 0.0, 1e-9)));
    advance_to(heat, 10.0);
    return heat.bounds();
  };
  EXPECT_EQ(
      bounds([](auto& heat, const auto& faces) { heat.apply(faces, HeatFlux{Curve::constant(500.0)}); }),
      (Interval{20.0, infinity}));
  EXPECT_EQ(
      bounds([](auto& heat, const auto& faces) { heat.apply(faces, HeatFlux{Curve::constant(-500.0)}); }),
      (Interval{-infinity, 20.0}));
  EXPECT_EQ(bounds([](auto& heat, const auto& faces) {
              heat.apply(faces, Convection{Curve::constant(25.0), Curve::constant(-7.0)});
            }),
            (Interval{-7.0, 20.0}));
}

TEST(Conduction, HeatThatWaitsAtTheEndOfTheRangeComesToItsPlaceWhenTheRangeWidens) {
  // 1 K/s, through the sides of a block that conducts well; at the end its corners get it all
  const auto model = plane_body({.blocks = {1, 1}, .size = {0.1, 0.1}});
  Conduction<2> heat(model, {constant_material(1e6, 1e6)}, heat_parameters({20.0, 100.0}, 20.0));
  heat.apply(heat.faces([](const auto&) { return true; }), HeatFlux{Curve::constant(25e3)});
  const int middle = node_at(model, heat, {{0.05, 0.05}});
  const auto mean = [&] {  // the middle has a third of the area, each corner a sixth
    double sum = heat.temperature()[middle];
    for (const double t : heat.temperature()) sum += t;
    return sum / 6.0;
  };
  advance_to(heat, 80.5);
  for (double t : heat.temperature()) EXPECT_EQ(t, 100.0);
  heat.widen_temperature_range({50.0, 500.0});
  EXPECT_NEAR(mean(), 100.5, 1e-9);  // rounding of 1e2 K
  advance_to(heat, 300.0);
  EXPECT_NEAR(mean(), 320.0, 1e-9);
  EXPECT_LT(std::abs(heat.ledger().error()), 1e-10 * heat.ledger().stored);
}

TEST(Conduction, RefusesToWidenItsRangeBeyondAMaterialsCurves) {
  const auto model = plane_body({.blocks = {2, 2}, .size = {0.1, 0.1}});
  Conduction<2> heat(model, {moist_concrete()}, heat_parameters({20.0, 100.0}, 20.0));
  heat.widen_temperature_range({20.0, 1200.0});
  expect_in("range of 20 to 1300 degC", message([&] { heat.widen_temperature_range({30.0, 1300.0}); }));
  expect_in("temperature range is -300", message([&] { heat.widen_temperature_range({-300.0, 0.0}); }));
}

TEST(Conduction, RefusesContactsBetweenGridpointsThatDoNotCoincide) {
  auto model = plane_body({.blocks = {2, 1}, .size = {0.2, 0.1}});
  model.position[model.contacts[0].b][0] += 0.001;
  expect_in("apart", message([&] {
              Conduction<2>(model, {constant_material(1.0, 1.0)}, heat_parameters({0.0, 1.0}, 0.0));
            }));
}

}  // namespace
}  // namespace pyroclast
