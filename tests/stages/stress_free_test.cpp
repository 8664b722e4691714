#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "known.hpp"
#include "messages.hpp"
#include "own_folder.hpp"
#include "stages/small_runs.hpp"

/// Runs of bodies that were put together at another temperature than 20 degC.
namespace pyroclast::stress_free_test {
namespace {

constexpr int kCells = 6, kFirstStone = 2, kStones = 2;
constexpr double kSize = 0.01;                                       // of a cell, m
constexpr double kMortar = 30e9, kStone = 60e9, kLayer = 1.6e-3;     // E, Pa; t_b, m
constexpr double kMortarExpansion = 1.2e-5, kStoneExpansion = 6e-6;  // 1/K

/// A bar of squares along x, with an inclusion of stone in its middle.
std::filesystem::path bar_file() {
  std::string vertices, cells, phases;
  for (int i = 0; i <= kCells; ++i)
    vertices += (i ? ", " : "") + fmt::format("[{0}, 0.0], [{0}, {1}]", i * kSize, kSize);
  for (int i = 0; i < kCells; ++i) {
    cells += (i ? ", " : "") + fmt::format("[{}, {}, {}, {}]", 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    phases += (i ? ", " : "") + std::string(kFirstStone <= i && i < kFirstStone + kStones ? "1" : "0");
  }
  const auto path = own_folder() / "stress_free_bar.json";
  std::ofstream(path) << "{\"phases\": [\"mortar\", \"aggregate\"], \"vertices_m\": [" << vertices
                      << "], \"cells\": [" << cells << "], \"phase\": [" << phases << "]}";
  return path;
}

std::string material(const std::string& name, double young, double expansion) {
  return fmt::format(
      "[materials.{}]\nE = \"{} Pa\"\nnu = 0.0\ndensity = \"2200 kg/m3\"\nexpansion = \"{} 1/K\"\n", name,
      young, expansion);
}

/// The bar between fixed ends, at rest. It is held across, too: without a lateral contraction that does
/// nothing to it along, and keeps mortar and stone from rubbing on each other.
std::string bar_deck(const std::string& initial, const std::string& coupling) {
  std::string sets, held;
  for (const char* side : {"left", "right"})
    held += std::string("[[stages.drives]]\nset = \"") + side + "\"\nhold = [\"x\"]\n";
  for (const char* side : {"bottom", "top"})
    held += std::string("[[stages.drives]]\nset = \"") + side + "\"\nhold = [\"y\"]\n";
  return "title = \"bar\"\n[specimen]\nshape = \"cells\"\nfile = \"" + bar_file().string() +
         "\"\n[materials]\n" + material("mortar", kMortar, kMortarExpansion) +
         material("aggregate", kStone, kStoneExpansion) +
         "[contacts]\nt_b = \"1.6 mm\"\nt_b_scaling = \"fixed\"\n"
         "[contacts.mortar_mortar]\nlaw = \"elastic\"\n"
         "[contacts.aggregate_mortar]\nlike = \"mortar_mortar\"\nstiffness_factor = 1.0\n"
         "[contacts.aggregate_aggregate]\nlaw = \"elastic\"\n"
         "[mechanics]\nmass = \"scaled\"\ntime_step = \"1 us\"\nsafety = 0.9\nviscous_damping = \"500 1/s\"\n"
         "local_damping = 0.8\ndamping_form = \"combined\"\ngravity = \"0 m/s2\"\n" +
         coupling +
         "[[record]]\nname = \"stress\"\nkind = \"stress\"\nset = \"specimen\"\ndirection = \"x\"\n"
         "[heat]\nfield = \"uniform\"\ninitial = \"" +
         initial + "\"\n[[stages]]\nkind = \"drive\"\nduration = \"0.2 s\"\nunbalanced_ratio = 1e-9\n" + held;
}

std::string coupling(const std::string& stress_free) {
  return "[coupling]\nexchange_increment = \"5 K\"\nunbalanced_ratio = 1e-3\nleast_cycles = 50\n"
         "most_cycles = 5000\nfailure_strain = 0.005\nplaten_difference = \"20 kPa\"\n" +
         (stress_free.empty() ? "" : "stress_free = \"" + stress_free + "\"\n");
}

double stress_of_bar(const std::string& initial, const std::string& stress_free) {
  const Finished run(bar_deck(initial, coupling(stress_free)));
  EXPECT_EQ(run.run.outcome(), Outcome::completed);
  return run.last("stress_MPa");
}

/// Blocks and contacts in series, MPa.
double exact_stress(double rise) {
  const double mortar = (kCells - kStones) * kSize, stone = kStones * kSize;
  const double growth = rise * (kMortarExpansion * mortar + kStoneExpansion * stone);
  const double contacts = (kCells - kStones) * kLayer / kMortar + (kStones - 1) * kLayer / kStone;
  return -1e-6 * growth / (mortar / kMortar + stone / kStone + contacts);
}

// Promise: the thermal strain of every phase counts from the temperature without stress.
TEST(StressFreeVerification, ARestrainedBarWithAnInclusionTakesTheStressOfItsPartsInSeries) {
  const auto expect_stress = [](const char* initial, const char* stress_free, double rise) {
    expect_known({"Stress of a bar of mortar and stone between fixed ends that cooled since it was cast",
                  "blocks and contacts in series", "MPa"},
                 stress_of_bar(initial, stress_free), exact_stress(rise),
                 1e-5 * std::abs(exact_stress(30.0)));
  };
  expect_stress("5 degC", "35 degC", -30.0);
  expect_stress("41 degF", "308.15 K", -30.0);
  expect_stress("-10 degC", "", -30.0);
  expect_stress("35 degC", "5 degC", 30.0);
  expect_stress("35 degC", "35 degC", 0.0);
  expect_stress("20 degC", "35 degC", -15.0);
}

// Promise: a body between platens that is at the temperature without stress is without strain when it
// settles, and heats as one from 20 degC does.
TEST(StressFree, ABodyCastWarmIsAtRestThere) {
  const auto text = [](const std::string& from, const std::string& to) {
    std::string t =
        with(deck("[heat]\nfield = \"uniform\"\ninitial = \"" + from + "\"\n" + kSettle + heat(to, "fixed"),
                  "\"3e-5 1/K\""),
             "failure_strain = 0.005", "failure_strain = 0.005\nstress_free = \"" + from + "\"");
    for (const char* falls :
         {"E = { value = \"29.4 GPa\", times = { table = [[\"20 degC\", 1], [\"820 degC\", 0.2]] } }",
          "E = { value = \"29.4 GPa\", times = { table = [[\"20 degC\", 1], [\"820 degC\", 0.2]] } }"})
      t = with(t, falls, "E = \"29.4 GPa\"");
    return with(t, "temperature_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.1]] }\n", "");
  };
  const Finished warm(text("35 degC", "65 degC")), usual(text("20 degC", "50 degC"));
  for (const Finished* run : {&warm, &usual}) ASSERT_EQ(run->run.outcome(), Outcome::completed);
  EXPECT_LT(warm.end_of(0, "energy_property_change_J"), 1e-12);
  // exchanges come to rest within an unbalanced ratio of 1e-3, and rounding decides on which step
  EXPECT_NEAR(warm.last("stress_MPa"), usual.last("stress_MPa"), 2e-3 * std::abs(usual.last("stress_MPa")));
}

TEST(StressFree, IsNoLessThanTheHottestThatWas) {
  ConcreteMaterials materials;
  materials.block_materials.resize(1);
  BlockMaterial& mortar = materials.block_materials.front();
  mortar.thermal_strain = Curve::table({0.0, 100.0}, {-2e-4, 8e-4}, temperature_axis());
  mortar.contraction = 6e-6;
  set_stress_free(materials, 35.0);
  EXPECT_NEAR(mortar.free_strain(35.0, 35.0), 0.0, 1e-18);
  EXPECT_NEAR(mortar.free_strain(60.0, 60.0), 2.5e-4, 1e-18);
  EXPECT_NEAR(mortar.free_strain(5.0, 35.0), -30.0 * 6e-6, 1e-18);  // back by its own slope
}

TEST(StressFree, ACurveThatDoesNotReachItIsRefused) {
  const std::string text =
      with(bar_deck("25 degC", coupling("60 degC")), "expansion = \"1.2e-05 1/K\"",
           "expansion = { table = [[\"10 degC\", \"1e-5 1/K\"], [\"50 degC\", \"1e-5 1/K\"]] }");
  const std::string told = message([&] { const Trial trial(text); });
  expect_in("materials.mortar.expansion", told);
  expect_in("60", told);
}

}  // namespace
}  // namespace pyroclast::stress_free_test
