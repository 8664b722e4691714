// Promise: what a deck states acts on something, or the check refuses it with its place.
#include "pyroclast/setup/effects.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "stages/drives.hpp"

namespace pyroclast {
namespace {

void expect_contains(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) expect_in(part, text);
}

const std::string kConduct = "[[stages]]\nkind = \"conduct\"\nduration = \"1 min\"\ninterval = \"1 min\"\n";

std::string conducting(const std::string& stages) {
  return with(deck(stages + kHeatedFace), "frame_strain = 1e-3\n",
              "frame_strain = 1e-3\nframe_interval = \"1 min\"\n");
}

/// What is said of a deck when it is read and its body is made.
std::string refused(const std::string& text) {
  return message([&] { const Trial trial(text); });
}

TEST(Effects, TemperaturesThatNobodyHandsOverAreRefused) {
  const auto complaint = refused(conducting(kSettle + kConduct + kCompress));
  expect_contains(complaint,
                  {"deck.toml:", "stages[2].kind = \"compress\"",
                   "no stage has handed over the temperatures of stage 2 (conduct)", "\"expose\""});
  EXPECT_EQ(refused(conducting(kSettle + kConduct + kExpose + kCompress)), "no Error was thrown");
}

// What `conduct` reached and left again counts as T_max at the next exchange: what heat took does not come
// back.
TEST(Effects, TheHottestThatConductReachedIsNotForgotten) {
  const auto strength = [&](const std::string& hottest) {
    const std::string up_and_down = "{ table = [[\"0 s\", \"20 degC\"], [\"2 min\", \"" + hottest +
                                    "\"], [\"10 min\", \"" + hottest +
                                    "\"], [\"12 min\", \"30 degC\"], [\"31 min\", \"30 degC\"]] }";
    const Finished run(
        with(with(conducting(kSettle + with(kConduct, "duration = \"1 min\"", "duration = \"30 min\"") +
                             with(kExpose, "6 min", "1 min") + kFailure),
                  "{ from = \"20 degC\", rate = \"10 K/min\", to = \"70 degC\" }", up_and_down),
             "on_cooling = \"reversible\"", "on_cooling = \"irreversible\""));
    return run.result(3, "f_c_MPa").value();
  };
  EXPECT_LT(strength("520 degC"), 0.75 * strength("30 degC"));
}

TEST(Effects, HeatThatCannotFlowIsRefused) {
  expect_contains(refused(conducting(kSettle + kCompress)), {"heat.boundaries", "no stage lets heat flow"});
}

TEST(Effects, ABoundaryThatLetsNoHeatThroughIsRefused) {
  const auto boundary = [](const std::string& keys) {
    return refused(conducting(kSettle + kExpose) + "[[heat.boundaries]]\nfaces = \"right\"\n" + keys);
  };
  const std::string gas = "gas_temperature = \"300 degC\"\n";
  const std::string none_through = "lets no heat through";
  expect_contains(boundary("kind = \"convection\"\ncoefficient = \"0 W/(m2 K)\"\n" + gas),
                  {"deck.toml:", "heat.boundaries[1].coefficient", none_through, "\"adiabatic\""});
  expect_contains(boundary("kind = \"radiation\"\nemissivity = 0\n" + gas),
                  {"deck.toml:", "heat.boundaries[1].emissivity", none_through});
  expect_contains(boundary("kind = \"convection\"\ncoefficient = { table = [[\"0 s\", \"0 W/(m2 K)\"], "
                           "[\"1 h\", \"0 W/(m2 K)\"]] }\n" +
                           gas),
                  {"heat.boundaries[1].coefficient", none_through});
  EXPECT_EQ(boundary("kind = \"convection\"\ncoefficient = { table = [[\"0 s\", \"0 W/(m2 K)\"], "
                     "[\"1 h\", \"9 W/(m2 K)\"]] }\n" +
                     gas),
            "no Error was thrown");
  expect_contains(
      refused(with(conducting(kSettle + kExpose), kHeatedFace,
                   "[heat]\nfield = \"conduction\"\ntemperature_range = [\"20 degC\", \"90 degC\"]\n"
                   "[[heat.boundaries]]\nfaces = \"left\"\nkind = \"flux\"\nflux = \"0 W/m2\"\n")),
      {"heat.boundaries[0].flux", none_through});
}

std::string with_stress_free(const std::string& text, const std::string& at) {
  return with(text, "failure_strain = 0.005\n", "failure_strain = 0.005\nstress_free = \"" + at + "\"\n");
}

/// Warnings of a deck, a line each.
std::string warnings_of(const std::string& text) {
  std::string lines;
  for (const Diagnostic& warning : read(text).warnings) lines += to_string(warning) + "\n";
  return lines;
}

// Promise: a temperature that changes nothing is told; the first of a series of temperatures may be such.
TEST(Effects, TemperaturesThatStayAreTold) {
  const std::string face =
      "[heat]\nfield = \"conduction\"\ninitial = \"70 degC\"\n[[heat.boundaries]]\n"
      "faces = \"left\"\n";
  const auto only = [&](const std::string& keys) {
    return warnings_of(with(conducting(kSettle + kExpose), kHeatedFace, face + keys));
  };
  const std::string stays = "leave the specimen at 70 degC";
  expect_contains(only("kind = \"adiabatic\"\n"), {"deck.toml:", "heat.boundaries", stays});
  expect_contains(only("kind = \"temperature\"\ntemperature = \"70 degC\"\n"), {"heat.boundaries", stays});
  expect_out(stays, only("kind = \"temperature\"\ntemperature = \"71 degC\"\n"));
  const std::string twice =
      warnings_of(deck(kUniform + kSettle + heat("20 degC") + heat("50 degC") + heat("50 degC")));
  expect_contains(twice, {"stages[1].to = \"20 degC\": is the temperature that the specimen has already",
                          "stages[3].to = \"50 degC\""});
  expect_out("stages[2]", twice);
  expect_out("has already",
             warnings_of(deck(kUniform + kSettle + heat("50 degC") + heat("20 degC") + heat("50 degC"))));
}

// Promise: a flux changes the body, to whatever temperature.
TEST(Effects, AFluxLeavesNoBodyAsItIs) {
  const std::string text = conducting(kSettle + kExpose);
  const auto said = [&](HeatCondition condition) {
    const Deck deck = Deck::parse(text, "deck.toml");
    pyroclast::Setup setup = read(text);
    setup.heat.boundaries[0].condition = std::move(condition);
    warn_of_even_temperatures(deck.root(), setup);
    return deck.warnings().size();
  };
  EXPECT_EQ(said(Adiabatic{}), 1U);
  EXPECT_EQ(said(HeatFlux{Curve::constant(1.0)}), 0U);
}

// Promise: `conduct` lets heat flow too, and a deck without boundaries needs no flow.
TEST(Effects, WhoHasNoBoundaryNeedsNoFlow) {
  EXPECT_EQ(refused(conducting(kSettle + kConduct)), "no Error was thrown");
  EXPECT_EQ(refused(conducting(kSettle + with(kConduct, "duration = \"1 min\"", "duration = \"0.5 s\""))),
            "no Error was thrown");
  EXPECT_EQ(refused(deck(kUniform + kSettle)), "no Error was thrown");
}

TEST(Effects, PropertiesThatNoTemperatureCallsForAreTold) {
  const std::string creeps =
      "[materials.mortar.creep]\nstrain = { table = [[\"20 degC\", 0], [\"800 degC\", "
      "0.01]] }\n";
  const auto told = [&](const std::string& stages) {
    return read(with(deck(kUniform + kSettle + stages + creeps), "expansion = \"1e-5 1/K\"\n",
                     "expansion = \"1e-5 1/K\"\ncontraction = \"5e-6 1/K\"\nquartz_step = 0.004\n"))
        .unused_properties;
  };
  const std::string quartz = "materials.aggregate.quartz_step begins at 550 degC, and the run comes to ";
  EXPECT_EQ(told(kCompress), (std::vector<std::string>{
                                 quartz + "20 degC at most, so that it has no effect",
                                 "materials.aggregate.contraction, materials.mortar.creep: no temperature "
                                 "changes in this run, so that they have no effect"}));
  EXPECT_EQ(told(heat("500 degC")),
            std::vector<std::string>{quartz + "500 degC at most, so that it has no effect"});
  EXPECT_EQ(told(heat("550 degC")),
            std::vector<std::string>{quartz + "550 degC at most, so that it has no effect"});
  EXPECT_EQ(told(heat("560 degC")), std::vector<std::string>());
}

// Promise: shares left after cooling, of a phase and of contacts, are told too, one key and several; where a
// stage changes the temperature, or the body begins strained, all keys act.
TEST(Effects, ResidualRatiosThatNoTemperatureCallsForAreTold) {
  const std::string residual = "residual_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.1]] }\n";
  const std::string irreversible =
      with(deck(kUniform + kSettle), "on_cooling = \"reversible\"", "on_cooling = \"irreversible\"");
  const std::string of_contact =
      with(irreversible, "[contacts.mortar_mortar]\n", "[contacts.mortar_mortar]\n" + residual);
  const auto told = [](const std::string& text) { return read(text).unused_properties; };
  const std::string none = ": no temperature changes in this run, so that ";
  EXPECT_EQ(told(irreversible), std::vector<std::string>());
  EXPECT_EQ(told(of_contact),
            std::vector<std::string>{"contacts.mortar_mortar.residual_ratio" + none + "it has no effect"});
  EXPECT_EQ(
      told(with(of_contact, "[materials.mortar]\n", "[materials.mortar]\n" + residual)),
      std::vector<std::string>{"materials.mortar.residual_ratio, contacts.mortar_mortar.residual_ratio" +
                               none + "they have no effect"});
  EXPECT_EQ(told(of_contact + heat("20 degC")).size(), 1U);
  EXPECT_EQ(told(of_contact + heat("21 degC")), std::vector<std::string>());
  EXPECT_EQ(told(with_stress_free(of_contact, "35 degC")), std::vector<std::string>());
}

// Promise: where heat alone moves, contacts have no properties to be told of.
TEST(Effects, HeatAloneHasNoContactsWithProperties) {
  const std::string text = deck(kUniform + kSettle);
  const Deck deck = Deck::parse(text, "deck.toml");
  pyroclast::Setup setup = read(text);
  setup.moving.reset();
  EXPECT_EQ(unused_properties(deck.root(), setup), std::vector<std::string>());
  setup.block_materials[1].contraction = 5e-6;
  EXPECT_EQ(unused_properties(deck.root(), setup).size(), 1U);
}

TEST(Effects, ATemperatureWithoutStressOfABodyThatDoesNotExpandIsTold) {
  const auto of = [](const std::string& expansion, const std::string& heat) {
    std::string text = with(deck(heat + kSettle, "\"" + expansion + "\""), "failure_strain = 0.005\n",
                            "failure_strain = 0.005\nstress_free = \"35 degC\"\n");
    return warnings_of(with(text, "expansion = \"1e-5 1/K\"\n", "expansion = \"" + expansion + "\"\n"));
  };
  const std::string nothing = of("0 1/K", kUniform);
  expect_contains(nothing, {"deck.toml:", "coupling.stress_free = \"35 degC\": strains nothing"});
  expect_out("acts at once", nothing);
  expect_contains(of("1e-5 1/K", kUniform),
                  {"heat.initial", "unstrained at 35 degC", "to 20 degC acts at once"});
  expect_contains(of("1e-5 1/K", ""),
                  {"deck.toml:", "coupling.stress_free = \"35 degC\": the body is unstrained"});
}

/// What is said of the first strain of a body, of which a test has changed something since the deck was read.
std::string said_of_first_strain(const std::string& text,
                                 const std::function<void(pyroclast::Setup&)>& change) {
  const Deck deck = Deck::parse(text, "deck.toml");
  pyroclast::Setup setup = read(text);
  change(setup);
  warn_of_first_strain(deck.root(), setup);
  std::string lines;
  for (const Diagnostic& warning : deck.warnings()) lines += to_string(warning) + "\n";
  return lines;
}

// Promise: a body expands where a phase strains upwards or downwards, contracts as it cools, or has its
// strain from the concrete; what a bearing does is no strain of the body.
TEST(Effects, ABodyExpandsByAnyOfItsPhases) {
  const std::string text = with_stress_free(deck(kUniform + kSettle), "35 degC");
  const auto strain = [](double at_hundred) {
    return Curve::table({0.0, 20.0, 100.0}, {0.0, 0.0, at_hundred}, temperature_axis());
  };
  const auto expands = [&](const std::function<void(std::vector<BlockMaterial>&, MovingBody&)>& change) {
    const std::string said = said_of_first_strain(text, [&](pyroclast::Setup& setup) {
      for (BlockMaterial& material : setup.block_materials) material.thermal_strain = Curve::constant(0.0);
      change(setup.block_materials, *setup.moving);
    });
    EXPECT_NE(said.find("strains nothing") == std::string::npos,
              said.find("acts at once") == std::string::npos);
    return said.find("strains nothing") == std::string::npos;
  };
  EXPECT_FALSE(expands([](auto&, auto&) {}));
  EXPECT_FALSE(expands([&](auto& materials, auto&) { materials[0].thermal_strain = strain(0.0); }));
  EXPECT_TRUE(expands([&](auto& materials, auto&) { materials[0].thermal_strain = strain(1e-3); }));
  EXPECT_TRUE(expands([&](auto& materials, auto&) { materials[1].thermal_strain = strain(-1e-3); }));
  EXPECT_TRUE(expands([](auto& materials, auto&) { materials[1].contraction = 5e-6; }));
  EXPECT_FALSE(expands([&](auto& materials, auto&) {
    EXPECT_TRUE(materials.back().is_of_bearing);
    materials.back().thermal_strain = strain(1e-3);
    materials.back().contraction = 5e-6;
  }));
  EXPECT_TRUE(
      expands([&](auto&, auto& moving) { moving.strain_of_concrete.emplace().strain = strain(1e-3); }));
  EXPECT_FALSE(
      expands([&](auto&, auto& moving) { moving.strain_of_concrete.emplace().strain = strain(0.0); }));
}

// Promise: a body that begins at another temperature than the one without stress is told both, and how to
// say another; one that begins there, that does not expand, or whose temperatures without stress are a field,
// is told nothing.
TEST(Effects, AStrainAtTheFirstStepIsTold) {
  const std::string warm = deck("[heat]\nfield = \"uniform\"\ninitial = \"50 degC\"\n" + kSettle);
  const auto nothing = [](pyroclast::Setup&) {};
  const std::string at_once = "degC acts at once at the first step, which can crack it";
  const std::string another =
      ": a stage that heats the body does so gradually; coupling.stress_free says another temperature\n";
  expect_contains(
      said_of_first_strain(warm, nothing),
      {"heat.initial", "unstrained at 20 degC, and its strain from there to 50 " + at_once + another});
  expect_contains(said_of_first_strain(with_stress_free(warm, "35 degC"), nothing),
                  {"heat.initial", "unstrained at 35 degC", "50 " + at_once + "\n"});
  EXPECT_EQ(said_of_first_strain(with_stress_free(warm, "50 degC"), nothing), "");
  EXPECT_EQ(said_of_first_strain(deck(kUniform + kSettle), nothing), "");
  EXPECT_EQ(said_of_first_strain(warm,
                                 [](pyroclast::Setup& setup) {
                                   for (BlockMaterial& material : setup.block_materials)
                                     material.thermal_strain = Curve::constant(0.0);
                                 }),
            "");
  EXPECT_EQ(
      said_of_first_strain(with_stress_free(warm, "35 degC"),
                           [](pyroclast::Setup& setup) { setup.moving->stress_free->places.push_back({}); }),
      "");
  EXPECT_EQ(said_of_first_strain(warm, [](pyroclast::Setup& setup) { setup.moving.reset(); }), "");
}

TEST(Effects, TheGasOfCracksIsKnownAtAllTemperatures) {
  const std::string hot = with(conducting(kSettle + kExpose), "to = \"70 degC\"", "to = \"69 degC\"");
  const std::string cracks = "[heat.cracks]\n";
  EXPECT_EQ(refused(hot + cracks), "no Error was thrown");
  expect_contains(refused(with(hot, "field = \"conduction\"\n",
                               "field = \"conduction\"\ntemperature_range = [\"-260 degC\", \"90 degC\"]\n") +
                          cracks),
                  {"deck.toml:", "heat.cracks.gas_conductivity", "is needed", "-260"});
}

TEST(Effects, ABoundaryWithoutAFaceIsRefused) {
  const std::string inside =
      "[[sets]]\nname = \"inside\"\nbox = [[\"20 mm\", \"40 mm\"], [\"40 mm\", \"80 mm\"]]\n"
      "[[heat.boundaries]]\nfaces = \"inside\"\nkind = \"convection\"\ncoefficient = \"25 W/(m2 K)\"\n"
      "gas_temperature = \"40 degC\"\n";
  expect_contains(refused(conducting(kSettle + kExpose) + inside),
                  {"deck.toml:", "no face of the outline lies wholly in \"inside\""});
}

std::string with_reference(const std::string& text, const std::string& keys) {
  return with(text, "frame_strain = 1e-3\n", "frame_strain = 1e-3\n[[output.references]]\n" + keys + "\n");
}

TEST(Effects, AReferenceThatNoFigureDrawsIsRefused) {
  const std::string heated = deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC"));
  expect_contains(refused(with_reference(heated, "builtin = \"compression\"")),
                  {"deck.toml:", "output.references[0].builtin = \"compression\"",
                   "no figure of this run draws it", "\"total_strain\" over temperature"});
  EXPECT_EQ(refused(with_reference(heated, "builtin = \"transient_strain\"")), "no Error was thrown");
  expect_contains(
      refused(with_reference(deck(kUniform + kSettle + kCompress), "builtin = \"transient_strain\"")),
      {"no figure of this run draws it; the figures of this run draw \"stress\" over strain"});
}

// A thrust needs platens that are held in place; computed temperatures are drawn over the time.
TEST(Effects, WhatAReferenceIsDrawnOverFollowsTheRun) {
  const auto refused_of = [](const std::string& text, const std::string& keys) {
    return refused(with_reference(text, "file = \"gone.csv\"\n" + keys));
  };
  const std::string heated = deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC"));
  expect_contains(refused_of(heated, "of = \"stress\""),
                  {"output.references[0].of = \"stress\"", "no figure"});
  expect_contains(refused_of(heated, "of = \"total_strain\"\nover = \"heating_time\""),
                  {"output.references[0].over", "over it, but over \"temperature\""});
  const std::string computed = conducting(kSettle + kExpose);
  expect_contains(refused_of(computed, "of = \"total_strain\"\nover = \"temperature\""),
                  {"over it, but over \"heating_time\""});
  expect_contains(refused_of(computed, "of = \"temperatur\""),
                  {"no figure", "did you mean \"temperature\"?"});
  expect_contains(refused_of(computed, "of = \"temperature\""), {"gone.csv"});
  expect_contains(refused(with_reference(computed, "builtin = \"transient_strain\"")),
                  {"no figure of this run draws \"total_strain\" over it, but over \"heating_time\""});
}

TEST(Effects, AReferenceOfARecordIsDrawnOverTheFirstOpeningOrDisplacement) {
  const std::string records =
      record("widening", "displacement", "set = \"left\"\ndirection = \"x\"") +
      record("grip", "force", "set = \"top\"\ndirection = \"y\"") +
      record("gap", "opening", "set = \"left\"\nother = \"right\"\ndirection = \"x\"");
  const auto over = [&](const std::string& keys) {
    return refused(
        with_reference(deck(kUniform + kSettle + records), "file = \"gone.csv\"\nof = \"grip\"\n" + keys));
  };
  expect_contains(over("over = \"nothing\""), {"over it, but over \"gap\", \"time\", \"widening\""});
  expect_contains(over(""), {"output.references[0].file", "gone.csv"});
}

TEST(Effects, ASetThatNoTableNamesIsTold) {
  const std::string sets =
      "[[sets]]\nname = \"mine\"\nwithin = \"left\"\n[[sets]]\nname = \"used\"\nwithin = \"top\"\n" +
      record("u", "displacement", "set = \"used\"\ndirection = \"y\"");
  EXPECT_EQ(read(deck(kUniform + kSettle + sets)).unused_sets, std::vector<std::string>{"mine"});
}

// Promise: a set is used by a stage, a record, as the first or the other one, a boundary, another set, or a
// part with finer blocks; the others are told in their order.
TEST(Effects, ASetIsUsedByAnyTableThatNamesIt) {
  pyroclast::Setup setup = read(deck(kUniform + kSettle +
                                     drive("name = \"pull\"\nduration = \"1 ms\"",
                                           does("driven", "direction = \"x\"\nvelocity = \"1 mm/s\"")) +
                                     "[[sets]]\nname = \"driven\"\nwithin = \"left\"\n"));
  EXPECT_EQ(setup.unused_sets, std::vector<std::string>());
  for (const char* name : {"mine", "recorded", "other", "heated", "whole", "fine", "yours"})
    setup.sets.push_back({.name = name, .within = "left", .place = {}});
  setup.sets.back().within = "whole";
  setup.records = {{.name = "gap", .set = "recorded", .other = "other"}};
  setup.heat.boundaries = {{.faces = {.part = "heated"}, .condition = Adiabatic{}, .place = ""}};
  setup.specimen.blocks.finer = {{.name = "fine"}};
  EXPECT_EQ(unused_sets(setup), (std::vector<std::string>{"mine", "yours"}));
}

TEST(Effects, WhatIsNearestToAPlaceFarFromTheBodyIsRefused) {
  const auto nearest = [](const std::string& place) {
    return deck(kUniform + kSettle) + "[[sets]]\nname = \"spot\"\nnearest = " + place + "\n";
  };
  EXPECT_EQ(refused(nearest("[\"62 mm\", \"60 mm\"]")), "no Error was thrown");
  expect_contains(refused(nearest("[\"600 mm\", \"60 mm\"]")),
                  {"deck.toml:", "set \"spot\"", "0.54 m from the body"});
}

}  // namespace
}  // namespace pyroclast
