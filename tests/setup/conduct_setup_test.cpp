#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "deck/diagnostics_of.hpp"
#include "decks.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/stages/conduct.hpp"

/// Decks of heat conduction alone.
namespace pyroclast {
namespace {

std::string wall_deck() {
  return shipped_case("thermal_wall");
}

std::vector<Diagnostic> errors_of(const std::string& text) {
  try {
    read_setup(Deck::parse(text, "deck.toml"), ".");
  } catch (const DeckError& e) {
    return e.diagnostics();
  }
  return {};
}

/// The one error of a deck.
Diagnostic error_of(const std::string& text) {
  const auto errors = errors_of(text);
  EXPECT_EQ(errors.size(), 1U) << text;
  return errors.empty() ? Diagnostic{} : errors.front();
}

TEST(ConductSetup, NeedsNeitherContactsNorMechanicsNorPlatens) {
  const pyroclast::Setup setup = read_setup(Deck::parse(wall_deck(), "deck.toml"), ".");
  EXPECT_FALSE(setup.moving);
  ASSERT_EQ(setup.stages.size(), 1U);
  EXPECT_STREQ(setup.stages[0]->kind(), "conduct");
  EXPECT_EQ(setup.stages[0]->heating().duration, 7200.0);
  ASSERT_EQ(setup.probes.size(), 3U);
  EXPECT_EQ(setup.probes[1].name, "x_25mm");
  EXPECT_DOUBLE_EQ(setup.probes[1].position[0], 0.025);
  // the fire's temperature at the end bounds the range
  EXPECT_NEAR(setup.temperatures.upper, 20.0 + 345.0 * std::log10(8.0 * 120.0 + 1.0), 1e-3);
}

// Promise: ends that a deck states in one unit and a table in another meet.
TEST(ConductSetup, EndsInUnitsOfPapersMeetThoseOfTheRun) {
  const std::string bounds =
      "\n[[heat.boundaries]]\nfaces = \"right\"\nkind = \"temperature\"\ntemperature = ";
  const auto deck = [&](const char* initial, const char* hottest, const char* points) {
    const std::string heat = std::string(
                                 "title = \"wall\"\n[specimen]\nseed = 1\nwidth = \"60 mm\"\nheight = \"60 "
                                 "mm\"\n[blocks]\ncount = 20\nshortest_edge = 0.2\n") +
                             "[materials.mortar]\ndensity = \"2200 kg/m3\"\nspecific_heat = \"1 kJ/kg/K\"\n" +
                             "conductivity = { table = " + points +
                             " }\n[heat]\nfield = \"conduction\"\ninitial = \"" + initial + "\"" + bounds +
                             "\"" + hottest + "\"\n";
    return heat +
           "[[stages]]\nkind = \"conduct\"\nduration = \"1 min\"\ninterval = \"10 "
           "s\"\n[output]\nframe_interval = \"1 min\"\n";
  };
  const auto runs = [](const std::string& text) {
    const auto setup = read_setup(Deck::parse(text, "deck.toml"), ".");
    make_simulation(setup)->field().begin_exposure(temperature_range(setup.heat, 60.0));
  };
  EXPECT_NO_THROW(
      runs(deck("20 degC", "600 degC", R"([["68 degF", "1.5 W/m/K"], ["1112 degF", "1 W/m/K"]])")));
  EXPECT_NO_THROW(
      runs(deck("527.67 degR", "873.15 K", R"([["20 degC", "1.5 W/m/K"], ["600 degC", "1 W/m/K"]])")));
  EXPECT_NO_THROW(
      runs(deck("250.2 K", "0 degC", R"([["-9.31 degF", "1.5 W/m/K"], ["527.67 degR", "1 W/m/K"]])")));
}

TEST(ConductSetup, MakesASpecimenWithoutPlatensThatConducts) {
  const pyroclast::Setup setup =
      read_setup(Deck::parse(with(wall_deck(), "count = 2000", "count = 100"), "deck.toml"), ".");
  const auto simulation = make_simulation(setup);
  EXPECT_EQ(simulation->model().bearing_materials, 0);
  EXPECT_FALSE(simulation->moves());
  EXPECT_TRUE(simulation->field().conduction());
}

TEST(ConductSetup, AmongOtherStagesNeedsWhatTheyNeed) {
  const auto errors =
      errors_of(wall_deck() + "\n[[stages]]\nkind = \"settle\"\nunbalanced_ratio = 1e-4\nmost_steps = 100\n");
  const auto told = [&](const std::string& key) {
    return std::any_of(errors.begin(), errors.end(), [&](const Diagnostic& d) { return d.key == key; });
  };
  for (const char* key : {"contacts", "mechanics", "materials.mortar.E"}) EXPECT_TRUE(told(key)) << key;
}

TEST(ConductSetup, SaysThatWhatConcernsMechanicsHasNoEffect) {
  const auto no_effect = [](const std::string& deck, const std::string& key) {
    const auto d = error_of(deck);
    EXPECT_EQ(d.key, key);
    EXPECT_TRUE(mentions(d.message, "no effect")) << d.message;
  };
  no_effect(wall_deck() + "\n[contacts]\nt_b = \"1.6 mm\"\n", "contacts");
  no_effect(wall_deck() + "\n[mechanics]\nsafety = 0.9\n", "mechanics");
  no_effect(wall_deck() + "\n[platens]\nthickness = \"20 mm\"\n", "platens");
  no_effect(wall_deck() + "\n[coupling]\nmost_cycles = 10\n", "coupling");
  no_effect(with(wall_deck(), "[materials.mortar]", "[materials.mortar]\nE = \"30 GPa\""),
            "materials.mortar.E");
  no_effect(with(wall_deck(), "frame_interval", "frame_strain = 1e-4\nframe_interval"),
            "output.frame_strain");
}

TEST(ConductSetup, NeedsConductionAndItsProperties) {
  EXPECT_EQ(error_of(with(wall_deck(), "interval = \"60 s\"", "")).key, "stages[0].interval");
  EXPECT_EQ(error_of(with(wall_deck(), "frame_interval = \"15 min\"", "")).key, "output.frame_interval");
  EXPECT_EQ(error_of(with(wall_deck(), "density = \"2650 kg/m3\"", "")).key, "materials.aggregate.density");
  const auto uniform = errors_of(with(wall_deck(), "field = \"conduction\"", "field = \"uniform\""));
  ASSERT_FALSE(uniform.empty());
  EXPECT_TRUE(mentions(uniform.front().message, "\"conduct\" needs [heat]")) << uniform.front().message;
}

TEST(ConductSetup, ProbesLieInTheSpecimenAndHaveNamesOfTheirOwn) {
  const auto d = error_of(with(wall_deck(), "x = \"25 mm\"", "x = \"151 mm\""));
  EXPECT_EQ(d.key, "probes[1].x");
  EXPECT_EQ(error_of(with(wall_deck(), "\"x_25mm\"", "\"x_5mm\"")).key, "probes[1].name");
  EXPECT_EQ(error_of(with(wall_deck(), "\"x_25mm\"", "\"a,b\"")).key, "probes[1].name");
}

}  // namespace
}  // namespace pyroclast
