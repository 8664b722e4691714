#include "pyroclast/material/cooling.hpp"

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/material/concrete.hpp"

/// What a material has on cooling: its free strain, and the share of its properties that is left.
namespace pyroclast {
namespace {

TEST(CoolingVerification, AShareIsLostEvenlyDownTo20) {
  const Curve ratio = Curve::table({20.0, 100.0, 300.0, 1000.0}, {1.0, 0.95, 0.9, 0.8}, temperature_axis());
  const Known known{"Share of a property that is left at 160 degC on the way down from 300 degC",
                    "1 - (1 - phi) (T_max - T) / (T_max - 20), EN 1994-1-2:2005, Annex C", "1"};
  expect_known(known, share_left(ratio, 160.0, 300.0), 0.95, 1e-15);
  EXPECT_EQ(share_left(ratio, 300.0, 300.0), 1.0);
  EXPECT_EQ(share_left(ratio, 20.0, 300.0), 0.9);
  EXPECT_EQ(share_left(ratio, 20.0, 1000.0), 0.8);
  EXPECT_EQ(share_left(ratio, -30.0, 300.0), 0.9);
  EXPECT_EQ(share_left(ratio, -30.0, 20.0), 1.0);
  EXPECT_EQ(share_left(std::nullopt, 20.0, 300.0), 1.0);
  BlockMaterial material;
  material.young = Curve::table({20.0, 1000.0}, {30e9, 10e9}, temperature_axis());
  EXPECT_EQ(material.young_at(20.0, 1000.0), 10e9);
  material.residual_ratio = ratio;
  EXPECT_EQ(material.young_at(20.0, 1000.0), 8e9);
  EXPECT_EQ(material.young_at(1000.0, 1000.0), 10e9);
}

TEST(CoolingVerification, FreeStrainHasItsOwnSlopeBelowTheHighestTemperature) {
  BlockMaterial material;
  material.thermal_strain =
      Curve::table({-50.0, 20.0, 200.0, 800.0}, {-7e-4, 0.0, 2e-3, -4e-3}, temperature_axis());
  for (const double T : {20.0, 100.0, 500.0})
    EXPECT_EQ(material.free_strain(T, 500.0), material.thermal_strain(T));
  material.contraction = 6e-6;
  double hottest = 20.0;
  for (const double T : {400.0, 20.0, 300.0, 400.0, 450.0, 60.0, -30.0}) {
    const double before = std::max(hottest, T);
    const double on_heating =
        before <= 200.0 ? 2e-3 * (before - 20.0) / 180.0 : 2e-3 - 1e-5 * (before - 200.0);
    expect_known({"Free strain on the way 20, 400, 20, 300, 400, 450, 60, -30 degC",
                  "strain(T_max) - contraction (T_max - T)", "1"},
                 material.free_strain(T, before), on_heating - 6e-6 * (before - T), 1e-17);
    hottest = before;
  }
}

}  // namespace
}  // namespace pyroclast
