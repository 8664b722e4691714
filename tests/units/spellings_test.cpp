#include "pyroclast/units/spellings.hpp"

#include <string>

#include <gtest/gtest.h>

#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

struct Written {
  const char* text;
  const Unit& unit;
  const char* meant;
};

// Units as papers print them, of which each is refused: it could mean another one.
const Written kWritten[] = {{"1.5 W/m·K", unit::conductivity, "W/(m K)"},
                            {"1.5 W/mK", unit::conductivity, "W/(m K)"},
                            {"900 J/kgK", unit::specific_heat, "J/(kg K)"},
                            {"0.9 kJ/kg·K", unit::specific_heat, "kJ/(kg K)"},
                            {"25 W/m² K", unit::heat_transfer, "W/(m2 K)"},
                            {"30 Mpa", unit::stress, "MPa"},
                            {"30 MPA", unit::stress, "MPa"},
                            {"300 kg/cm2", unit::stress, "kgf/cm2"},
                            {"300 kp/cm2", unit::stress, "kgf/cm2"},
                            {"4 Msi", unit::stress, "Mpsi"},
                            {"20 oC", unit::temperature, "degC"},
                            {"20 deg C", unit::temperature, "degC"},
                            {"20 C", unit::temperature, "degC"},
                            {"5 degC", unit::temperature_difference, "K"},
                            {"5 C/min", unit::heating_rate, "K/min"},
                            {"150 pcf", unit::density, "lb/ft3"},
                            {"10 hrs", unit::time, "h"},
                            {"12 kn", unit::force, "kN"},
                            {"12 um/m/C", unit::expansion, "um/m/K"},
                            {"60 n/m", unit::fracture_energy, "N/m"}};

TEST(Spellings, AUnitThatIsRefusedIsToldAsItIsSpelled) {
  for (const auto& [text, unit, meant] : kWritten) {
    std::string told = "taken";
    try {
      parse_quantity(text, unit);
    } catch (const QuantityError& error) {
      told = error.reason();
    }
    EXPECT_TRUE(told.ends_with("did you mean \"" + std::string(meant) + "\"?")) << text << ": " << told;
  }
}

// Promise: what is proposed is taken.
TEST(Spellings, EachIsAUnitOfItsKind) {
  for (const auto& [text, unit, meant] : kWritten)
    EXPECT_NO_THROW(parse_quantity("1 " + std::string(meant), unit));
}

// Promise: shares are read as people write them.
TEST(Spellings, SharesAreReadAsTheyAreWritten) {
  for (const char* text : {"300 ‰",
                           "300 permille",
                           "300 per mille",
                           "30 %",
                           "30 wt%",
                           "30 Vol.-%",
                           "30 mass-%",
                           "30 per cent",
                           "3e5 microstrain",
                           "3e5 µε",
                           "3e5 \u03BCε",
                           "3e5 με",
                           "0.3",
                           "0.3 -",
                           "0.3 [-]",
                           "300 [‰]",
                           "3e5 [µε]",
                           "300 [1e-3]",
                           "3e5 [ \u03BCm/m ]",
                           "30 [%]"})
    EXPECT_DOUBLE_EQ(parse_quantity(text, unit::dimensionless), 0.3) << text;
  for (const char* text : {"3 mstrain", "3 ‰x", "3 kpermille", "3 10^-3", "3 ε"})
    EXPECT_THROW(parse_quantity(text, unit::dimensionless), QuantityError) << text;
  for (const char* text : {"3 ‰", "3 -", "3 [-]", "3 [‰]", "3 []", "3 [MPa"})
    EXPECT_THROW(parse_quantity(text, unit::stress), QuantityError) << text;
  EXPECT_DOUBLE_EQ(parse_quantity("3 [MPa]", unit::stress), 3e6);
}

TEST(Spellings, WhatIsNearNothingIsNotGuessed) {
  EXPECT_EQ(meant_spelling("furlong fortnight", unit::stress), "");
  EXPECT_EQ(meant_spelling("W", unit::fracture_energy), "");
}

}  // namespace
}  // namespace pyroclast
