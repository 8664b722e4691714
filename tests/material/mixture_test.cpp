#include "pyroclast/material/mixture.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

// Promise: a sparse inclusion and a full one are what is known of them.
TEST(Mixture, HasItsLimits) {
  const MixedPhase soft{1.0, 20e9, 0.2}, stiff{0.0, 45e9, 0.25};
  EXPECT_NEAR(Mixture<2>(soft, {}).young(), 20e9, 1.0);
  EXPECT_NEAR(Mixture<3>(soft, {stiff}).young(), 20e9, 1.0);
  EXPECT_NEAR(Mixture<2>({0.0, 20e9, 0.2}, {{1.0, 45e9, 0.25}}).young(), 45e9, 1.0);
  EXPECT_NEAR(Mixture<3>({0.0, 20e9, 0.2}, {{1.0, 45e9, 0.25}}).young(), 45e9, 1.0);
  EXPECT_NEAR(Mixture<2>({0.6, 20e9, 0.2}, {{0.4, 20e9, 0.2}}).young(), 20e9, 1.0);
  EXPECT_NEAR(Mixture<2>({0.6, 20e9, 0.2}, {{0.4, 20e9, 0.2}}).inclusion_weight(), 0.4, 1e-12);
  EXPECT_THROW(Mixture<2>({0.6, 20e9, 0.2}, {stiff, stiff}).inclusion_weight(), Error);
  // what creeps with all of its volume gives way as it does alone
  for (const double nu : {0.2, 0.3, 0.5}) {
    EXPECT_NEAR(Mixture<2>(soft, {}).creep_share(1.0, nu), 1.0, 1e-12);
    EXPECT_NEAR(Mixture<3>(soft, {}).creep_share(10.0, nu), 1.0, 1e-12);
  }
}

// Promise: rigid discs in a matrix of nu = 1/2 in plane stress stiffen it by G / G_M = 1 + f / [(1 - f) 5/8]
// and K / K_M = 1 + (4/3) f / (1 - f).
TEST(Mixture, OfRigidDiscsIsTheClosedForm) {
  const double f = 0.31;
  const Mixture<2> mixture({1.0 - f, 20e9, 0.5}, {{f, 20e18, 0.2}});
  const double K = 20e9 / (2.0 * 0.5), G = 20e9 / (2.0 * 1.5);
  const double K_c = K * (1.0 + 4.0 / 3.0 * f / (1.0 - f)), G_c = G * (1.0 + f / ((1.0 - f) * 0.625));
  EXPECT_NEAR(mixture.young(), 4.0 * K_c * G_c / (K_c + G_c), 1e-6 * 20e9);
}

// Promise: the specimens of the paper's concrete, E = 70 and 29.4 GPa with contacts of E / 1.6 mm every 3 mm,
// creep by the shares of the self-consistent scheme, as worked out apart; E and w are those of Mori and
// Tanaka.
TEST(Mixture, HasTheSharesOfThePapersConcrete) {
  const double contacts = 1.0 + 1.6 / 3.0;
  const auto of = [&](double f) {
    return Mixture<2>({1.0 - f, 29.4e9 / contacts, 0.2}, {{f, 70e9 / contacts, 0.2}});
  };
  EXPECT_NEAR(of(0.216).creep_share(1.0, 0.3), 0.700, 0.001);
  EXPECT_NEAR(of(0.278).creep_share(1.0, 0.3), 0.617, 0.001);
  EXPECT_NEAR(of(0.34).creep_share(1.0, 0.3), 0.538, 0.001);
  EXPECT_NEAR(of(0.216).creep_share(10.0, 0.3), 0.681, 0.001);
  EXPECT_NEAR(of(0.278).creep_share(10.0, 0.3), 0.591, 0.001);
  EXPECT_NEAR(of(0.34).creep_share(10.0, 0.3), 0.502, 0.001);
  EXPECT_NEAR(of(0.31).young(), 24.2e9, 0.05e9);
  EXPECT_NEAR(of(0.31).inclusion_weight(), 0.37, 0.002);
}

// Promise: balls bear more on one another than discs: the same concrete in space creeps by the shares that were
// worked out apart.
TEST(Mixture, OfBallsHasTheSharesOfASolid) {
  const double contacts = 1.0 + 1.6 / 3.0;
  const Mixture<3> mixture({0.66, 29.4e9 / contacts, 0.2}, {{0.34, 70e9 / contacts, 0.2}});
  EXPECT_NEAR(mixture.creep_share(1.0, 0.3), 0.4545, 0.0005);
  EXPECT_NEAR(mixture.creep_share(10.0, 0.3), 0.3644, 0.0005);
  EXPECT_NEAR(mixture.inclusion_weight(), 0.4205, 0.0005);
}

// Promise: rigid discs in a matrix that creeps without change of area stop it where they fill half of the
// area; with few of them the whole creeps as by Mori and Tanaka, 1 - 1.6 f.
TEST(Mixture, OfRigidDiscsCreepsAsFarAsTheyLetIt) {
  const auto far = [](double f) {
    return Mixture<2>({1.0 - f, 20e9, 0.5}, {{f, 20e18, 0.2}}).creep_share(100.0, 0.5);
  };
  EXPECT_NEAR(far(0.01), 1.0 - 1.6 * 0.01, 0.001);
  EXPECT_GT(far(0.3), 0.2);
  EXPECT_LT(far(0.7), 1e-6);
}

}  // namespace
}  // namespace pyroclast
