#include "pyroclast/units/units.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

using Kind = QuantityError::Kind;

struct Good {
  const char* text;
  Unit unit;
  double value;
};

class GoodQuantity : public testing::TestWithParam<Good> {};

// A conversion is a product and a sum of doubles: a few units in the last place, of 460 where °F passes
// through K.
TEST_P(GoodQuantity, IsReadInTheUnitAskedFor) {
  const auto& [text, unit, value] = GetParam();
  const double tolerance = unit.si == std::string("degC") ? 1e-12 : 1e-15 * std::abs(value);
  EXPECT_NEAR(parse_quantity(text, unit), value, tolerance) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Mechanics, GoodQuantity,
    testing::Values(Good{"18400 GPa/m", unit::stiffness_per_area, 1.84e13},
                    Good{"150 mm", unit::length, 0.15}, Good{"1.6mm", unit::length, 0.0016},
                    Good{" 2 um ", unit::length, 2e-6}, Good{"2 µm", unit::length, 2e-6},
                    Good{"-3.5e1 cm", unit::length, -0.35}, Good{"+1 m", unit::length, 1.0},
                    Good{"0 m", unit::length, 0.0}, Good{"45000 mm2", unit::area, 0.045},
                    Good{"45000 mm²", unit::area, 0.045}, Good{"45000 mm^2", unit::area, 0.045},
                    Good{"0.8 mm/s", unit::velocity, 0.0008}, Good{"2650 kg/m3", unit::density, 2650.0},
                    Good{"2650 kg m-3", unit::density, 2650.0}, Good{"2650 kg·m⁻³", unit::density, 2650.0},
                    Good{"2.65 t/m³", unit::density, 2650.0}, Good{"9.81 m/s2", unit::acceleration, 9.81},
                    Good{"120 kN", unit::force, 1.2e5}, Good{"31 MPa", unit::stress, 31e6},
                    Good{"31 N/mm2", unit::stress, 31e6}, Good{"40 N/m", unit::fracture_energy, 40.0},
                    Good{"40 J/m2", unit::fracture_energy, 40.0}, Good{"90 min", unit::time, 5400.0},
                    Good{"2 h", unit::time, 7200.0}, Good{"10 1/s", unit::frequency, 10.0},
                    Good{"10 Hz", unit::frequency, 10.0}, Good{"10 s⁻¹", unit::frequency, 10.0},
                    Good{"180 deg", unit::angle, std::numbers::pi},
                    Good{"180°", unit::angle, std::numbers::pi},
                    Good{"180 degrees", unit::angle, std::numbers::pi}, Good{"0.6 rad", unit::angle, 0.6},
                    Good{"2 Å", unit::length, 2e-10}, Good{"31 N mm**-2", unit::stress, 31e6},
                    Good{"31 N/(mm.mm)", unit::stress, 31e6}, Good{"31 (kN/(m m))", unit::stress, 31e3},
                    Good{"40 N-m/m2/m", unit::stress, 40.0}));

INSTANTIATE_TEST_SUITE_P(
    Heat, GoodQuantity,
    testing::Values(Good{"20 degC", unit::temperature, 20.0}, Good{"20 °C", unit::temperature, 20.0},
                    Good{"293.15 K", unit::temperature, 20.0}, Good{"212 degF", unit::temperature, 100.0},
                    Good{"5 K", unit::temperature_difference, 5.0}, Good{"6 K/min", unit::heating_rate, 0.1},
                    Good{"6 degC/min", unit::heating_rate, 0.1}, Good{"6 °C/min", unit::heating_rate, 0.1},
                    Good{"1.6 W/m/K", unit::conductivity, 1.6}, Good{"1.6 W/(m K)", unit::conductivity, 1.6},
                    Good{"1.6 W/(m·K)", unit::conductivity, 1.6},
                    Good{"0.9 kJ/kg/K", unit::specific_heat, 900.0},
                    Good{"900 J/(kg °C)", unit::specific_heat, 900.0},
                    Good{"25 W/m2/K", unit::heat_transfer, 25.0}, Good{"25 W/m²K", unit::heat_transfer, 25.0},
                    Good{"25 W/m²°C", unit::heat_transfer, 25.0},
                    Good{"25 W·m⁻²·K⁻¹", unit::heat_transfer, 25.0}, Good{"15 kW/m2", unit::heat_flux, 15e3},
                    Good{"1e-5 1/K", unit::expansion, 1e-5}, Good{"1e-5/K", unit::expansion, 1e-5},
                    Good{"10 µm/m/K", unit::expansion, 1e-5}, Good{"1e-5 1/degC", unit::expansion, 1e-5}));

INSTANTIATE_TEST_SUITE_P(Dimensionless, GoodQuantity,
                         testing::Values(Good{"31 %", unit::dimensionless, 0.31},
                                         Good{"31%", unit::dimensionless, 0.31},
                                         Good{"0.31", unit::dimensionless, 0.31},
                                         Good{"2 mm/m", unit::dimensionless, 0.002}));

class ExactQuantity : public testing::TestWithParam<Good> {};

// Promise: where units are decimals of each other, a value is the double nearest to what is written.
TEST_P(ExactQuantity, IsTheNearestDouble) {
  const auto& [text, unit, value] = GetParam();
  EXPECT_EQ(parse_quantity(text, unit), value) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Decimals, ExactQuantity,
    testing::Values(Good{"10 us", unit::time, 1e-5}, Good{"7 um", unit::length, 7e-6},
                    Good{"68 mm", unit::length, 0.068}, Good{"-0.3 mm", unit::length, -3e-4},
                    Good{"1.7e-3 kN", unit::force, 1.7}, Good{"68 %", unit::dimensionless, 0.68},
                    Good{"3 Å", unit::length, 3e-10}, Good{"0.1 ft", unit::length, 0.03048},
                    Good{"3 inch", unit::length, 0.0762}, Good{"450 mm2", unit::area, 4.5e-4},
                    Good{"1.1 min", unit::time, 66.0}, Good{"0.7 h", unit::time, 2520.0},
                    Good{"12 K/min", unit::heating_rate, 0.2}, Good{"36 km/h", unit::velocity, 10.0},
                    Good{"1 K/h", unit::heating_rate, 1.0 / 3600.0},
                    Good{"0.1234567890123456789 m", unit::length, 0.1234567890123456789}));

INSTANTIATE_TEST_SUITE_P(
    Temperatures, ExactQuantity,
    testing::Values(Good{"68 degF", unit::temperature, 20.0}, Good{"293.15 K", unit::temperature, 20.0},
                    Good{"32 degF", unit::temperature, 0.0}, Good{"-40 degF", unit::temperature, -40.0},
                    Good{"0 K", unit::temperature, -273.15}, Good{"-459.67 degF", unit::temperature, -273.15},
                    Good{"527.67 degR", unit::temperature, 20.0}, Good{"300 K", unit::temperature, 26.85},
                    Good{"9 degR", unit::temperature_difference, 5.0},
                    Good{"1.8 degF/s", unit::heating_rate, 1.0}));

// Promise: a formula's values go the same way, but for the rounding of a sum and a product.
TEST(UnitFactors, TakeValuesAsQuantitiesAre) {
  EXPECT_EQ(unit_factors("degF", unit::temperature)(68.0), 20.0);
  EXPECT_EQ(unit_factors("K", unit::temperature)(273.15), 0.0);
  EXPECT_EQ(unit_factors("us", unit::time)(10.0), 1e-5);
  EXPECT_TRUE(unit_factors("W/(m K)", unit::conductivity).is_none());
  EXPECT_THROW(unit_factors("m", unit::time), QuantityError);
}

struct Bad {
  const char* text;
  Unit unit;
  Kind kind;
};

class BadQuantity : public testing::TestWithParam<Bad> {};

TEST_P(BadQuantity, IsRefusedForTheRightReasonAndQuoted) {
  const auto& [text, unit, kind] = GetParam();
  try {
    const double value = parse_quantity(text, unit);
    FAIL() << text << " was read as " << value;
  } catch (const QuantityError& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_EQ(error.what(), '"' + std::string(text) + "\": " + error.reason());
  }
}

INSTANTIATE_TEST_SUITE_P(Number, BadQuantity,
                         testing::Values(Bad{"", unit::length, Kind::no_number},
                                         Bad{"mm", unit::length, Kind::no_number},
                                         Bad{"--1 mm", unit::length, Kind::no_number},
                                         Bad{"+-1 mm", unit::length, Kind::no_number},
                                         Bad{"1,5 mm", unit::length, Kind::no_number},
                                         Bad{"1_000 mm", unit::length, Kind::no_number},
                                         Bad{"18 400 GPa/m", unit::stiffness_per_area, Kind::no_number},
                                         Bad{"nan mm", unit::length, Kind::not_finite},
                                         Bad{"inf m", unit::length, Kind::not_finite},
                                         Bad{"-infinity m", unit::length, Kind::not_finite},
                                         Bad{"1e999 m", unit::length, Kind::not_finite},
                                         Bad{"1e308 Gm", unit::length, Kind::not_finite}));

INSTANTIATE_TEST_SUITE_P(
    UnknownUnit, BadQuantity,
    testing::Values(
        Bad{"150", unit::length, Kind::no_unit}, Bad{"150 ", unit::length, Kind::no_unit},
        Bad{"5 mmm", unit::length, Kind::unknown_unit}, Bad{"30 Mpa", unit::stress, Kind::unknown_unit},
        Bad{"0x10 mm", unit::length, Kind::unknown_unit}, Bad{"5 m/", unit::length, Kind::unknown_unit},
        Bad{"2650 kg m -3", unit::density, Kind::unknown_unit},
        Bad{"5 m.10", unit::length, Kind::unknown_unit},
        Bad{"5 K @ 273.15", unit::temperature_difference, Kind::unknown_unit},
        Bad{"5 s since 2000-01-01", unit::time, Kind::unknown_unit},
        Bad{"5 lg(re m)", unit::length, Kind::unknown_unit}, Bad{"5 dBZ", unit::length, Kind::unknown_unit},
        Bad{"5 (m", unit::length, Kind::unknown_unit}, Bad{"5 m)", unit::length, Kind::unknown_unit},
        Bad{"5 m//s", unit::length, Kind::unknown_unit}, Bad{"5 m^", unit::length, Kind::unknown_unit},
        Bad{"5 m100", unit::length, Kind::unknown_unit}, Bad{"5 m\xC2", unit::length, Kind::unknown_unit},
        Bad{"5 mm m 1/s", unit::velocity, Kind::unknown_unit}));

INSTANTIATE_TEST_SUITE_P(WrongDimension, BadQuantity,
                         testing::Values(Bad{"2.5 mm", unit::stress, Kind::wrong_dimension},
                                         Bad{"20 C", unit::temperature, Kind::wrong_dimension},
                                         Bad{"1.6 W/mK", unit::conductivity, Kind::wrong_dimension},
                                         Bad{"25 W/m2 K", unit::heat_transfer, Kind::wrong_dimension},
                                         Bad{"5 degC", unit::temperature_difference, Kind::wrong_dimension},
                                         Bad{"4 s", unit::frequency, Kind::wrong_dimension},
                                         Bad{"5 K", unit::expansion, Kind::wrong_dimension},
                                         Bad{"34 %", unit::angle, Kind::wrong_dimension},
                                         Bad{"0.5 rad", unit::dimensionless, Kind::wrong_dimension},
                                         Bad{"3 rad/s", unit::frequency, Kind::wrong_dimension}));

TEST(QuantityMessage, NamesTheGivenUnitTheNeededOneAndAnExample) {
  try {
    parse_quantity("2.5 mm", unit::stress);
    FAIL();
  } catch (const QuantityError& error) {
    for (const std::string part : {"\"2.5 mm\"", "\"mm\"", "stress", "Pa", "30 MPa"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in " << error.what();
    }
  }
}

TEST(Quantity, WithANulInItsUnitIsRefusedAndNotCutOff) {
  EXPECT_THROW(parse_quantity(std::string_view("5 m\0m", 5), unit::length), QuantityError);
}

// 20 degC must not come back as 20.000000000000057.
TEST(Quantity, InTheUnitAskedForIsNotRounded) {
  for (const double value : {20.0, 0.1, 799.9, 1e-7}) {
    EXPECT_EQ(parse_quantity(std::to_string(value) + " degC", unit::temperature),
              std::stod(std::to_string(value)));
  }
}

const std::vector<Unit> all_units{unit::dimensionless,
                                  unit::length,
                                  unit::area,
                                  unit::angle,
                                  unit::time,
                                  unit::frequency,
                                  unit::velocity,
                                  unit::acceleration,
                                  unit::density,
                                  unit::force,
                                  unit::stress,
                                  unit::temperature,
                                  unit::heating_rate,
                                  unit::fracture_energy,
                                  unit::conductivity,
                                  unit::specific_heat,
                                  unit::heat_flux,
                                  unit::heat_transfer,
                                  unit::expansion,
                                  unit::stiffness_per_area,
                                  unit::temperature_difference};

TEST(Units, AcceptTheirOwnExample) {
  for (const Unit& unit : all_units) {
    EXPECT_NO_THROW(parse_quantity(unit.example, unit)) << unit.name;
    EXPECT_NE(requirement(unit).find(unit.example), std::string::npos) << unit.name;
  }
}

TEST(Units, RefuseAUnitOfAnotherDimension) {
  for (const Unit& unit : all_units) {
    EXPECT_THROW(parse_quantity("1 mol", unit), QuantityError) << unit.name;
  }
}

TEST(Units, AreReadAlikeByManyThreadsAtOnce) {
  std::vector<int> wrong(8, 0);
  std::vector<std::thread> threads;
  for (int& count : wrong) {
    threads.emplace_back([&count] {
      for (int i = 0; i < 200; ++i) {
        count += parse_quantity("25 W/m²K", unit::heat_transfer) != 25.0;
        try {
          parse_quantity("25 W/m²Q", unit::heat_transfer);
          ++count;
        } catch (const QuantityError&) {
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(8, 0));
}

}  // namespace
}  // namespace pyroclast
