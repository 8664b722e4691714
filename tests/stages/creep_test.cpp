#include <cmath>

#include <gtest/gtest.h>

#include "known.hpp"
#include "stages/small_runs.hpp"

/// Runs whose mortar, or all of whose blocks, creep when they are heated under load.
namespace pyroclast {
namespace {

/// An even body: aggregate and mortar alike, neither softens nor expands.
std::string even_body(const std::string& stages, const std::string& creep) {
  std::string text = with(deck(kUniform + kSettle + stages, "\"0 1/K\""), "expansion = \"1e-5 1/K\"", "");
  for (int i = 0; i < 2; ++i)
    text = with(text,
                "E = { value = \"29.4 GPa\", times = { table = [[\"20 degC\", 1], [\"820 degC\", 0.2]] } }",
                "E = \"29.4 GPa\"");
  const std::string table = "creep]\nof = \"phase\"\n" + creep;
  return text + "[materials.mortar." + table + "[materials.aggregate." + table;
}

/// B, steeper from 220 °C on.
const std::string kB =
    "strain = { table = [[\"20 degC\", 0], [\"220 degC\", 4e-3], [\"820 degC\", 34e-3]] }\n";

constexpr double kStrainAt220 = 4e-3, kStrainAt270 = 6.5e-3;

// Promise: an even body that is heated under a held load shortens by B(T) for each unit of load over f_c, and
// widens by nu_L of that; in any increments, with and without predictor.
TEST(CreepInARunVerification, AnEvenBodyShortensByBOfTheTemperature) {
  const std::string text = even_body(load("stress = \"2 MPa\"") + heat("220 degC"), kB);
  const double expected = 2e6 / 35e6 * kStrainAt220;
  for (const bool predicted : {false, true}) {
    const Finished r(predicted ? with(text, "least_cycles = 50", "least_cycles = 50\npredictor = true")
                               : text);
    ASSERT_EQ(r.run.outcome(), Outcome::completed);
    const double crept = r.last("specimen_strain") - r.end_of(1, "specimen_strain");
    if (!predicted)
      expect_known({"Creep of an even specimen under a held load, 20 to 220 degC", "B load / f_c", "1"},
                   crept, expected, 0.01 * expected);
    EXPECT_NEAR(crept, expected, 0.01 * expected) << predicted;
    EXPECT_NEAR(r.last("lateral_strain") - r.end_of(1, "lateral_strain"), 0.3 * expected, 0.02 * expected);
    EXPECT_LT(r.energy_error_over_turnover(), 1e-6);
    const double volume = 0.06 * 0.12 * 1.0;
    EXPECT_NEAR(r.last("dissipated_creep_J"), 2e6 * expected * volume, 0.02 * 2e6 * expected * volume);
  }
}

// Promise: the predictor foretells creep, which no free expansion bounds.
TEST(CreepInARun, IsForetoldByThePredictor) {
  const std::string text = even_body(load("stress = \"2 MPa\"") + heat("220 degC"), kB);
  const Finished plain(text);
  const Finished predicted(with(text, "least_cycles = 50", "least_cycles = 50\npredictor = true"));
  EXPECT_LT(predicted.result(2, "cycles").value(), 0.8 * plain.result(2, "cycles").value());
}

// Promise: cooling and heating again up to where the body was brings no creep; beyond, what B rises there.
TEST(CreepInARun, IsThatOfTheFirstHeatingAlone) {
  const Finished r(even_body(
      load("stress = \"2 MPa\"") + heat("220 degC") + heat("60 degC") + heat("220 degC") + heat("270 degC"),
      kB));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  const auto lost = [&](int stage) { return r.end_of(stage, "dissipated_creep_J"); };
  EXPECT_EQ(lost(1), 0.0);
  EXPECT_GT(lost(2), 0.0);
  EXPECT_EQ(lost(3), lost(2));
  EXPECT_EQ(lost(4), lost(2));
  const auto strain = [&](int stage) { return r.end_of(stage, "specimen_strain"); };
  EXPECT_NEAR((strain(5) - strain(4)) / (strain(2) - strain(1)), (kStrainAt270 - kStrainAt220) / kStrainAt220,
              0.01);
  EXPECT_NEAR(strain(4), strain(2), 1e-3 * strain(2));
}

// Promise: the body counts as brought to its first temperature without stress.
TEST(CreepInARun, BeginsAboveTheFirstTemperature) {
  const std::string text = even_body(load("stress = \"2 MPa\"") + heat("220 degC") + heat("270 degC"), kB);
  const Finished r(with(text, "field = \"uniform\"", "field = \"uniform\"\ninitial = \"220 degC\""));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_EQ(r.end_of(2, "dissipated_creep_J"), 0.0);
  const double expected = 2e6 / 35e6 * (kStrainAt270 - kStrainAt220);
  EXPECT_NEAR(r.end_of(3, "specimen_strain") - r.end_of(2, "specimen_strain"), expected,
              3e-6);  // what motion is left
}

// Promise: in a computed field each zone creeps by its own temperature.
TEST(CreepInARun, FollowsTheComputedField) {
  std::string text = with(deck(kSettle + load("stress = \"0.5 MPa\"") + kExpose + kHeatedFace),
                          "most_cycles = 5000", "most_cycles = 2000");
  text += "[materials.mortar.creep]\nof = \"phase\"\n" + kB;
  const Finished r(text);
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_GT(r.last("dissipated_creep_J"), 0.0);
  const auto& model = r.simulation->model();
  const auto blocks = zone_blocks(model);
  const int mortar = 1;
  ASSERT_EQ(model.material_names[mortar], "mortar");
  for (int z = 0; z < model.zone_count(); ++z) {
    const bool creeps = model.block_material[blocks[z]] == mortar;
    const double crept = r.simulation->motion().read().creep_strain(z)[1];
    EXPECT_EQ(crept != 0.0, creeps) << z;
  }
  EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
}

// Promise: what a deck gets wrong is said at its key.
TEST(CreepInADeck, IsRefusedWhereItMakesNoSense) {
  const auto error_of = [](const std::string& table) -> std::string {
    try {
      pyroclast::read(deck(kUniform + kSettle + heat("420 degC")) + "[materials.mortar.creep]\n" + table);
      return {};
    } catch (const DeckError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(error_of(kB), "");
  const std::string falling =
      error_of("strain = { table = [[\"20 degC\", 0], [\"200 degC\", 2e-3], [\"820 degC\", 1e-3]] }\n");
  EXPECT_NE(falling.find("materials.mortar.creep.strain"), std::string::npos) << falling;
  EXPECT_NE(falling.find("falls from 0.002 at 200 degC"), std::string::npos) << falling;
  EXPECT_NE(error_of("k2 = 2.35\n").find("needs the thermal strain of the concrete"), std::string::npos);
  const std::string unread = error_of("k2 = 2.35\n[concrete]\nthermal_strain = { builtin = \"none\" }\n");
  EXPECT_NE(unread.find("concrete.thermal_strain"), std::string::npos) << unread;
  EXPECT_EQ(unread.find("k2"), std::string::npos) << unread;  // one fault, one error
  EXPECT_NE(error_of("k2 = 2.35\n" + kB).find("no meaning beside \"k2\""), std::string::npos);
  EXPECT_NE(error_of("of = \"phase\"\nshare = 0.6\n" + kB).find("share"), std::string::npos);
  EXPECT_NE(error_of("nu = 0.6\n" + kB).find("materials.mortar.creep.nu"), std::string::npos);
  EXPECT_NE(error_of("strain = { builtin = \"li_purkiss_strength\" }\n").find("is 1.0"), std::string::npos);
}

// Promise: the creep of the concrete is that of its mortar times R of this specimen, or what the deck says;
// and the free strains of both phases make that of the concrete.
TEST(CreepInADeck, IsTakenToTheMortar) {
  const std::string concrete =
      "[concrete]\nthermal_strain = { builtin = \"glasgow_free_thermal_strain\" }\ninclusion_ratio = 1.25\n";
  std::string text = with(deck(kUniform + kSettle + heat("420 degC"), ""), "expansion = \n", "");
  text = with(text, "expansion = \"1e-5 1/K\"\n", "");
  const auto materials = [&](const std::string& tables) {
    return Trial(text + concrete + tables).simulation->materials();
  };
  const auto k2 = materials("[materials.mortar.creep]\nk2 = 2.35\nshare = 0.6\n");
  const double free_strain = 0.006 * std::log(7.0 / (7.0 - 4.0));
  const auto& mortar = k2.block_materials[1];
  ASSERT_EQ(mortar.name, "mortar");
  EXPECT_NEAR(mortar.creep->strain(420.0), 2.35 * free_strain / 0.6, 1e-12);
  const auto own = materials("[materials.mortar.creep]\nstrain = { builtin = \"glasgow_creep\" }\n");
  const auto [share, far] = *own.composition->creep_share;
  const double weight = *own.composition->strain_weight;
  const double of_mortar = own.block_materials[1].creep->strain(420.0),
               of_concrete = 0.0005 * 16.0 + 0.00125 * 4.0;
  // some eleven times its elastic strain
  EXPECT_NEAR(of_mortar * far, of_concrete, 0.005 * of_concrete);
  EXPECT_GT(of_mortar * share, of_concrete);
  EXPECT_GT(own.composition->inclusions, 0.03);
  // alike but for the creep, so that shares of the volume are weights, and R is near that of the mortar
  EXPECT_NEAR(weight, own.composition->inclusions, 1e-12);
  EXPECT_NEAR(share, 1.0 - own.composition->inclusions, 0.15);
  EXPECT_NEAR(own.block_materials[0].thermal_strain(420.0), 1.25 * free_strain, 1e-15);
  EXPECT_NEAR(weight * own.block_materials[0].thermal_strain(420.0) +
                  (1.0 - weight) * own.block_materials[1].thermal_strain(420.0),
              free_strain, 1e-15);
  EXPECT_THROW(pyroclast::read(deck(kUniform + kSettle + heat("420 degC")) + concrete), DeckError);
}

// Promise: an uncracked solid creeps by what its deck says of the concrete, for its stones count as balls:
// with the discs of a body in the plane it crept by 0.88 of that at 100 degC.
TEST(CreepInADeck, OfASolidIsThatOfItsConcrete) {
  std::string deck = shipped_case("transient_heating_3d");
  for (const auto& [from, to] : {std::pair{"count = 2000", "count = 600"},
                                 {"inclusion_ratio = 1.25", "inclusion_ratio = 1.0"},
                                 {"max(1 - 0.01784*((T-20)/100)^2, 0.01)", "1 + 0*T"},
                                 {"f_t = \"1.8 MPa\"", "f_t = \"25 MPa\""},
                                 {"90 N/m", "6 kN/m"},
                                 {"f_cm = \"48 MPa\"", "f_cm = \"1 GPa\""},
                                 {"c_o = \"7.5 MPa\"", "c_o = \"100 MPa\""},
                                 {"300 N/m", "24 kN/m"},
                                 {"level = 0.445", "level = 0.23"},
                                 {"ramp_time = \"200 ms\"", "ramp_time = \"20 ms\""},
                                 {"unbalanced_ratio = 1e-4", "unbalanced_ratio = 1e-3"},
                                 {"to = \"800 degC\"", "to = \"100 degC\""},
                                 {"exchange_increment = \"4 K\"", "exchange_increment = \"5 K\""},
                                 {"least_cycles = 1000", "least_cycles = 600"}})
    deck = with(deck, from, to);
  const auto strain = [](const std::string& text) {
    const Finished r(text);
    EXPECT_EQ(r.run.outcome(), Outcome::completed);
    EXPECT_EQ(r.last("dissipated_tension_J") + r.last("dissipated_shear_J"), 0.0);
    return r.last("specimen_strain");
  };
  const double crept = strain(deck) - strain(with(deck, "k2 = 2.5", "k2 = 1e-9"));
  const double said = 2.5 * 0.006 * std::log(7.0 / (7.0 - 0.8)) * 0.23;
  EXPECT_GT(crept, 0.93 * said);
  EXPECT_LT(crept, 1.05 * said);
}

}  // namespace
}  // namespace pyroclast
