#include "pyroclast/moisture/pore_material.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "known.hpp"
#include "moisture/pores.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

// Values of the IAPWS industrial formulation 1997, rounded.
TEST(WaterVerification, IsThatOfSteamTables) {
  struct Row {
    double temperature, pressure, liquid, vapour;
  };
  for (const Row& row : {Row{100.0, 0.10142e6, 958.35, 0.59814}, Row{200.0, 1.5549e6, 864.66, 7.8610},
                         Row{250.0, 3.9762e6, 798.89, 19.965}, Row{300.0, 8.5879e6, 712.14, 46.154}}) {
    const std::string at = " at " + std::to_string(static_cast<int>(row.temperature)) + " degC";
    const char* source = "IAPWS industrial formulation 1997";
    expect_known({"Saturation pressure" + at, source, "Pa"}, water::saturation_pressure(row.temperature),
                 row.pressure, 0.003 * row.pressure);
    expect_known({"Density of liquid water" + at, source, "kg/m3"}, water::liquid_density(row.temperature),
                 row.liquid, 0.035 * row.liquid);
    const PoreMaterial m = high_strength();
    const PoreConditions conditions(m, row.temperature, row.temperature);
    expect_known({"Density of saturated vapour" + at, source, "kg/m3"},
                 pore_water(conditions, row.pressure).vapour_density, row.vapour, 0.05 * row.vapour);
  }
}

// Promise: derivatives are those of the values, in pores that are nearly dry, nearly full and overfull.
TEST(PoreWater, HasTheSlopesOfItsValues) {
  const PoreMaterial m = high_strength();
  for (const double temperature : {20.0, 150.0, 350.0, 500.0}) {
    const PoreConditions at(m, temperature, temperature);
    for (const double ratio : {0.01, 0.5, 0.9, 0.999, 1.5}) {
      const double p = ratio * at.saturation_pressure, small = 1e-6 * p;
      const PoreWater<WithSlope> w = pore_water(at, WithSlope(p, 1.0));
      const PoreWater<double> below = pore_water(at, p - small), above = pore_water(at, p + small);
      const auto expect = [&](const WithSlope& one, double low, double high) {
        const double slope = (high - low) / (2.0 * small);
        EXPECT_NEAR(one.slope, slope, 1e-3 * std::abs(slope) + 1e-9 * std::abs(one.value) / p)
            << temperature << ' ' << ratio;
      };
      expect(w.content, below.content, above.content);
      expect(w.saturation, below.saturation, above.saturation);
      expect(w.liquid_pressure, below.liquid_pressure, above.liquid_pressure);
      expect(w.vapour_density, below.vapour_density, above.vapour_density);
      expect(w.liquid_mobility, below.liquid_mobility, above.liquid_mobility);
      expect(w.vapour_mobility, below.vapour_mobility, above.vapour_mobility);
      if (p < 0.99 * water::kAtmosphere || p > 1.01 * water::kAtmosphere)
        expect(w.diffusion, below.diffusion, above.diffusion);
    }
  }
}

// Promise: a closed box that is heated keeps its water. Pressure, and saturation, of the design's own
// solution by bisection.
TEST(ClosedBoxVerification, KeepsItsWaterWhileItIsHeated) {
  PoreMaterial m = high_strength();
  m.entry_pressure = 10e6 * from_0_degC();
  const PoreConditions cold(m, 20.0, 20.0);
  const double p = pressure_of_saturation(cold, 0.77);
  const double content = pore_water(cold, p).content;
  const char* source = "bisection of van Genuchten's and Kelvin's equations";
  expect_known({"Water in a closed box, saturation 0.77 at 20 degC", source, "kg/m3"}, content, 92.2307,
               1e-4);
  expect_known({"Humidity in it", source, "1"}, p / cold.saturation_pressure, 0.940439, 1e-6);
  struct Row {
    double temperature, ratio, saturation;
  };
  for (const Row& row : {Row{100.0, 0.9678, 0.7963}, Row{150.0, 0.9800, 0.8304}, Row{200.0, 0.9893, 0.8836},
                         Row{250.0, 0.9970, 0.9689}, Row{300.0, 2.373, 1.0}}) {
    const PoreConditions hot(m, row.temperature, row.temperature);
    const double pressure = pressure_of_content(hot, content, p);
    const PoreWater<double> w = pore_water(hot, pressure);
    EXPECT_NEAR(w.content / content, 1.0, 1e-14) << row.temperature;
    const std::string at =
        " of a closed box at " + std::to_string(static_cast<int>(row.temperature)) + " degC";
    expect_known({"Pressure over that of saturation" + at, source, "1"}, pressure / hot.saturation_pressure,
                 row.ratio, row.ratio > 1.0 ? 1e-3 : 1e-4);
    expect_known({"Saturation" + at, source, "1"}, w.saturation, row.saturation, 1e-4);
  }
}

// Promise: a pressure is found for any content, from any guess.
TEST(PressureOfContent, IsTheInverseOfTheContent) {
  const PoreMaterial m = high_strength();
  for (const double temperature : {20.0, 200.0, 369.0, 900.0}) {
    const PoreConditions at(m, temperature, temperature);
    for (const double ratio : {1e-6, 0.02, 0.7, 0.99999, 1.0, 3.0})
      for (const double guess : {1e-9, 1.0, 100.0}) {
        const double p = ratio * at.saturation_pressure;
        const double content = pore_water(at, p).content;
        const double found = pressure_of_content(at, content, guess * at.saturation_pressure);
        EXPECT_NEAR(pore_water(at, found).content / content, 1.0, 1e-13) << temperature << ' ' << ratio;
        EXPECT_NEAR(found / p, 1.0, 1e-9) << temperature << ' ' << ratio << ' ' << guess;
      }
  }
}

TEST(PoreMaterials, WhatIsOutOfRangeIsNamed) {
  const auto refuse = [](double PoreMaterial::*number, double value, const char* name) {
    PoreMaterial m = high_strength();
    m.*number = value;
    try {
      m.check();
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refuse(&PoreMaterial::porosity, 1.0, "porosity");
  refuse(&PoreMaterial::permeability, 0.0, "permeability");
  refuse(&PoreMaterial::entry_pressure, -1.0, "entry pressure");
  refuse(&PoreMaterial::exponent, 1.0, "exponent");
  refuse(&PoreMaterial::cement, -1.0, "cement");
  refuse(&PoreMaterial::compliance, 0.0, "compliance");
  refuse(&PoreMaterial::tortuosity, 1.1, "tortuosity");
}

}  // namespace
}  // namespace pyroclast
