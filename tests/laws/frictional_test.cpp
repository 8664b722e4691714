#include "pyroclast/laws/frictional.hpp"

#include <gtest/gtest.h>

#include "known.hpp"

namespace pyroclast {
namespace {

using Properties = Frictional::Properties<double>;

/// A platen's contact, with the stiffness of the paper's Table 2.
constexpr Properties kPlaten{18400e9, 7660e9, 0.3};

struct Point {
  Frictional::Internals<2, double> internals{};
  Frictional::Losses<double> lost{};

  ContactResponse<2> go(double opening, double slip) {
    return Frictional::update<2, double>(Frictional::derive(kPlaten), opening, {{slip}}, internals, lost);
  }
};

TEST(FrictionalLaw, HoldsNothingInTension) {
  Point p;
  const auto r = p.go(5e-6, 3e-6);
  EXPECT_EQ(r.normal_traction, 0.0);
  EXPECT_EQ(r.shear_traction[0], 0.0);
  EXPECT_EQ(r.stored, 0.0);
  EXPECT_EQ(p.lost.friction, 0.0);
}

// Coulomb: sticks along K_s up to friction times pressure, then carries just that; the rest of the work is
// rubbed off.
TEST(FrictionalVerification, SlidesAtFrictionTimesPressure) {
  const double pressure = 10e6, opening = -pressure / kPlaten.normal_stiffness;
  const double carried = 0.3 * pressure, stick = carried / kPlaten.shear_stiffness;
  for (const double sign : {1.0, -1.0}) {
    Point p;
    auto r = p.go(opening, sign * 0.9 * stick);
    EXPECT_NEAR(r.shear_traction[0], sign * 0.9 * carried, 1e-9 * carried);
    EXPECT_EQ(p.lost.friction, 0.0);
    r = p.go(opening, sign * 50e-6);
    EXPECT_NEAR(r.shear_traction[0], sign * carried, 1e-9 * carried);
    EXPECT_NEAR(p.lost.slip_path, 50e-6 - stick, 1e-15);
    expect_known({"Law frictional: energy of sliding", "Coulomb", "J/m2"}, p.lost.friction,
                 carried * (50e-6 - stick), 1e-9 * carried * 50e-6);
    EXPECT_NEAR(r.stored, 0.5 * pressure * -opening + 0.5 * carried * stick, 1e-9 * r.stored);
  }
}

// Opened at once, it rubs off what it held in shear, and closes again where it is.
TEST(FrictionalLaw, OpeningLosesTheShearItHeld) {
  const double opening = -10e6 / kPlaten.normal_stiffness;
  Point p;
  p.go(opening, 0.2e-6);
  p.go(1e-6, 0.2e-6);
  const double held = 0.5 * kPlaten.shear_stiffness * 0.2e-6 * 0.2e-6;
  EXPECT_NEAR(p.lost.friction, held, 1e-12 * held);
  EXPECT_EQ(p.lost.slip_path, 0.0);
  p.go(1e-6, 7e-6);
  EXPECT_EQ(p.go(opening, 7e-6).shear_traction[0], 0.0);
  EXPECT_NEAR(p.lost.friction, held, 1e-12 * held);
}

// Closed without pressure it holds no shear; what slides there counts as slip.
TEST(FrictionalLaw, TouchingWithoutPressureHoldsNoShear) {
  Point p;
  p.go(-10e6 / kPlaten.normal_stiffness, 0.2e-6);
  EXPECT_EQ(p.go(0.0, 0.2e-6).shear_traction[0], 0.0);
  EXPECT_EQ(p.lost.slip_path, 0.2e-6);
}

}  // namespace
}  // namespace pyroclast
