#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "deck/diagnostics_of.hpp"
#include "decks.hpp"
#include "pyroclast/setup/setup.hpp"

/// Decks with water in the pores.
namespace pyroclast {
namespace {

std::string slab() {
  return shipped_case("kalifa_m100");
}

/// The errors of a deck, a line each: key and message.
std::string errors_in(const std::string& text) {
  std::string lines;
  try {
    read_setup(Deck::parse(text, "deck.toml"), ".");
  } catch (const DeckError& e) {
    for (const Diagnostic& d : e.diagnostics()) lines += d.key + ": " + d.message + "\n";
  }
  return lines;
}

void expect_error(const std::string& from, const std::string& to, const std::string& message) {
  const std::string errors = errors_in(with(slab(), from, to));
  EXPECT_NE(errors.find(message), std::string::npos) << to << "\n" << errors;
}

TEST(MoistureSetup, TakesTheClassWhereNothingIsStated) {
  const auto setup = read_setup(Deck::parse(slab(), "deck.toml"), ".");
  ASSERT_TRUE(setup.heat.moisture);
  const MoistureConditions& m = *setup.heat.moisture;
  ASSERT_EQ(m.pores.size(), 2U);
  EXPECT_FALSE(m.pores[0].of_concrete);
  EXPECT_EQ(m.pores[0].material.permeability, 1e-20);
  EXPECT_EQ(m.pores[0].material.permeability_ratio(300.0), 1.0);
  EXPECT_TRUE(m.pores[1].of_concrete);
  EXPECT_EQ(m.pores[1].material.permeability, 5.1e-20);
  EXPECT_NEAR(m.pores[1].material.permeability_ratio(145.0), 10.0, 1e-3);
  EXPECT_EQ(m.pores[1].material.cement, 415.0);
  ASSERT_EQ(m.boundaries.size(), 2U);
  const auto& air = std::get<MoistAir>(*m.boundaries[0].condition);
  EXPECT_EQ(air.coefficient, 0.018);
  EXPECT_NEAR(air.vapour_density(0.0), 0.0138, 1e-4);
}

TEST(MoistureSetup, RefusesWhatHasNoMeaning) {
  expect_error("saturation = 0.77", "saturation = 1.2", "saturation: ");
  expect_error("saturation = 0.77", "saturation = 0.77, humidity = 0.5",
               "moisture.initial.humidity: has no meaning beside \"saturation\"");
  expect_error("saturation = 0.77", "", "moisture.initial.content: missing");
  expect_error("class = \"high strength\"", "class = \"strong\"", "materials.mortar.moisture.class: ");
  expect_error("permeability = \"5.1e-20 m2\"", "permeability = 0",
               "materials.mortar.moisture.permeability: ");
  expect_error("porosity = 0.12", "porosity = 1.2", "materials.mortar.moisture.porosity: ");
  expect_error("exponent = 2.27", "exponent = 1", "materials.mortar.moisture.exponent: ");
  expect_error("moisture = { class = \"rock\" }", "moisture = { class = \"rock\", of = \"concrete\" }",
               "materials.aggregate.moisture.of: \"concrete\" is for the matrix alone");
  expect_error("moisture = { class = \"rock\" }\n", "",
               "materials.aggregate.moisture: missing; [moisture] needs the pores of each phase");
  expect_error("faces = \"left\"\nkind = \"air\"", "faces = \"lift\"\nkind = \"air\"",
               "moisture.boundaries[0].faces: must be one of");
  expect_error("faces = \"right\"\nkind = \"air\"", "faces = \"outline\"\nkind = \"sealed\"",
               "acts on faces that have a condition already");
  expect_error("faces = \"left\"\nkind = \"air\"", "faces = \"left\"\nkind = \"sealed\"\nhumidity = 0.5",
               "moisture.boundaries[0].humidity: ");
  expect_error("[moisture]\ninitial = { saturation = 0.77 }\n", "[moisture]\n", "moisture.initial: ");
}

/// A fire on a wall whose pores hold water.
std::string wet_wall(const std::string& keys) {
  std::string text = with(shipped_case("fire_one_side"), "[materials.aggregate]\n",
                          "[materials.aggregate]\nmoisture = { class = \"rock\" }\n");
  text = with(text, "[materials.mortar]\n", "[materials.mortar]\nmoisture = { class = \"ordinary\" }\n");
  return text + "\n[moisture]\ninitial = { saturation = 0.6 }\n" + keys;
}

TEST(MoistureSetup, ReadsHowWaterAndMotionActOnEachOther) {
  const auto coupling_of = [](const std::string& keys) {
    return read_setup(Deck::parse(wet_wall(keys), "deck.toml"), ".").heat.moisture->coupling;
  };
  const PoreCoupling all = coupling_of("");
  EXPECT_EQ(all.acts, PressureActs::all);
  EXPECT_EQ(all.biot, 0.5);
  EXPECT_EQ(all.crack_width, 5e-6);
  EXPECT_EQ(all.exchange_pressure, 2e5);
  const PoreCoupling stated =
      coupling_of("acts = \"zones\"\nbiot = 0.8\ncrack_width = \"10 um\"\nexchange_pressure = \"0.1 MPa\"\n");
  EXPECT_EQ(stated.acts, PressureActs::zones);
  EXPECT_EQ(stated.biot, 0.8);
  EXPECT_EQ(stated.crack_width, 1e-5);
  EXPECT_EQ(stated.exchange_pressure, 1e5);
  const auto expect = [](const std::string& keys, const std::string& message) {
    const std::string errors = errors_in(wet_wall(keys));
    EXPECT_NE(errors.find(message), std::string::npos) << keys << "\n" << errors;
  };
  expect("acts = \"some\"\n", "moisture.acts: must be one of");
  expect("biot = 1.5\n", "moisture.biot: ");
  expect("crack_width = 0\n", "moisture.crack_width: ");
  expect("roughness = 0.5\n", "moisture.roughness: ");
  expect("acts = \"no\"\nbiot = 0.5\n", "moisture.biot: has no meaning beside acts = \"no\"");
  expect_error("initial = { saturation = 0.77 }", "initial = { saturation = 0.77 }\nbiot = 0.5",
               "moisture.biot: has no meaning: no stage moves the body");
}

TEST(MoistureSetup, PoresWithoutWaterAreRefused) {
  std::string text = slab();
  const auto from = text.find("[moisture]"), to = text.find("[[stages]]");
  text.erase(from, to - from);
  EXPECT_NE(errors_in(text).find("materials.mortar.moisture: has no meaning without the table [moisture]"),
            std::string::npos)
      << errors_in(text);
}

TEST(MoistureSetup, NeedsHeatThatFlows) {
  const std::string text =
      with(shipped_case("starter"), "[mechanics]", "[moisture]\ninitial = { saturation = 0.5 }\n[mechanics]");
  EXPECT_NE(errors_in(text).find("moisture: needs [heat] with field = \"conduction\""), std::string::npos)
      << errors_in(text);
}

TEST(MoistureSetup, WarnsOfWaterThatEvaporatesWithoutHeat) {
  const auto setup = read_setup(
      Deck::parse(
          with(slab(),
               "density = \"2350 kg/m3\"\nconductivity = { builtin = \"en1992_conductivity_upper\" }\n"
               "specific_heat = { builtin = \"en1992_specific_heat_u3\" }",
               "density = \"2350 kg/m3\"\nconductivity = { builtin = \"en1992_conductivity_upper\" }\n"
               "specific_heat = \"1 kJ/kg/K\""),
          "deck.toml"),
      ".");
  bool warned = false;
  for (const Diagnostic& d : setup.warnings)
    warned = warned || (d.key == "materials.mortar.specific_heat" &&
                        d.message.find("evaporates without heat") != std::string::npos);
  EXPECT_TRUE(warned);
}

}  // namespace
}  // namespace pyroclast
