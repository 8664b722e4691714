#include "pyroclast/laws/mixed_mode.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/cohesive.hpp"
#include "pyroclast/laws/contact_properties.hpp"
#include "table_2.hpp"

namespace pyroclast {
namespace {

using Properties = MixedMode::Properties<double>;
using Softening = MixedMode::Softening;
template <int Dim>
using Internals = MixedMode::Internals<Dim, double>;
using Losses = MixedMode::Losses<double>;

constexpr auto kSoftenings = {Softening::bilinear, Softening::exponential, Softening::linear,
                              Softening::tailed};
constexpr double kDegree = std::numbers::pi / 180.0;

Properties without_dilatancy(Softening softening = Softening::bilinear) {
  Properties p = mixed_mode_contact();
  p.softening = softening;
  p.dilatancy_angle = 0.0;
  return p;
}

double dissipated(const Losses& lost) {
  return lost.tension + lost.shear + lost.friction + lost.compression;
}

/// One contact point on its way, with the trapezoidal work.
template <int Dim>
struct Point {
  Properties properties;
  Internals<Dim> internals;
  Losses lost{};
  ContactResponse<Dim> response;
  double opening = 0.0, work = 0.0;
  Tangential<Dim> tangential{};

  explicit Point(const Properties& p) : properties(p) {}

  const ContactResponse<Dim>& take_to(double to, const Tangential<Dim>& shear) {
    const auto before = response;
    response = MixedMode::update<Dim, double>(MixedMode::derive(properties), to, shear, internals, lost);
    work += 0.5 * (before.normal_traction + response.normal_traction) * (to - opening) +
            0.5 * dot(before.shear_traction + response.shear_traction, shear - tangential);
    opening = to;
    tangential = shear;
    return response;
  }
  /// Goes straight there in equal steps.
  void go(double to, const Tangential<Dim>& shear, int steps) {
    const double from = opening;
    const Tangential<Dim> from_shear = tangential;
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      take_to(from + share * (to - from), from_shear + share * (shear - from_shear));
    }
  }
  /// What was put in less what is stored and lost, over what was put in.
  double missing() const { return (work - response.stored - dissipated(lost)) / work; }
};

class MixedModeVerification : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Steps, MixedModeVerification, testing::Values(1, 7, 1000));

// 1e-12: closed forms, only round-off is left.
TEST_P(MixedModeVerification, TearingApartDissipatesTheModeOneEnergy) {
  for (const Softening softening : kSoftenings) {
    Point<2> point(without_dilatancy(softening));
    point.go(2.0 * point.properties.last_opening(), {}, GetParam());
    expect_known({"Law mixed_mode: energy of tearing apart", "G_f1", "J/m2"}, point.lost.tension, 60.0,
                 60.0 * 1e-12);
    EXPECT_EQ(dissipated(point.lost), point.lost.tension);
    EXPECT_EQ(point.internals.damage, 1.0);
    EXPECT_EQ(point.response.normal_traction, 0.0);
    EXPECT_EQ(point.response.stored, 0.0);
  }
}

TEST_P(MixedModeVerification, TearingApartAcrossUnloadingAndClosureDissipatesTheSame) {
  for (const Softening softening : kSoftenings) {
    Point<2> point(without_dilatancy(softening));
    for (double opening : {1e-6, -0.5e-6, 10e-6, 0.0, 5e-6, 20e-6, -1e-6, 400e-6, -1e-6, 60e-6})
      point.go(opening, {}, GetParam());
    EXPECT_NEAR(point.lost.tension, 60.0, 60.0 * 1e-12);
    EXPECT_EQ(dissipated(point.lost), point.lost.tension);
  }
}

// Above what friction takes; the friction that stays acts from the first slip on. The stored energy of the
// closure is there from the start.
TEST_P(MixedModeVerification, ShearingOffUnderPressureDissipatesTheModeTwoEnergyAboveFriction) {
  for (const Softening softening : kSoftenings) {
    for (const double pressure : {0.0, 1e6, 20e6}) {
      Point<2> point(without_dilatancy(softening));
      const double opening = -pressure / point.properties.normal_stiffness, end = 800e-6;
      point.go(opening, {}, 1);
      point.go(opening, {{end}}, GetParam());
      const double friction = pressure * std::tan(point.properties.friction_angle);
      const double slip = end - friction / point.properties.shear_stiffness;
      EXPECT_EQ(point.internals.damage, 1.0);
      expect_known({"Law mixed_mode: energy of shearing off under pressure, above friction", "G_f2", "J/m2"},
                   point.lost.shear, 240.0, 240.0 * 1e-12);
      EXPECT_NEAR(point.lost.friction, friction * slip, 1e-12 * friction * slip);
      EXPECT_NEAR(point.response.shear_traction[0], friction, 1e-9 * friction);
      EXPECT_NEAR(point.internals.slip[0], slip, 1e-12 * slip);
    }
  }
}

TEST_P(MixedModeVerification, ReversedShearDissipatesTheModeTwoEnergyOnce) {
  for (const Softening softening : kSoftenings) {
    Point<2> point(without_dilatancy(softening));
    point.go(-1e-6, {}, 1);
    for (double slip : {30e-6, -20e-6, 60e-6, -800e-6, 800e-6}) point.go(-1e-6, {{slip}}, GetParam());
    expect_known({"Law mixed_mode: energy of shear to and fro", "G_f2", "J/m2"}, point.lost.shear, 240.0,
                 240.0 * 1e-12);
  }
}

/// Traction over strength at a share of the way from the beginning of softening to its end.
double left_in_tension(const Properties& p, double way) {
  Point<2> point(p);
  point.go(p.first_opening() + way * (p.last_opening() - p.first_opening()), {}, 3);
  EXPECT_NEAR(point.internals.damage, way, 1e-12);
  return point.response.normal_traction / p.tensile_strength;
}
double left_in_shear(const Properties& p, double way, double pressure) {
  Point<2> point(p);
  const double friction = pressure * std::tan(p.friction_angle), opening = -pressure / p.normal_stiffness;
  point.go(opening, {}, 1);
  const double slip = p.first_slip() + way * (p.last_slip() - p.first_slip());
  point.go(opening, {{slip + friction / p.shear_stiffness}}, 3);
  EXPECT_NEAR(point.internals.damage, way, 1e-12);
  return (point.response.shear_traction[0] - friction) / p.cohesion;
}

// Petersson: a third of the strength at an opening of 0.8 G_f / f_t, the end at 3.6 G_f / f_t. Both count
// from the end of the elastic branch, whose energy comes out of G_f: 0.3 % here, f_t^2 / (2 K_n) = 0.17 J/m².
TEST(MixedModeCurvesVerification, BilinearSofteningIsPeterssons) {
  const Properties p = without_dilatancy();
  const double unit = 60.0 / p.tensile_strength, first = p.first_opening();
  EXPECT_NEAR(p.last_opening() - first, 3.6 * unit, 0.003 * 3.6 * unit);
  for (const auto& [way, left] : {std::pair(1.0 / 9.0, 2.0 / 3.0), std::pair(2.0 / 9.0, 1.0 / 3.0),
                                  std::pair(11.0 / 18.0, 1.0 / 6.0)}) {
    expect_known({"Law mixed_mode: bilinear softening", "Petersson 1981", "f_t"}, left_in_tension(p, way),
                 left, 1e-11);
    for (const double pressure : {0.0, 5e6}) EXPECT_NEAR(left_in_shear(p, way, pressure), left, 1e-11);
  }
}

// e^(-7 D) less its last value; against the unbounded curve e^(-w f_t / G_f) that is at most 0.0018 f_t off.
TEST(MixedModeCurvesVerification, ExponentialSofteningEndsAfterSevenFoldDecay) {
  const Properties p = without_dilatancy(Softening::exponential);
  for (const double way : {0.01, 0.1, 0.25, 0.5, 0.9}) {
    const double left = (std::exp(-7.0 * way) - std::exp(-7.0)) / (1.0 - std::exp(-7.0));
    expect_known({"Law mixed_mode: exponential softening", "e^(-7 D), less its last value", "f_t"},
                 left_in_tension(p, way), left, 1e-11);
    EXPECT_NEAR(left_in_shear(p, way, 5e6), left, 1e-11);
    const double crack = way * (p.last_opening() - p.first_opening());
    const double unbounded =
        std::exp(-crack * p.tensile_strength / (60.0 - 0.5 * p.tensile_strength * p.first_opening()));
    EXPECT_NEAR(left, unbounded, 0.0019);
  }
}

// The first line goes down to f_t / 3, as steep as one that has a share of the energy; the tail has the rest.
// Shear stays linear. All that beside the elastic branch, whose energy comes out of G_f1.
TEST(MixedMode, ATailKeepsTheEnergyOfAFirstSlope) {
  for (const double share : {0.1, 0.4, 0.9, 1.0, 3.0}) {
    Properties p = without_dilatancy(Softening::tailed);
    p.initial_share = share;
    const double first = p.first_opening(), left = p.mode_1_energy / p.tensile_strength - 0.5 * first;
    const double line = 2.0 * std::min(share, 1.0) * left, end = p.last_opening() - first;
    EXPECT_NEAR(0.5 * (2.0 / 3.0 * line + end / 3.0), left, 1e-12 * left);  // area of both lines
    for (const double crack : {0.1 * line, 0.5 * line, 2.0 / 3.0 * line, 0.8 * line, 0.9 * end}) {
      const double in_tail = (end - crack) / (end - 2.0 / 3.0 * line) / 3.0;
      Point<2> point(p);
      point.go(first + crack, {}, 3);
      EXPECT_NEAR(point.response.normal_traction / p.tensile_strength, std::max(1.0 - crack / line, in_tail),
                  1e-11);
    }
    for (const double way : {0.3, 0.9}) EXPECT_NEAR(left_in_shear(p, way, 5e6), 1.0 - way, 1e-11);
  }
}

// With linear softening the tension curve is that of the paper's law.
TEST(MixedMode, LinearSofteningInTensionIsThatOfTheCohesiveLaw) {
  Point<2> point(without_dilatancy(Softening::linear));
  const auto cohesive = Cohesive::derive(mortar_contact());
  Cohesive::Internals<2, double> internals;
  Cohesive::Losses<double> lost{};
  for (double opening : {0.1e-6, 1e-6, 20e-6, 3e-6, -3e-6, 40e-6, 47e-6, 60e-6}) {
    const auto expected = Cohesive::update<2, double>(cohesive, opening, {}, internals, lost);
    point.take_to(opening, {});
    EXPECT_NEAR(point.response.normal_traction, expected.normal_traction,
                1e-12 * point.properties.tensile_strength);
    EXPECT_NEAR(point.lost.tension, lost.tension, 60.0 * 1e-12);
    EXPECT_EQ(point.lost.compression, lost.compression);
    EXPECT_EQ(point.internals.closure, internals.closure);
  }
}

// (sigma / f_t)^2 + (tau / c_o)^2 = 1 in tension, tau = c_o + p tan(phi) under pressure.
TEST(MixedMode, DamageBeginsOnTheQuadraticCriterion) {
  const Properties p = without_dilatancy();
  const auto damage_at = [&](double sigma, double tau) {
    Point<2> point(p);
    point.take_to(sigma / p.normal_stiffness, {{tau / p.shear_stiffness}});
    EXPECT_NEAR(point.response.normal_traction, sigma, 1e-5 * p.tensile_strength);
    EXPECT_NEAR(point.response.shear_traction[0], tau, 1e-5 * p.cohesion);
    return point.internals.damage;
  };
  for (const double angle : {0.0, 0.3, 0.8, 1.2, 1.57}) {
    const double sigma = std::cos(angle) * p.tensile_strength, tau = std::sin(angle) * p.cohesion;
    EXPECT_EQ(damage_at(sigma * (1.0 - 1e-9), tau * (1.0 - 1e-9)), 0.0);
    EXPECT_GT(damage_at(sigma * (1.0 + 1e-9), -tau * (1.0 + 1e-9)), 0.0);
  }
  for (const double pressure : {1e6, 5e6, 30e6}) {
    const double tau = p.cohesion + pressure * std::tan(p.friction_angle);
    EXPECT_EQ(damage_at(-pressure, tau * (1.0 - 1e-9)), 0.0);
    EXPECT_GT(damage_at(-pressure, -tau * (1.0 + 1e-9)), 0.0);
  }
}

// (u_n / u_fn)^2 + (u_s / u_fs)^2 = 1
TEST(MixedMode, DamageEndsOnTheQuadraticCriterion) {
  for (const Softening softening : kSoftenings) {
    const Properties p = without_dilatancy(softening);
    for (const double angle : {0.0, 0.3, 0.8, 1.2, 1.57}) {
      const double opening = std::cos(angle) * p.last_opening(), slip = std::sin(angle) * p.last_slip();
      Point<2> point(p);
      point.go((1.0 - 1e-9) * opening, {{(1.0 - 1e-9) * slip}}, 10);
      EXPECT_LT(point.internals.damage, 1.0);
      point.go((1.0 + 1e-9) * opening, {{(1.0 + 1e-9) * slip}}, 1);
      EXPECT_EQ(point.internals.damage, 1.0);
    }
  }
}

// Where u_f / u_0 is the same in both modes the shares of the modes are constant on a straight way, and
// G_I / G_f1 + G_II / G_f2 = 1. 1e-11: then the bookkeeping is exact in any number of steps.
TEST_P(MixedModeVerification, AStraightWayFollowsTheLinearEnergyCriterion) {
  for (const Softening softening : kSoftenings) {
    Properties p = without_dilatancy(softening);
    p.initial_share = 1.0;  // no tail
    p.mode_2_energy =
        p.cohesion * p.first_slip() * p.mode_1_energy / (p.tensile_strength * p.first_opening());
    ASSERT_NEAR(p.last_slip() / p.first_slip(), p.last_opening() / p.first_opening(), 1e-9);
    Point<2> point(p);
    point.go(0.9 * p.last_opening(), {{0.6 * p.last_slip()}}, GetParam());
    ASSERT_EQ(point.internals.damage, 1.0);
    EXPECT_NEAR(point.lost.tension / p.mode_1_energy, 0.81 / (0.81 + 0.36), 1e-11);
    EXPECT_NEAR(point.lost.shear / p.mode_2_energy, 0.36 / (0.81 + 0.36), 1e-11);
  }
}

// Otherwise the sum stays near one: within 0.12 % for the ratios of Table 2, u_f / u_0 = 635 and 457.
TEST(MixedModeCurvesVerification, AStraightWayStaysNearTheLinearEnergyCriterion) {
  for (const Softening softening : kSoftenings) {
    for (const double angle : {0.1, 0.4, 0.8, 1.2, 1.5}) {
      Point<2> point(without_dilatancy(softening));
      Properties& p = point.properties;
      p.initial_share = 1.0;  // no tail
      point.go(1.1 * std::cos(angle) * p.last_opening(), {{1.1 * std::sin(angle) * p.last_slip()}}, 20000);
      ASSERT_EQ(point.internals.damage, 1.0);
      expect_known(
          {"Law mixed_mode: G_I / G_f1 + G_II / G_f2 on a straight way", "linear energy criterion", "1"},
          point.lost.tension / 60.0 + point.lost.shear / 240.0, 1.0, 0.0012);
    }
  }
}

TEST(MixedMode, UnloadsToTheOriginAndLoadsBackTheSameWay) {
  for (const Softening softening : kSoftenings) {
    const Properties p = without_dilatancy(softening);
    const double opening = 0.4 * p.last_opening(), slip = 0.3 * p.last_slip();
    Point<2> point(p);
    point.go(opening, {{slip}}, 100);
    const auto loaded = point.response;
    const Losses lost = point.lost;
    const double damage = point.internals.damage;
    ASSERT_GT(loaded.normal_traction, 1e3);
    ASSERT_GT(loaded.shear_traction[0], 1e3);
    for (const double share : {0.75, 0.25, 0.0, 0.5, 1.0}) {
      point.go(share * opening, {{share * slip}}, 5);
      EXPECT_NEAR(point.response.normal_traction, share * loaded.normal_traction,
                  1e-12 * loaded.normal_traction);
      EXPECT_NEAR(point.response.shear_traction[0], share * loaded.shear_traction[0],
                  1e-12 * loaded.shear_traction[0]);
      EXPECT_EQ(dissipated(point.lost), dissipated(lost));
      EXPECT_EQ(point.internals.damage, damage);
    }
  }
}

TEST(MixedMode, WhatIsBrokenRubsBothWays) {
  const Properties p = without_dilatancy();
  Point<2> point(p);
  point.take_to(2.0 * p.last_opening(), {{5e-6}});
  EXPECT_EQ(point.response.shear_traction[0], 0.0);
  const double opening = -2e-6;  // beyond f_cm
  point.take_to(opening, {{5e-6}});
  EXPECT_EQ(point.response.shear_traction[0], 0.0);  // it closed where it stood
  const double pressure = -point.response.normal_traction;
  EXPECT_GT(pressure, p.compressive_limit);
  const double friction = pressure * std::tan(p.friction_angle);
  const Losses closed = point.lost;
  point.take_to(opening, {{100e-6}});
  EXPECT_NEAR(point.response.shear_traction[0], friction, 1e-9 * friction);
  point.take_to(opening, {{100e-6 - friction / p.shear_stiffness}});  // sticks
  EXPECT_NEAR(point.response.shear_traction[0], 0.0, 1e-9 * friction);
  point.take_to(opening, {{-50e-6}});
  EXPECT_NEAR(point.response.shear_traction[0], -friction, 1e-9 * friction);
  const double slid = 95e-6 - friction / p.shear_stiffness + 150e-6 - 2.0 * friction / p.shear_stiffness;
  EXPECT_NEAR(point.lost.slip_path - closed.slip_path, slid, 1e-12 * slid);
  EXPECT_NEAR(point.lost.friction - closed.friction, friction * slid, 1e-12 * friction * slid);
}

// A damaged contact holds bond and friction side by side: tau = (1 - d) K_s u + d p tan(phi) while it slides.
TEST(MixedMode, FrictionActsOnTheShareThatIsBroken) {
  const Properties p = without_dilatancy();
  Point<2> point(p);
  point.take_to(0.2 * p.last_opening(), {});
  const double damage = point.internals.damage;
  const double strength = std::max(1.0 - 3.0 * damage, 3.0 / 7.0 * (1.0 - damage));
  const double bond = strength / (1.0 + (p.last_slip() / p.first_slip() - 1.0) * damage);
  const double opening = -0.2e-6, slip = 2e-6;
  point.take_to(opening, {});
  point.take_to(opening, {{slip}});
  ASSERT_EQ(point.internals.damage, damage);
  const double friction = 0.2e-6 * p.normal_stiffness * std::tan(p.friction_angle);
  const double expected = bond * p.shear_stiffness * slip + (1.0 - bond) * friction;
  EXPECT_NEAR(point.response.shear_traction[0], expected, 1e-11 * expected);
}

TEST(MixedMode, OpenAfterSlipCarriesNoShearAndForgetsWhereItSlid) {
  Point<2> point(mixed_mode_contact());
  point.go(-1e-6, {}, 1);
  point.go(-1e-6, {{800e-6}}, 100);
  ASSERT_EQ(point.internals.damage, 1.0);
  const double touches = point.internals.dilation - point.internals.closure;
  ASSERT_GT(touches, 1e-6);
  point.take_to(touches + 1e-6, {{800e-6}});
  EXPECT_EQ(point.response.normal_traction, 0.0);
  EXPECT_EQ(point.response.shear_traction[0], 0.0);
  EXPECT_EQ(point.response.stored, 0.0);
  const Losses lost = point.lost;
  for (const double slip : {300e-6, -500e-6, 10e-6}) point.take_to(touches + 1e-6, {{slip}});
  EXPECT_EQ(dissipated(point.lost), dissipated(lost));
  EXPECT_EQ(point.internals.dilation - point.internals.closure, touches);
  point.take_to(touches - 1e-6, {{10e-6}});  // closes where dilation left it
  EXPECT_NEAR(point.response.normal_traction, -1e-6 * point.properties.normal_stiffness, 1.0);
  EXPECT_EQ(point.response.shear_traction[0], 0.0);
}

// Dilation is u_r tan(psi) (1 - e^(-path / u_r)) of the path of the slip, in any number of steps; the
// pressure that it raises at a held opening is part of the friction. 1e-12: the tolerance of Newton's method.
TEST_P(MixedModeVerification, DilatancyFadesWithTheSlip) {
  Properties p = mixed_mode_contact();
  p.compressive_limit = std::numeric_limits<double>::infinity();
  const double tan_psi = std::tan(p.dilatancy_angle);
  for (const double end : {110e-6, 400e-6, -300e-6}) {
    Point<2> point(p);
    point.take_to(2.0 * p.last_opening(), {});  // broken
    point.take_to(-0.1e-6, {});
    point.go(-0.1e-6, {{end}}, GetParam());
    const double path = point.lost.slip_path;
    EXPECT_NEAR(std::abs(point.internals.slip[0]), path, 1e-12 * path);
    const double dilation = p.fading_slip * tan_psi * (1.0 - std::exp(-path / p.fading_slip));
    EXPECT_NEAR(point.internals.dilation, dilation, 1e-12 * dilation);
    const double pressure = p.normal_stiffness * (0.1e-6 + dilation);
    EXPECT_NEAR(point.response.normal_traction, -pressure, 1e-9 * pressure);
    EXPECT_NEAR(std::abs(point.response.shear_traction[0]), pressure * std::tan(p.friction_angle),
                1e-9 * pressure);
  }
}

// At a pressure that is held, tan(psi) is the slope of the first slip, and after u_r a share of 1/e is left.
TEST(MixedMode, DilatancyBeginsWithPsiAndFallsByTheFactorE) {
  Properties p = mixed_mode_contact();
  p.compressive_limit = std::numeric_limits<double>::infinity();
  Point<2> point(p);
  point.take_to(2.0 * p.last_opening(), {});
  const double pressed = 0.5e-6, friction = pressed * p.normal_stiffness * std::tan(p.friction_angle);
  const auto dilation_at = [&](double slip) {
    for (int round = 0; round < 60; ++round)  // the pressure settles
      point.take_to(point.internals.dilation - pressed, {{friction / p.shear_stiffness + slip}});
    EXPECT_NEAR(point.internals.slip[0], slip, 1e-12 * p.fading_slip);
    return point.internals.dilation;
  };
  // 1e-4: the slope is a difference over 1 nm, 1e-5 of u_r
  for (const double slip : {0.0, p.fading_slip}) {
    const double before = dilation_at(slip), after = dilation_at(slip + 1e-9);
    EXPECT_NEAR((after - before) / 1e-9, std::tan(p.dilatancy_angle) * std::exp(-slip / p.fading_slip), 1e-4);
  }
}

// On combined ways the trapezoidal work and the books agree with the order one of the step or better; 1e-5 is
// what is left at the finest step.
template <int Dim>
void expect_that_work_is_accounted_for(const Properties& p) {
  const auto missing = [&](int steps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Point<Dim> point(p);
    for (int leg = 0; leg < 12; ++leg) {
      const double opening = 6e-6 * uniform(random);
      Tangential<Dim> shear;
      for (int i = 0; i + 1 < Dim; ++i) shear[i] = 40e-6 * uniform(random);
      point.go(opening, shear, steps);
    }
    Tangential<Dim> far{};
    far[0] = 10e-6;
    point.go(2.0 * p.last_opening(), far, steps);  // torn and open ...
    far[0] = -30e-6;
    point.go(-2e-6, far, steps);  // ... and closed again
    EXPECT_GT(point.lost.tension, 1.0);
    EXPECT_GT(point.lost.shear, 1.0);
    EXPECT_GT(point.lost.friction, 1.0);
    EXPECT_GT(point.lost.compression, 1.0);
    return std::abs(point.missing());
  };
  const double coarse = missing(2000), fine = missing(20000);
  EXPECT_LT(fine, 1e-4);
  EXPECT_LT(fine, 0.2 * coarse);
}

TEST(MixedMode, WorkGoesIntoStoredAndDissipatedEnergy) {
  for (const Softening softening : kSoftenings) {
    for (const double psi : {0.0, 25.0, 34.0}) {
      Properties p = without_dilatancy(softening);
      p.dilatancy_angle = std::min(psi * kDegree, p.friction_angle);
      expect_that_work_is_accounted_for<2>(p);
      expect_that_work_is_accounted_for<3>(p);
    }
  }
}

/// Random jumps of all sizes, and properties that change as with temperature.
class RandomPath {
 public:
  explicit RandomPath(unsigned seed) : random_(seed) {
    base_ = mixed_mode_contact();
    base_.softening = *(kSoftenings.begin() + seed % kSoftenings.size());
    base_.initial_share = 0.05 + uniform();
    const int dilatancy = static_cast<int>(seed % 4);
    base_.dilatancy_angle = dilatancy == 0   ? 0.0
                            : dilatancy == 1 ? base_.friction_angle
                                             : base_.friction_angle * uniform();
    if (seed % 5 == 0) base_.compression = Compression::reversible;
    if (seed % 7 == 0) base_.compressive_limit = std::numeric_limits<double>::infinity();
    scale_ = std::pow(10.0, -7.0 + 3.5 * uniform());  // m; the largest pressures are some 1000 f_cm
  }

  /// Hotter now and then, as between two exchanges.
  Properties properties() {
    const double hot = uniform() < 0.9 ? 0.0 : uniform();
    Properties p = base_;
    for (double* falls :
         {&p.normal_stiffness, &p.shear_stiffness, &p.tensile_strength, &p.cohesion, &p.compressive_limit})
      *falls *= 1.0 - 0.9 * hot;
    p.mode_1_energy *= 1.0 - 0.5 * hot;
    p.mode_2_energy *= 1.0 - 0.4 * hot;
    p.fading_slip *= 1.0 + hot;
    return p;
  }
  double opening() { return rest() ? 0.0 : scale_ * (uniform() - 0.6) * (uniform() < 0.2 ? 3.0 : 1.0); }
  double shear() { return rest() ? 0.0 : scale_ * 2.0 * (uniform() - 0.5) * (uniform() < 0.2 ? 10.0 : 1.0); }

 private:
  double uniform() { return distribution_(random_); }
  bool rest() { return uniform() < 0.1; }

  std::mt19937 random_;
  std::uniform_real_distribution<double> distribution_;
  Properties base_;
  double scale_;
};

template <int Dim>
auto numbers(const ContactResponse<Dim>& r, const Internals<Dim>& h, const Losses& l) {
  std::vector<double> all{r.normal_traction, r.stored, r.shear_traction[0], r.shear_traction[Dim - 2]};
  Internals<Dim>::each([&](const auto&, double number) { all.push_back(number); }, h);
  Losses::each([&](const auto&, double number) { all.push_back(number); }, l);
  return all;
}

// Whatever the way, the pressure and the change of properties: no damage heals, nothing is won back, and the
// law at the jump where it stands gives all the same numbers again.
template <int Dim>
void expect_no_gain() {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    RandomPath path(seed);
    Internals<Dim> internals;
    Losses lost{};
    for (int i = 0; i < 50; ++i) {
      const Properties p = path.properties();
      ASSERT_EQ(MixedMode::check(p).key, nullptr);
      const auto c = MixedMode::derive(p);
      const double opening = path.opening();
      Tangential<Dim> shear;
      for (int k = 0; k + 1 < Dim; ++k) shear[k] = path.shear();
      const auto before = internals;
      const auto lost_before = lost;
      const auto r = MixedMode::update<Dim, double>(c, opening, shear, internals, lost);
      ASSERT_GE(internals.damage, before.damage);
      ASSERT_LE(internals.damage, 1.0);
      ASSERT_GE(internals.closure, before.closure);
      ASSERT_GE(internals.dilation, before.dilation);
      Losses::each([](const LossInfo& info, double now, double was) { ASSERT_GE(now, was) << info.name; },
                   lost, lost_before);
      ASSERT_GE(r.stored, 0.0);
      ASSERT_LE(r.normal_traction, p.tensile_strength * (1.0 + 1e-12));
      const auto once = numbers<Dim>(r, internals, lost);
      const auto again = MixedMode::update<Dim, double>(c, opening, shear, internals, lost);
      ASSERT_EQ(numbers<Dim>(again, internals, lost), once) << "path " << seed << ", step " << i;
    }
  }
}
TEST(MixedMode, NothingHealsAndNothingIsWonBackIn2D) {
  expect_no_gain<2>();
}
TEST(MixedMode, NothingHealsAndNothingIsWonBackIn3D) {
  expect_no_gain<3>();
}

using Real = Lanes<Portable>;
struct LaneSum {
  Real sum = 0.0;
  void operator+=(const Real& more) { sum += more; }
};

// The promise: lanes have the bits of single numbers. Other instruction sets: tests/mechanics.
template <int Dim>
void expect_lanes_alike() {
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomPath path(seed);
    MixedMode::Internals<Dim, Real> internals;
    MixedMode::Losses<LaneSum> losses;
    Internals<Dim> of_lane_alone[kLanes];
    Losses lost[kLanes]{};
    for (int i = 0; i < 50; ++i) {
      const auto c = MixedMode::derive(path.properties());
      alignas(64) double jump[Dim][kLanes];
      for (int lane = 0; lane < kLanes; ++lane) {
        jump[0][lane] = path.opening();
        for (int k = 1; k < Dim; ++k) jump[k][lane] = path.shear();
      }
      Tangential<Dim, Real> shears;
      for (int k = 1; k < Dim; ++k) shears[k - 1] = Real::load(jump[k]);
      const auto r = MixedMode::update<Dim>(c, Real::load(jump[0]), shears, internals, losses);
      for (int lane = 0; lane < kLanes; ++lane) {
        Tangential<Dim> shear;
        for (int k = 1; k < Dim; ++k) shear[k - 1] = jump[k][lane];
        const auto one =
            MixedMode::update<Dim, double>(c, jump[0][lane], shear, of_lane_alone[lane], lost[lane]);
        const auto of_lane = [&](const Real& number) {
          alignas(64) double all[kLanes];
          number.store(all);
          return all[lane];
        };
        const auto expect_same = [&](double number, const Real& in_lanes) {
          ASSERT_EQ(std::bit_cast<std::uint64_t>(of_lane(in_lanes)), std::bit_cast<std::uint64_t>(number))
              << "path " << seed << ", step " << i;
        };
        expect_same(one.normal_traction, r.normal_traction);
        for (int k = 0; k + 1 < Dim; ++k) expect_same(one.shear_traction[k], r.shear_traction[k]);
        expect_same(one.stored, r.stored);
        std::vector<Real> remembered, dissipated;
        MixedMode::Internals<Dim, Real>::each([&](const auto&, const Real& n) { remembered.push_back(n); },
                                              internals);
        MixedMode::Losses<LaneSum>::each([&](const auto&, const LaneSum& n) { dissipated.push_back(n.sum); },
                                         losses);
        auto next = remembered.begin();
        Internals<Dim>::each([&](const auto&, double n) { expect_same(n, *next++); }, of_lane_alone[lane]);
        next = dissipated.begin();
        Losses::each([&](const auto&, double n) { expect_same(n, *next++); }, lost[lane]);
      }
    }
  }
}
TEST(MixedMode, EightLanesHaveTheBitsOfOneNumberIn2D) {
  expect_lanes_alike<2>();
}
TEST(MixedMode, EightLanesHaveTheBitsOfOneNumberIn3D) {
  expect_lanes_alike<3>();
}

TEST(MixedMode, IsIsotropicInTheContactPlane) {
  const Properties p = mixed_mode_contact();
  Point<2> flat(p);
  Point<3> solid(p);
  const double angle = 0.7;
  const std::pair<double, double> way[] = {{-0.4e-6, 0.3e-6}, {-0.4e-6, 5e-6}, {3e-6, 30e-6},
                                           {-0.2e-6, 20e-6},  {-5e-6, -4e-6},  {-5e-6, 150e-6},
                                           {-9e-6, -80e-6},   {20e-6, -90e-6}};
  for (const auto& [opening, slip] : way) {
    const auto& a = flat.take_to(opening, {{slip}});
    const auto& b = solid.take_to(opening, {{slip * std::cos(angle), slip * std::sin(angle)}});
    const double along = b.shear_traction[0] * std::cos(angle) + b.shear_traction[1] * std::sin(angle);
    const double across = b.shear_traction[1] * std::cos(angle) - b.shear_traction[0] * std::sin(angle);
    // round-off of tractions of some 100 MPa
    EXPECT_NEAR(a.shear_traction[0], along, 1e-4);
    EXPECT_NEAR(across, 0.0, 1e-4);
    EXPECT_NEAR(a.normal_traction, b.normal_traction, 1e-4);
    EXPECT_NEAR(flat.internals.damage, solid.internals.damage, 1e-12);
    EXPECT_NEAR(flat.internals.dilation, solid.internals.dilation, 1e-12 * p.fading_slip);
  }
}

TEST(MixedMode, RefusesParametersThatCannotMakeALaw) {
  const auto refused = [](auto change, const std::string& named) {
    Properties p = mixed_mode_contact();
    change(p);
    try {
      validate(p, "mortar-mortar");
    } catch (const Error& e) {
      return std::string(e.what()).find(named) != std::string::npos;
    }
    return false;
  };
  EXPECT_NO_THROW(validate(mixed_mode_contact(), "mortar-mortar"));
  EXPECT_TRUE(refused([](auto& p) { p.tensile_strength = 0.0; }, "f_t"));
  EXPECT_TRUE(refused([](auto& p) { p.cohesion = 0.0; }, "c_o"));
  EXPECT_TRUE(refused([](auto& p) { p.fading_slip = 0.0; }, "u_r"));
  EXPECT_TRUE(refused([](auto& p) { p.dilatancy_angle = 1.001 * p.friction_angle; }, "psi"));
  // exactly what the elastic branch stores is too little
  EXPECT_TRUE(
      refused([](auto& p) { p.mode_1_energy = 0.5 * p.tensile_strength * p.first_opening(); }, "G_f1"));
  EXPECT_TRUE(refused([](auto& p) { p.mode_2_energy = 0.5 * p.cohesion * p.first_slip(); }, "G_f2"));
}

TEST(MixedMode, ItsDamageIsKnownAsMixed) {
  int mixed = 0;
  for (const InternalInfo& info : table_of<MixedMode>().internals(2))
    mixed += info.what == Remembers::mixed_damage;
  EXPECT_EQ(mixed, 1);
}

}  // namespace
}  // namespace pyroclast
