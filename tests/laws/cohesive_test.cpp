#include "pyroclast/laws/cohesive.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/contact_properties.hpp"
#include "pyroclast/laws/elastic.hpp"
#include "table_2.hpp"

namespace pyroclast {
namespace {

using Properties = Cohesive::Properties<double>;
template <int Dim>
using Internals = Cohesive::Internals<Dim, double>;

/// What one update loses.
struct Dissipated {
  double tension = 0.0, shear = 0.0, friction = 0.0, compression = 0.0;

  double total() const { return tension + shear + friction + compression; }
  Dissipated& operator+=(const Dissipated& o) {
    tension += o.tension;
    shear += o.shear;
    friction += o.friction;
    compression += o.compression;
    return *this;
  }
};

template <int Dim>
struct Response : ContactResponse<Dim> {
  double slip_path = 0.0;  ///< m
  Dissipated dissipated;   ///< J/m²
};

template <int Dim>
Response<Dim> update_contact(const Properties& properties, double opening, const Tangential<Dim>& tangential,
                             Internals<Dim>& internals) {
  Cohesive::Losses<double> lost{};
  const auto response =
      Cohesive::update<Dim, double>(Cohesive::derive(properties), opening, tangential, internals, lost);
  return {response, lost.slip_path, {lost.tension, lost.shear, lost.friction, lost.compression}};
}

template <int Dim>
struct Path {
  Properties properties = mortar_contact();
  Internals<Dim> internals;
  Response<Dim> response;
  Dissipated dissipated;
  double work = 0.0;

  /// Goes straight to a jump in a number of equal steps, adding up energies and the trapezoidal work.
  void go(double opening, Tangential<Dim> tangential, int steps) {
    const double from_opening = at_opening;
    const Tangential<Dim> from = at_tangential;
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const double next_opening = from_opening + share * (opening - from_opening);
      const Tangential<Dim> next = from + share * (tangential - from);
      const auto before = response;
      response = update_contact<Dim>(properties, next_opening, next, internals);
      work += 0.5 * (before.normal_traction + response.normal_traction) * (next_opening - at_opening) +
              0.5 * dot(before.shear_traction + response.shear_traction, next - at_tangential);
      dissipated += response.dissipated;
      accumulated_slip += response.slip_path;
      at_opening = next_opening;
      at_tangential = next;
    }
  }

  double at_opening = 0.0;
  Tangential<Dim> at_tangential{};
  double accumulated_slip = 0.0;
};

class CohesiveVerification : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Steps, CohesiveVerification, testing::Values(1, 7, 1000));

// The promise: fracture energies are exact in any number of steps. 1e-12: closed forms, only round-off is
// left.
TEST_P(CohesiveVerification, TearingApartDissipatesTheModeOneEnergy) {
  Path<2> path;
  path.go(100e-6, {}, GetParam());
  expect_known({"Law cohesive: energy of tearing apart", "G_f1", "J/m2"}, path.dissipated.tension, 60.0,
               60.0 * 1e-12);
  EXPECT_EQ(path.dissipated.total(), path.dissipated.tension);
  EXPECT_EQ(path.response.stored, 0.0);
  EXPECT_EQ(path.response.normal_traction, 0.0);
}

TEST_P(CohesiveVerification, TearingApartAcrossUnloadingAndClosureDissipatesTheSame) {
  Path<2> path;
  for (double opening : {1e-6, -0.5e-6, 10e-6, 0.0, 5e-6, 20e-6, -1e-6, 100e-6, -1e-6, 60e-6})
    path.go(opening, {}, GetParam());
  expect_known({"Law cohesive: energy of tearing apart across unloading and closure", "G_f1", "J/m2"},
               path.dissipated.tension, 60.0, 60.0 * 1e-12);
  EXPECT_EQ(path.dissipated.total(), path.dissipated.tension);
}

TEST_P(CohesiveVerification, ShearingUnderPressureDissipatesTheModeTwoEnergyAboveTheResidualLine) {
  for (double pressure : {0.0, 1e6, 20e6}) {
    Path<2> path;
    const double opening = -pressure / path.properties.normal_stiffness;
    path.go(opening, {}, 1);
    path.go(opening, {{200e-6}}, GetParam());
    const double residual =
        path.properties.residual_cohesion + pressure * std::tan(path.properties.friction_angle);
    expect_known(
        {"Law cohesive: energy of shearing off under pressure, above the residual line", "G_f2", "J/m2"},
        path.dissipated.shear, 240.0, 240.0 * 1e-12);
    EXPECT_NEAR(path.response.shear_traction[0], residual, residual * 1e-9);
    EXPECT_NEAR(path.dissipated.friction, residual * path.accumulated_slip, 1e-9 * residual);
  }
}

TEST_P(CohesiveVerification, ReversedShearDissipatesTheModeTwoEnergyOnce) {
  Path<2> path;
  path.go(-1e-6, {}, 1);
  for (double slip : {30e-6, -20e-6, 40e-6, -200e-6, 200e-6}) path.go(-1e-6, {{slip}}, GetParam());
  expect_known({"Law cohesive: energy of shear to and fro", "G_f2", "J/m2"}, path.dissipated.shear, 240.0,
               240.0 * 1e-12);
}

TEST_P(CohesiveVerification, CompressionIsBilinearAndIrreversible) {
  const double u_limit = 31e6 / 18400e9;
  Path<2> path;
  path.go(-5.0 * u_limit, {}, GetParam());
  const double expected = -(31e6 + 0.05 * 18400e9 * 4.0 * u_limit);  // Eq. (15)
  expect_known({"Law cohesive: traction of crushing", "the paper, Eq. (15)", "Pa"},
               path.response.normal_traction, expected, 1e-12 * std::abs(expected));
  const double closure = path.internals.closure;
  const double spent = path.dissipated.compression;
  EXPECT_NEAR(spent + path.response.stored, 0.5 * 31e6 * u_limit + 0.5 * (31e6 - expected) * 4.0 * u_limit,
              1e-12 * spent);
  path.go(-closure, {}, GetParam());
  EXPECT_NEAR(path.response.normal_traction, 0.0, 1e-6);  // Pa, round-off of 18400 GPa/m times 1e-21 m
  EXPECT_EQ(path.internals.closure, closure);
  path.go(-5.0 * u_limit, {}, GetParam());
  EXPECT_NEAR(path.dissipated.compression, spent, 1e-12 * spent);
}

// Monotone shear at constant normal traction follows Eqs. (13) and (14), with the slip that softens taken as
// u_s - tau/K_s (physics reading): at u_s^l all cohesion above the residual is gone.
TEST(CohesiveLineVerification, MonotoneShearFollowsThePapersSofteningLine) {
  const Properties p = mortar_contact();
  const double pressure = 5e6;
  const double peak = p.cohesion + pressure * std::tan(p.friction_angle);
  const double residual = p.residual_cohesion + pressure * std::tan(p.friction_angle);
  const double u_peak = peak / p.shear_stiffness;
  const double u_last = 2.0 * p.mode_2_energy / (peak - residual) + residual / p.shear_stiffness;
  for (double share : {0.1, 0.5, 0.9}) {
    Path<2> path;
    path.go(-pressure / p.normal_stiffness, {}, 1);
    const double u = u_peak + share * (u_last - u_peak);
    path.go(-pressure / p.normal_stiffness, {{u}}, 50);
    const double line = peak + (residual - peak) * share;
    expect_known(
        {"Law cohesive: shear traction that softens under pressure", "the paper, Eqs. (13) and (14)", "Pa"},
        path.response.shear_traction[0], line, 1e-9 * line);
  }
}

TEST(ContactLaw, WorkGoesIntoStoredAndDissipatedEnergy) {
  Path<2> path;
  // A fixed wild path through every branch; the trapezoidal work converges to the closed forms with the step.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int leg = 0; leg < 12; ++leg) path.go(6e-6 * uniform(random), {{40e-6 * uniform(random)}}, 200000);
  path.go(70e-6, {{10e-6}}, 200000);   // torn and open ...
  path.go(-2e-6, {{-30e-6}}, 200000);  // ... and closed again
  const double accounted = path.response.stored + path.dissipated.total();
  EXPECT_GT(path.dissipated.tension, 0.0);
  EXPECT_GT(path.dissipated.shear, 0.0);
  EXPECT_GT(path.dissipated.friction, 0.0);
  EXPECT_GT(path.dissipated.compression, 0.0);
  // 1e-4: the quadrature's own error at this step, second order except at the corners of the law
  EXPECT_NEAR(path.work, accounted, 1e-4 * accounted);
}

TEST(ContactLaw, TensionLowersTheShearStrengthAndNeverBelowZero) {
  Properties p = mortar_contact();
  Internals<2> internals;
  const double opening = 0.5 * p.elastic_opening();
  auto r = update_contact<2>(p, opening, {{1e-6}}, internals);
  EXPECT_NEAR(r.shear_traction[0], p.cohesion - 0.5 * p.tensile_strength * std::tan(p.friction_angle),
              0.02 * p.cohesion);  // softened by less than 2 % over 1 um of slip
  p.cohesion = 0.1e6;
  internals = {};
  r = update_contact<2>(p, opening, {{1e-6}}, internals);
  EXPECT_EQ(r.shear_traction[0], 0.0);
}

TEST(ContactLaw, BrokenAndOpenCarriesNothingAndClosedCarriesFriction) {
  const Properties p = mortar_contact();
  Internals<2> internals;
  update_contact<2>(p, 0.0, {{0.3e-6}}, internals);
  auto r = update_contact<2>(p, 60e-6, {{0.3e-6}}, internals);
  EXPECT_EQ(r.normal_traction, 0.0);
  EXPECT_EQ(r.shear_traction[0], 0.0);
  EXPECT_EQ(r.stored, 0.0);
  r = update_contact<2>(p, -1e-6, {{0.3e-6}}, internals);
  EXPECT_NEAR(r.normal_traction, -1e-6 * p.normal_stiffness, 1.0);
  EXPECT_EQ(internals.tension_damage, 1.0);
}

// The bond that tears releases the shear it held, once; an open crack that goes on moving costs nothing.
TEST(ContactLaw, TearingUnderShearReleasesTheShearHeldAndNothingMore) {
  const Properties p = mortar_contact();
  Internals<2> internals;
  const double before = update_contact<2>(p, 0.0, {{0.3e-6}}, internals).stored;
  const auto torn = update_contact<2>(p, 60e-6, {{0.3e-6}}, internals);
  EXPECT_NEAR(torn.dissipated.shear, before, 1e-12 * before);
  for (double slip : {1e-6, 50e-6, -80e-6})
    EXPECT_EQ(update_contact<2>(p, 60e-6, {{slip}}, internals).dissipated.total(), 0.0);
}

TEST(ContactLaw, DamageNeverHealsAlongARandomPath) {
  const Properties p = mortar_contact();
  Internals<2> internals;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double opening = 0.0, slip = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const auto before = internals;
    opening += 0.3e-6 * normal(random) - 0.02 * opening;
    slip += 1e-6 * normal(random);
    const auto r = update_contact<2>(p, opening, {{slip}}, internals);
    ASSERT_GE(internals.tension_damage, before.tension_damage);
    ASSERT_GE(internals.shear_damage, before.shear_damage);
    ASSERT_GE(internals.closure, before.closure);
    ASSERT_GE(r.dissipated.tension, 0.0);
    ASSERT_GE(r.dissipated.shear, 0.0);
    ASSERT_GE(r.dissipated.friction, 0.0);
    ASSERT_GE(r.dissipated.compression, 0.0);
    ASSERT_GE(r.stored, 0.0);
    ASSERT_LE(r.normal_traction, p.tensile_strength * (1.0 + 1e-12));
  }
}

// A drop in friction under a pressure beyond f_cm makes the envelope fall more steeply than K_s. Nothing can
// follow it: the point falls to the residual line at once, damage ends at 1, and stored energy plus losses
// stay the work that was done. 1e-9: the fall itself is a jump, the rest closed forms and a quadrature of
// lines.
TEST(ContactLaw, ADropTooSteepToFollowFallsToTheResidualLineAtOnce) {
  for (const double residual_angle : {0.0, 5.0}) {
    Properties p = mortar_contact();
    p.residual_friction_angle = residual_angle * std::numbers::pi / 180.0;
    ASSERT_NO_THROW(validate(p, "mortar"));
    Internals<2> internals;
    const double opening = -100e-6;
    const auto pressed = update_contact<2>(p, opening, {}, internals);
    const double pressure = -pressed.normal_traction;
    const double residual = p.residual_cohesion + pressure * std::tan(p.residual_friction_angle);
    const double peak = p.cohesion + pressure * std::tan(p.friction_angle);
    const double k = p.shear_stiffness;
    ASSERT_GT((peak - residual) * (peak - residual) / (2.0 * k), p.mode_2_energy);
    const double end = 1.2 * peak / k;
    double shear = 0.0, friction = 0.0, stored = 0.0;
    for (int i = 1; i <= 100; ++i) {
      const auto r = update_contact<2>(p, opening, {{end * i / 100}}, internals);
      ASSERT_GE(internals.shear_damage, 0.0);
      ASSERT_LE(internals.shear_damage, 1.0);
      ASSERT_LE(std::abs(r.shear_traction[0]), peak * (1.0 + 1e-12));
      ASSERT_GE(r.dissipated.shear, 0.0);
      ASSERT_GE(r.dissipated.friction, 0.0);
      shear += r.dissipated.shear;
      friction += r.dissipated.friction;
      stored = r.stored;
    }
    EXPECT_EQ(internals.shear_damage, 1.0);
    EXPECT_NEAR(shear, (peak - residual) * (peak - residual) / (2.0 * k), 1e-9 * shear);
    const double work = 0.5 * peak * peak / k + residual * (end - peak / k);
    EXPECT_NEAR(stored - pressed.stored + shear + friction, work, 1e-9 * work);
  }
}

// Whatever the friction that is left and the pressure: damage stays in [0, 1] and never falls, nothing is
// won back.
TEST(ContactLaw, DamageStaysInBoundsUnderAnyPressure) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int path = 0; path < 200; ++path) {
    Properties p = mortar_contact();
    p.friction_angle = std::atan(uniform(random));
    p.residual_friction_angle = p.friction_angle * uniform(random);
    Internals<2> internals;
    double opening = 0.0, slip = 0.0;
    for (int i = 0; i < 200; ++i) {
      const auto before = internals;
      opening = 2e-6 - 200e-6 * uniform(random);
      slip += 100e-6 * (uniform(random) - 0.5);
      const auto r = update_contact<2>(p, opening, {{slip}}, internals);
      ASSERT_GE(internals.shear_damage, before.shear_damage);
      ASSERT_LE(internals.shear_damage, 1.0);
      ASSERT_GE(r.dissipated.shear, 0.0);
      ASSERT_GE(r.dissipated.friction, 0.0);
    }
  }
}

TEST(ContactLaw, IsIsotropicInTheContactPlane) {
  const Properties p = mortar_contact();
  Internals<2> flat;
  Internals<3> solid;
  const double angle = 0.7;
  for (double slip : {0.3e-6, 5e-6, 30e-6, 20e-6, -4e-6, 150e-6}) {
    const auto a = update_contact<2>(p, -0.4e-6, {{slip}}, flat);
    const auto b = update_contact<3>(p, -0.4e-6, {{slip * std::cos(angle), slip * std::sin(angle)}}, solid);
    const double along = b.shear_traction[0] * std::cos(angle) + b.shear_traction[1] * std::sin(angle);
    const double across = b.shear_traction[1] * std::cos(angle) - b.shear_traction[0] * std::sin(angle);
    // round-off relative to the tractions in play, of some MPa
    EXPECT_NEAR(a.shear_traction[0], along, 1e-6);
    EXPECT_NEAR(across, 0.0, 1e-6);
    EXPECT_NEAR(flat.shear_damage, solid.shear_damage, 1e-14);
  }
}

TEST(ContactLaw, ElasticContactNeverFails) {
  const Elastic::Properties<double> p{18400e9, 7660e9};
  Elastic::Internals<2, double> internals;
  Elastic::Losses<double> lost;
  const auto r = Elastic::update<2, double>(Elastic::derive(p), 1e-3, {{-2e-3}}, internals, lost);
  EXPECT_DOUBLE_EQ(r.normal_traction, p.normal_stiffness * 1e-3);
  EXPECT_DOUBLE_EQ(r.shear_traction[0], p.shear_stiffness * -2e-3);
}

TEST(ContactLaw, ReversibleCompressionRetracesTheBilinearCurve) {
  Path<2> path;
  path.properties.compression = Cohesive::Compression::reversible;
  path.go(-8e-6, {}, 10);
  const double down = path.response.normal_traction;
  EXPECT_NEAR(path.response.stored, path.work, 0.05 * path.work);
  path.go(-4e-6, {}, 10);
  path.go(-8e-6, {}, 10);
  EXPECT_EQ(path.response.normal_traction, down);
  EXPECT_EQ(path.dissipated.total(), 0.0);
  path.go(0.0, {}, 10);
  EXPECT_EQ(path.response.normal_traction, 0.0);
}

TEST(ContactLaw, CoupledCohesionFallsWithTensionDamage) {
  Properties p = mortar_contact();
  const auto sheared_after_opening = [&](bool coupled) {
    p.coupled = coupled;
    Internals<2> internals;
    update_contact<2>(p, 24e-6, {}, internals);  // D_t about one half
    return update_contact<2>(p, 0.0, {{0.45e-6}}, internals).shear_traction[0];
  };
  EXPECT_LT(sheared_after_opening(true), 0.7 * sheared_after_opening(false));
}

TEST(ContactLaw, RefusesParametersThatCannotMakeALaw) {
  const auto refused = [](auto change, const std::string& named) {
    Properties p = mortar_contact();
    change(p);
    try {
      validate(p, "mortar-mortar");
    } catch (const Error& e) {
      return std::string(e.what()).find(named) != std::string::npos;
    }
    return false;
  };
  EXPECT_NO_THROW(validate(mortar_contact(), "mortar-mortar"));
  EXPECT_TRUE(refused([](auto& p) { p.normal_stiffness = 0.0; }, "K_n"));
  EXPECT_TRUE(refused([](auto& p) { p.shear_stiffness = std::numeric_limits<double>::quiet_NaN(); }, "K_s"));
  EXPECT_TRUE(refused([](auto& p) { p.tensile_strength = -1.0; }, "f_t"));
  EXPECT_TRUE(refused([](auto& p) { p.hardening = 1.0; }, "beta"));
  EXPECT_TRUE(refused([](auto& p) { p.residual_cohesion = 2.0 * p.cohesion; }, "c_res"));
  EXPECT_TRUE(refused([](auto& p) { p.mode_1_energy = 0.1; }, "snaps back"));
  EXPECT_TRUE(refused([](auto& p) { p.mode_2_energy = 0.1; }, "snaps back"));
}

// Where friction drops, the envelope is steepest at the limit f_cm: tau_max - tau_res is larger there by f_cm
// times the drop of tan(phi).
TEST(ContactLaw, ObjectsToShearThatSnapsBackUnderPressure) {
  Properties p = mortar_contact();
  p.residual_friction_angle = 0.5 * p.friction_angle;
  const double drop =
      p.cohesion - p.residual_cohesion +
      p.compressive_limit * (std::tan(p.friction_angle) - std::tan(p.residual_friction_angle));
  const double bound = drop * drop / (2.0 * p.shear_stiffness);
  p.mode_2_energy = 0.999 * bound;
  const Objection objection = Cohesive::check(p);
  ASSERT_STREQ(objection.key, "G_f2");
  EXPECT_NEAR(objection.bound, bound, 1e-12 * bound);
  p.mode_2_energy = 1.001 * bound;
  EXPECT_EQ(Cohesive::check(p).key, nullptr);
}

}  // namespace
}  // namespace pyroclast
