#include "pyroclast/simulation/acting/heat_conditions.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "deck/diagnostics_of.hpp"
#include "decks.hpp"
#include "heated_specimen.hpp"
#include "in_plane.hpp"
#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/read_heat.hpp"
#include "pyroclast/thermal/fire_curves.hpp"
#include "thermal/advance.hpp"

namespace pyroclast {
namespace {

constexpr double kDuration = 3600.0;

struct HeatDeck {
  explicit HeatDeck(const std::string& text) : deck(Deck::parse(text, "deck.toml")) {
    CurveReader curves(".", time_axis(), {0.0, kDuration}, fire_curves());
    heat = read_heat(deck.root(), curves, {});
  }
  Deck deck;
  std::optional<HeatConditions> heat;
};

std::string conduction_deck(const std::string& boundaries, const std::string& keys = "") {
  return "[heat]\nfield = \"conduction\"\n" + keys + boundaries;
}
const std::string kConvection =
    "[[heat.boundaries]]\nfaces = \"left\"\nkind = \"convection\"\ncoefficient = \"25 W/(m2 K)\"\n"
    "gas_temperature = { builtin = \"iso834\" }\n";
const std::string kHeld =
    "[[heat.boundaries]]\nfaces = \"right\"\nkind = \"temperature\"\ntemperature = \"20 degC\"\n";
const std::string kFlux = "[[heat.boundaries]]\nfaces = \"top\"\nkind = \"flux\"\nflux = \"15 kW/m2\"\n";

/// The one error that a deck gives.
Diagnostic error_of(const std::string& text) {
  return only_diagnostic_of(HeatDeck(text).deck);
}

std::string message_of(const ModelOf<2>& body, const HeatConditions& heat,
                       const std::vector<BlockMaterial>& block_materials = alike_materials()) {
  return message([&] { make_conduction(body, block_materials, heat, {20.0, 1000.0}); });
}

// ---- Reading ---------------------------------------------------------------------------------------------

TEST(ReadHeat, ADeckWithoutHeatHasNone) {
  EXPECT_FALSE(HeatDeck("title = \"cold\"").heat);
}

TEST(ReadHeat, UniformHeatingNeedsNoMore) {
  const HeatDeck d("[heat]\nfield = \"uniform\"\n");
  EXPECT_TRUE(diagnostics_of(d.deck).empty());
  EXPECT_TRUE(d.heat->uniform);
  EXPECT_EQ(d.heat->initial, 20.0);
}

TEST(ReadHeat, UniformHeatingHasNoUseForBoundariesOrASolver) {
  EXPECT_TRUE(mentions(error_of("[heat]\nfield = \"uniform\"\nscheme = \"euler\"\n").message, "no effect"));
  EXPECT_TRUE(mentions(error_of("[heat]\nfield = \"uniform\"\n" + kConvection).message, "no effect"));
}

TEST(ReadHeat, EveryKindOfBoundaryIsReadInSi) {
  const HeatDeck d(
      conduction_deck(kConvection + kHeld + kFlux +
                          "[[heat.boundaries]]\nfaces = \"left\"\nkind = \"radiation\"\nemissivity = 0.7\n"
                          "gas_temperature = { from = \"20 degC\", rate = \"5 K/min\", to = \"800 degC\" }\n"
                          "[[heat.boundaries]]\nfaces = \"box\"\nbox_low = [\"0 mm\", \"0 mm\"]\nbox_high = "
                          "[\"75 mm\", \"0 mm\"]\n"
                          "kind = \"adiabatic\"\n",
                      "initial = \"30 degC\"\nscheme = \"euler\"\nlargest_change = \"5 K\"\nlargest_step = "
                      "\"2 min\"\nsafety = "
                      "0.5\ntemperature_range = [\"20 degC\", \"900 degC\"]\n"));
  for (const auto& diagnostic : diagnostics_of(d.deck)) ADD_FAILURE() << to_string(diagnostic);
  const HeatConditions& heat = *d.heat;
  EXPECT_FALSE(heat.uniform);
  EXPECT_EQ(heat.initial, 30.0);
  EXPECT_EQ(heat.scheme, HeatScheme::euler);
  EXPECT_EQ(heat.largest_change, 5.0);
  EXPECT_EQ(heat.largest_step, 120.0);
  EXPECT_EQ(heat.safety, 0.5);
  EXPECT_EQ(heat.temperature_range, (Interval{20.0, 900.0}));
  ASSERT_EQ(heat.boundaries.size(), 5U);
  const auto& convected = std::get<Convection>(heat.boundaries[0].condition);
  EXPECT_EQ(convected.coefficient(100.0), 25.0);
  EXPECT_DOUBLE_EQ(convected.gas_temperature(1800.0), 20.0 + 345.0 * std::log10(8.0 * 30.0 + 1.0));
  EXPECT_EQ(std::get<PrescribedTemperature>(heat.boundaries[1].condition).temperature(0.0), 20.0);
  EXPECT_EQ(std::get<HeatFlux>(heat.boundaries[2].condition).flux(0.0), 15e3);
  const auto& radiated = std::get<Radiation>(heat.boundaries[3].condition);
  EXPECT_EQ(radiated.emissivity(0.0), 0.7);
  EXPECT_NEAR(radiated.gas_temperature(600.0), 70.0, 1e-9);
  EXPECT_TRUE(std::holds_alternative<Adiabatic>(heat.boundaries[4].condition));
  EXPECT_EQ(heat.boundaries[4].faces.part, BoundaryFaces::kBox);
  EXPECT_EQ(heat.boundaries[4].faces.box_high, (Vec<3>{{0.075, 0.0}}));
}

TEST(ReadHeat, WhatANumberMayBeIsToldAtItsLine) {
  const auto radiation =
      error_of(conduction_deck("[[heat.boundaries]]\nfaces = \"left\"\nkind = \"radiation\"\nemissivity = "
                               "1.2\ngas_temperature = \"500 "
                               "degC\"\n"));
  EXPECT_EQ(radiation.key, "heat.boundaries[0].emissivity");
  EXPECT_EQ(radiation.line, 6);
  EXPECT_EQ(error_of(conduction_deck(with(kConvection, "25 W", "-25 W"))).key,
            "heat.boundaries[0].coefficient");
  EXPECT_EQ(error_of(conduction_deck(kConvection, "safety = 1.5\n")).key, "heat.safety");
}

TEST(ReadHeat, AKeyOfAnotherKindHasNoEffectAndSaysSo) {
  const auto d = error_of(conduction_deck(kConvection + "emissivity = 0.7\n"));
  EXPECT_EQ(d.key, "heat.boundaries[0].emissivity");
  EXPECT_TRUE(mentions(d.message, "no effect"));
  EXPECT_TRUE(mentions(error_of(conduction_deck(kConvection + "box_low = [\"0 m\", \"0 m\"]\n")).message,
                       "no effect"));
}

TEST(ReadHeat, ConductionNeedsABoundary) {
  EXPECT_EQ(error_of("[heat]\nfield = \"conduction\"\n").key, "heat.boundaries");
}

TEST(ReadHeat, ABoxInsideOutOrWithoutTwoCoordinatesIsAnError) {
  const auto box = [](const char* low) {
    return conduction_deck(
        with(kConvection, "faces = \"left\"",
             std::string("faces = \"box\"\nbox_low = ") + low + "\nbox_high = [\"5 mm\", \"50 mm\"]"));
  };
  EXPECT_TRUE(diagnostics_of(HeatDeck(box("[\"0 mm\", \"50 mm\"]")).deck).empty());
  EXPECT_TRUE(mentions(error_of(box("[\"6 mm\", \"0 mm\"]")).message, "inside out"));
  EXPECT_EQ(error_of(box("[\"0 mm\"]")).key, "heat.boundaries[0].box_low");
}

TEST(ReadHeat, FacesTakeEachKindOnceAndAPrescribedTemperatureAlone) {
  const auto overlap = error_of(conduction_deck(kHeld + with(kHeld, "right", "outline")));
  EXPECT_EQ(overlap.key, "heat.boundaries[1].faces");
  EXPECT_TRUE(mentions(overlap.message, "deck.toml:4"));  // where the first one stands
  EXPECT_EQ(error_of(conduction_deck(kConvection + kConvection)).key, "heat.boundaries[1].faces");
  EXPECT_EQ(error_of(conduction_deck(kHeld + with(kConvection, "left", "right"))).key,
            "heat.boundaries[1].faces");
  EXPECT_TRUE(diagnostics_of(HeatDeck(conduction_deck(kHeld + with(kHeld, "right", "left"))).deck).empty());
}

TEST(ReadHeat, WithAFluxTheTemperatureRangeMustBeStated) {
  const auto d = error_of(conduction_deck(kFlux));
  EXPECT_EQ(d.key, "heat.temperature_range");
  EXPECT_TRUE(mentions(d.message, "missing"));
  // The reader of the deck can go on, to find every other error.
  EXPECT_NO_THROW(temperature_range(*HeatDeck(conduction_deck(kFlux)).heat, kDuration));
  const std::string range = "temperature_range = [\"20 degC\", \"900 degC\"]\n";
  EXPECT_TRUE(diagnostics_of(HeatDeck(conduction_deck(kFlux, range)).deck).empty());
  EXPECT_TRUE(
      mentions(error_of(conduction_deck(kFlux, with(range, "900", "10"))).message, "lower one first"));
  EXPECT_TRUE(mentions(error_of(conduction_deck(kFlux, with(range, "20", "30"))).message, "initial"));
}

TEST(ReadHeat, ConductionNeedsTheHeatPropertiesOfAggregateAndMortar) {
  HeatDeck d(conduction_deck(kConvection) +
             "[materials.aggregate]\nspecific_heat = \"900 J/(kg K)\"\n[materials.mortar]\n");
  const Section materials = d.deck.root().section("materials");
  for (const char* name : {"aggregate", "mortar"})
    materials.section(name).quantity("specific_heat", unit::specific_heat, Range::positive(), 1.0, "");
  std::vector<std::string> keys;
  for (const auto& diagnostic : diagnostics_of(d.deck)) keys.push_back(diagnostic.key);
  EXPECT_EQ(keys,
            (std::vector<std::string>{"materials.aggregate.conductivity", "materials.mortar.conductivity",
                                      "materials.mortar.specific_heat"}));
}

// ---- Range and constancy ---------------------------------------------------------------------------------

TEST(HeatConditions, TemperatureRangeSpansInitialGasAndPrescribedTemperatures) {
  HeatConditions heat = heat_conditions({on("left", convection(25.0, fire_curves().at("iso834").curve)),
                                         on("right", PrescribedTemperature{Curve::constant(-10.0)})});
  const Interval range = temperature_range(heat, kDuration);
  EXPECT_EQ(range.lower, -10.0);
  EXPECT_DOUBLE_EQ(range.upper, 20.0 + 345.0 * std::log10(8.0 * 60.0 + 1.0));  // ISO 834 after an hour
  heat.temperature_range = Interval{0.0, 500.0};
  EXPECT_EQ(temperature_range(heat, kDuration), (Interval{0.0, 500.0}));
}

TEST(HeatConditions, TemperatureRangeWithAFluxIsRefusedUnlessStated) {
  HeatConditions heat = heat_conditions({on("left", HeatFlux{Curve::constant(1e4)})});
  EXPECT_THROW(temperature_range(heat, kDuration), Error);
  heat.temperature_range = Interval{20.0, 900.0};
  EXPECT_EQ(temperature_range(heat, kDuration), (Interval{20.0, 900.0}));
}

TEST(HeatConditions, AFireIsWhatGivesHeatOrWarmsHalfAsFarAsTheHottest) {
  const Curve iso = fire_curves().at("iso834").curve;
  const auto fires = [](std::vector<HeatBoundaryCondition> boundaries) {
    return are_fires(heat_conditions(std::move(boundaries)));
  };
  EXPECT_EQ(fires({on("left", convection(25.0, iso)), on("right", convection(9.0, Curve::constant(35.0))),
                   on("top", PrescribedTemperature{Curve::constant(700.0)}), on("bottom", Adiabatic{})}),
            (std::vector<bool>{true, false, true, false}));
  EXPECT_EQ(fires({on("left", convection(25.0, iso)), on("right", HeatFlux{Curve::constant(1e4)}),
                   on("top", HeatFlux{Curve::constant(-1e4)})}),
            (std::vector<bool>{false, true, false}));
  EXPECT_EQ(fires({on("left", PrescribedTemperature{Curve::constant(-10.0)})}), std::vector<bool>{false});
}

TEST(HeatConditions, BoundaryValuesAreConstantFromTheEndOfARamp) {
  const Curve ramp = Curve::table({0.0, 600.0, 1e9}, {20.0, 70.0, 70.0}, time_axis());
  const auto from = [](const Curve& gas) {
    return constant_from(heat_conditions({on("left", convection(25.0, gas))}), kDuration);
  };
  EXPECT_EQ(from(Curve::constant(100.0)), 0.0);
  EXPECT_NEAR(from(ramp), 600.0, 1e-6 * kDuration);  // accuracy of the search
  EXPECT_NEAR(from(fire_curves().at("iso834").curve), kDuration, 1e-6 * kDuration);
}

// ---- On a specimen ---------------------------------------------------------------------------------------

double area_of(const Conduction<2>& heat, const std::vector<int>& faces) {
  double area = 0.0;
  for (int face : faces) area += heat.outline()[face].area;
  return area;
}

TEST(MakeConduction, TheOutlineIsTheSpecimensOwnUnderThePlatensToo) {
  const auto body = small_body();
  const auto solver = make_conduction(body, alike_materials(), heat_conditions({}), {20.0, 100.0});
  const Conduction<2>& heat = in_plane::conduction(*solver);
  EXPECT_NEAR(area_of(heat, heat.faces([](const auto&) { return true; })),
              2.0 * (kSpecimenWidth + kSpecimenHeight) * kSpecimenThickness, 1e-12);
  EXPECT_NEAR(area_of(heat, heat.faces(on_plane<2>(1, kSpecimenHeight, 1e-9))),
              kSpecimenWidth * kSpecimenThickness, 1e-12);
}

/// Heat that comes in through a part of the outline in a second, over a flux of 1 W/m2: its area.
double heated_area(const ModelOf<2>& body, const BoundaryFaces& faces) {
  HeatConditions heat = heat_conditions({{faces, HeatFlux{Curve::constant(1.0)}, ""}});
  const auto conduction = make_conduction(body, alike_materials(), heat, {20.0, 100.0});
  advance_to(*conduction, 1.0);
  return conduction->ledger().boundary.flux;
}

TEST(MakeConduction, EachPartOfTheOutlineIsHeatedOverItsArea) {
  const auto body = small_body();
  const double wide = kSpecimenWidth * kSpecimenThickness, high = kSpecimenHeight * kSpecimenThickness;
  for (const auto& [part, area] : {std::pair<const char*, double>{"left", high},
                                   {"right", high},
                                   {"bottom", wide},
                                   {"top", wide},
                                   {BoundaryFaces::kOutline, 2.0 * (wide + high)}})
    EXPECT_NEAR(heated_area(body, {.part = part}), area, 1e-9 * area) << part;
  // A box takes whole faces: those with their centres in it. They are at most some 5 mm long.
  EXPECT_NEAR(heated_area(body, {BoundaryFaces::kBox, {{0.0, 0.0}}, {{0.0, 0.05}}}), 0.5 * high,
              0.0025 * kSpecimenThickness);
}

TEST(MakeConduction, ABoxThatMeetsNoFaceIsAnErrorThatNamesIt) {
  const auto body = small_body();
  const BoundaryFaces inside{BoundaryFaces::kBox, {{0.01, 0.01}}, {{0.02, 0.02}}};
  HeatBoundaryCondition boundary = on(BoundaryFaces::kBox, convection(25.0, Curve::constant(100.0)));
  boundary.faces = inside;
  boundary.place = "deck.toml:7: heat.boundaries[0]";
  const HeatConditions heat = heat_conditions({boundary});
  const auto message = message_of(body, heat);
  EXPECT_TRUE(mentions(message, "deck.toml:7")) << message;
  EXPECT_TRUE(mentions(message, "no face")) << message;
}

TEST(MakeConduction, ConditionsThatContradictEachOtherOnOneFaceAreAnError) {
  const auto body = small_body();
  const BoundaryFaces lower_left{BoundaryFaces::kBox, {{0.0, 0.0}}, {{0.0, 0.05}}};
  const PrescribedTemperature held{Curve::constant(50.0)};
  EXPECT_TRUE(mentions(
      message_of(body, heat_conditions({on("left", held), {lower_left, held, "deck.toml:9"}})), "already"));
  EXPECT_TRUE(mentions(message_of(body, heat_conditions({on("left", convection(25.0, Curve::constant(100.0))),
                                                         {lower_left, Adiabatic{}, "deck.toml:9"}})),
                       "already"));
  EXPECT_NO_THROW(make_conduction(
      body, alike_materials(), heat_conditions({on("right", held), {lower_left, held, ""}}), {20.0, 1000.0}));
}

TEST(MakeConduction, AMaterialWithoutConductivityIsNamed) {
  auto block_materials = alike_materials();
  block_materials[mortar_material].conductivity.reset();
  EXPECT_TRUE(mentions(message_of(small_body(), heat_conditions({}), block_materials),
                       "materials.mortar.conductivity"));
}

}  // namespace
}  // namespace pyroclast
