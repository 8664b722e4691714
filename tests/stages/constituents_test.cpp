#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "in_plane.hpp"
#include "known.hpp"
#include "phases.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "stages/small_runs.hpp"

/// Runs of what the constituents of a concrete do on their own.
namespace pyroclast {
namespace {

/// Strength of aggregate, with its loss by temperature (docs/understand/deck.md), and what a test may change.
const std::string kStone = R"(law = "cohesive"
temperature_ratio = { table = [["20 degC", 1], ["200 degC", 0.9], ["400 degC", 0.75], ["600 degC", 0.45]] }
f_t = "10 MPa"
G_f1 = "80 N/m"
f_cm = "150 MPa"
beta = 0.05
c_o = "20 MPa"
c_res = "0.2 MPa"
phi = "40 deg"
phi_res = "34 deg"
G_f2 = "400 N/m"
)";

/// The deck whose contacts of mortar never part.
std::string unbreakable(const std::string& text) {
  return with(text, "temperature_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.1]] }\n" + kMortarBond,
              "law = \"elastic\"\n");
}

/// A prism whose mortar grows away from its aggregate; only contacts within aggregate can crack.
std::string strong_mortar(const std::string& aggregate_contact) {
  std::string text = deck(kUniform + kSettle + heat("120 degC"), "\"0 1/K\"");
  text = with(with(text, "fraction = 0.1", "fraction = 0.4"), "count = 60", "count = 150");
  text = with(text, "expansion = \"1e-5 1/K\"", "expansion = \"5e-5 1/K\"");
  return unbreakable(text) + aggregate_contact;
}

// Promise: contacts within aggregate take any law, as other interfaces do. Without one they never part.
TEST(AggregateThatCracks, NeedsADeckAndNoCode) {
  const std::string interface = "[contacts.aggregate_aggregate]\n";
  const Finished whole(strong_mortar(""));
  const Finished cracked(strong_mortar(interface + kStone));
  const Finished stronger(strong_mortar(
      interface + with(with(kStone, "\"10 MPa\"", "\"1000 MPa\""), "\"80 N/m\"", "\"800 kN/m\"")));
  for (const Finished* r : {&whole, &cracked, &stronger}) ASSERT_EQ(r->run.outcome(), Outcome::completed);
  EXPECT_GT(cracked.last("tension_aggregate_aggregate_broken"), 0.0);
  EXPECT_EQ(stronger.last("tension_aggregate_aggregate_damaged"), 0.0);
  EXPECT_FALSE(whole.run.history().has("tension_aggregate_aggregate_broken"));
  EXPECT_LT(cracked.energy_error_over_turnover(), 1e-3);
  const auto& materials = cracked.simulation->materials();
  EXPECT_DOUBLE_EQ(materials.contacts[0]["f_t"](200.0), 9e6);
  EXPECT_DOUBLE_EQ(materials.contacts[0]["K_n"](20.0), 29.4e9 / 1.6e-3);  // of aggregate, Eq. (17)
}

// ---- Quartz

/// Aggregate and mortar alike, with quartz in both or in the aggregate alone.
std::string with_quartz(std::string text, bool in_both) {
  const std::string step = "\nquartz_step = 0.004\nspecific_heat";
  for (const char* phase : {"aggregate", "mortar"}) {
    const auto at = text.find("\nspecific_heat", text.find(std::string("[materials.") + phase));
    if (in_both || phase == std::string("aggregate")) text.replace(at, 14, step);
  }
  return text;
}

// Promise: a free body grows by the step on its way through 573 °C, and shrinks by it on its way back.
TEST(QuartzStepVerification, AFreeBodyGrowsByIt) {
  const std::string text = deck(kUniform + kSettle + heat("540 degC") + heat("610 degC") + heat("540 degC"));
  const Finished r(with_quartz(
      with(unbreakable(text), "exchange_increment = \"5 K\"", "exchange_increment = \"10 K\""), true));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  const auto strain = [&](int stage) { return -r.end_of(stage, "specimen_strain"); };
  const double expected = 70.0 * 1e-5 + 0.004;
  expect_known({"Growth of a free body with quartz, 540 to 610 degC", "alpha dT + step", "1"},
               strain(2) - strain(1), expected, 0.01 * expected);
  EXPECT_NEAR(strain(3), strain(1), 0.01 * expected);
  EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
}

// Promise: quartz in the aggregate alone tears the mortar.
TEST(QuartzStep, OfTheAggregateTearsTheMortar) {
  const std::string text = with(with(deck(kUniform + kSettle + heat("540 degC") + heat("610 degC")),
                                     "fraction = 0.1", "fraction = 0.3"),
                                "exchange_increment = \"5 K\"", "exchange_increment = \"10 K\"");
  const Finished without(text), quartz(with_quartz(text, false));
  for (const char* column : {"tension_mortar_mortar_damaged", "energy_contacts_J"})
    EXPECT_EQ(quartz.end_of(1, column), without.end_of(1, column)) << column;
  EXPECT_GT(quartz.last("tension_mortar_mortar_broken"), without.last("tension_mortar_mortar_damaged"));
}

// Promise: in a computed field each zone has the step by its own temperature.
TEST(QuartzStep, FollowsTheComputedField) {
  std::string text = with(deck(kSettle + kExpose + kHeatedFace), "rate = \"10 K/min\", to = \"70",
                          "rate = \"200 K/min\", to = \"720");
  for (int material = 0; material < 2; ++material)
    text = with(text, "conductivity = \"40 W/(m K)\"", "conductivity = \"4 W/(m K)\"");
  text = with(with(text, "exchange_increment = \"5 K\"", "exchange_increment = \"50 K\""),
              "most_cycles = 5000", "most_cycles = 100");
  const Finished r(with_quartz(text, false));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  const auto& model = r.simulation->model();
  const auto& zones = r.simulation->field().zones();
  const auto blocks = zone_blocks(model);
  std::array<int, 3> below_within_above{};
  for (int z = 0; z < model.zone_count(); ++z) {
    if (model.is_of_bearing(blocks[z])) continue;
    const double T = zones[z], way = std::clamp((T - 550.0) / 50.0, 0.0, 1.0);
    const bool quartz = model.material_names[model.block_material[blocks[z]]] == "aggregate";
    const double step = quartz ? 0.004 * way * way * (3.0 - 2.0 * way) : 0.0;
    EXPECT_NEAR(r.simulation->motion().read().properties_of_zone(z).thermal_strain, 1e-5 * (T - 20.0) + step,
                1e-14);
    if (quartz) ++below_within_above[T < 550.0 ? 0 : T < 600.0 ? 1 : 2];
  }
  for (const int count : below_within_above) EXPECT_GT(count, 0);
}

// Promise: where the strains of phases follow from that of the concrete, no step comes to it, and the place
// of the concrete's is named.
TEST(QuartzStep, IsRefusedBesideTheMixtureRule) {
  const auto error_of = [](const std::string& concrete) -> std::string {
    std::string text = with(deck(kUniform + kSettle + heat("420 degC"), ""), "expansion = \n", "");
    text = with(text, "expansion = \"1e-5 1/K\"\n", "quartz_step = 0.0035\n");
    try {
      pyroclast::read(text + concrete);
      return {};
    } catch (const DeckError& error) {
      return error.what();
    }
  };
  const std::string error = error_of(
      "[concrete]\nthermal_strain = { builtin = \"glasgow_free_thermal_strain\" }\ninclusion_ratio = 1.25\n");
  EXPECT_NE(error.find("materials.mortar.quartz_step"), std::string::npos) << error;
  EXPECT_NE(error.find("which holds the step already (deck.toml:"), std::string::npos) << error;
  EXPECT_NE(error.find("concrete.thermal_strain)"), std::string::npos) << error;
}

// ---- Cooling

/// Aggregate and mortar alike, with further lines for both, in a body that loses what heat takes.
std::string cooled(std::string text, const std::string& lines) {
  text = with(text, "on_cooling = \"reversible\"", "on_cooling = \"irreversible\"");
  for (const char* phase : {"[materials.aggregate]\n", "[materials.mortar]\n"})
    text = with(text, phase, phase + lines);
  return text;
}

// Promise: a free body comes back by its slope, and goes the same way up again to where it was, then on along
// its curve; with small and finite kinematics, with and without predictor.
TEST(CoolingInARunVerification, AFreeBodyShrinksByItsOwnSlope) {
  const std::string text = cooled(unbreakable(deck(kUniform + kSettle + heat("220 degC") + heat("20 degC") +
                                                   heat("120 degC") + heat("270 degC"))),
                                  "contraction = \"6e-6 1/K\"\n");
  const std::string predicted = with(text, "least_cycles = 50", "least_cycles = 50\npredictor = true");
  const std::string finite =
      with(predicted, "mass = \"scaled\"", "mass = \"scaled\"\nkinematics = \"finite\"");
  for (const std::string& way : {text, predicted, finite}) {
    const Finished r(way);
    ASSERT_EQ(r.run.outcome(), Outcome::completed);
    const double expected[] = {0.0, 2e-3, 0.8e-3, 1.4e-3, 2.5e-3};
    for (int stage = 1; stage < 5; ++stage)
      expect_known({"Growth of a free body on the way 20, 220, 20, 120, 270 degC",
                    "strain(T_max) - contraction (T_max - T)", "1"},
                   -r.end_of(stage, "specimen_strain"), expected[stage], 0.01 * 2e-3);
    EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
  }
}

// Promise: the predictor is not held back by the curve that the body does not follow.
TEST(CoolingInARun, IsForetoldByThePredictor) {
  const std::string text =
      cooled(deck(kUniform + kSettle + heat("120 degC") + heat("20 degC")), "contraction = \"4e-5 1/K\"\n");
  const Finished plain(text);
  const Finished predicted(with(text, "least_cycles = 50", "least_cycles = 50\npredictor = true"));
  EXPECT_LT(predicted.result(2, "cycles").value(), 0.7 * plain.result(2, "cycles").value());
}

// Promise: where E of all phases loses half on cooling, a load shortens the body by twice as much.
TEST(CoolingInARunVerification, ResidualEIsTheSlopeOfALoad) {
  const std::string text = unbreakable(
      deck(kUniform + kSettle + heat("220 degC") + heat("20 degC") + load("stress = \"0.5 MPa\"")));
  const std::string half = "residual_ratio = { table = [[\"20 degC\", 1], [\"220 degC\", 0.5]] }\n";
  const auto shortening = [](const Finished& r) {
    EXPECT_EQ(r.run.outcome(), Outcome::completed);
    EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
    return r.last("specimen_strain") - r.end_of(2, "specimen_strain");
  };
  const double kept = shortening(Finished(cooled(text, ""))), lost = shortening(Finished(cooled(text, half)));
  EXPECT_GT(kept, 1e-5);
  expect_known(
      {"Strain of a load after cooling, E of all phases halved, over that of E kept", "1 / phi", "1"},
      lost / kept, 2.0, 0.02);
}

// Promise: strengths that are lost on cooling break what would have held, and nothing is lost on heating.
TEST(CoolingInARun, ResidualStrengthBreaksWhatHeld) {
  const std::string text =
      with(cooled(with(deck(kUniform + kSettle + heat("220 degC") + heat("20 degC")), "fraction = 0.1",
                       "fraction = 0.3"),
                  ""),
           "[materials.mortar]\n", "[materials.mortar]\ncontraction = \"1.06e-5 1/K\"\n");
  const Finished kept(text);
  const Finished lost(with(text, "temperature_ratio = ",
                           "residual_ratio = { table = [[\"20 degC\", 1], [\"220 degC\", 0.2]] }\n"
                           "temperature_ratio = "));
  ASSERT_EQ(lost.run.outcome(), Outcome::completed);
  EXPECT_EQ(lost.end_of(1, "energy_contacts_J"), kept.end_of(1, "energy_contacts_J"));
  EXPECT_GT(lost.last("tension_mortar_mortar_damaged"), kept.last("tension_mortar_mortar_damaged"));
}

// ---- One damage for tension and shear, beside all the rest

/// The shipped hot test with few blocks, its mortar creeping and the strains of its phases those of the
/// concrete.
std::string hot_concrete() {
  std::string text = shipped_case("hot_compression");
  for (const auto& [from, to] : {
           std::pair{"width = \"150 mm\"", "width = \"60 mm\""},
           std::pair{"height = \"300 mm\"", "height = \"120 mm\""},
           std::pair{"d_max = \"32 mm\"", "d_max = \"16 mm\""},
           std::pair{"sieves = [\"8 mm\", \"12.5 mm\", \"16 mm\", \"20 mm\", \"25 mm\"]",
                     "sieves = [\"8 mm\"]"},
           std::pair{"count = 1000", "count = 250"},
           std::pair{"safety = 0.9", "safety = 0.6"},
           std::pair{"to = \"200 degC\"", "to = \"220 degC\""},
           std::pair{"exchange_increment = \"4 K\"", "exchange_increment = \"20 K\""},
           std::pair{"least_cycles = 1000", "least_cycles = 300"},
           std::pair{"velocity = \"0.3 mm/s\"", "velocity = \"2 mm/s\""},
           std::pair{"ramp_time = \"20 ms\"", "ramp_time = \"5 ms\""},
           std::pair{"stop_strain = 0.01", "stop_strain = 0.005"},
           std::pair{"expansion = { builtin = \"paper_aggregate_expansion\" }  # Eq. (18)\n", ""},
           std::pair{"expansion = { builtin = \"paper_mortar_expansion\" }\n", ""},
           std::pair{"G_f1 = \"60 N/m\"",
                     "G_f1 = { value = \"60 N/m\", times = \"glasgow_fracture_energy\" }"},
       })
    text = with(text, from, to);
  return text +
         "[concrete]\nthermal_strain = { builtin = \"glasgow_free_thermal_strain\" }\ninclusion_ratio = "
         "1.25\n"
         "[materials.mortar.creep]\nk2 = 2.35\n";
}

/// The same with the other law, as docs/understand/deck.md says.
std::string with_mixed_mode(std::string text) {
  text = with(text, "[contacts.mortar_mortar]", "[contacts.mortar_mortar]\nlaw = \"mixed_mode\"");
  for (const char* line : {"c_res = \"0.038 MPa\"          # residual cohesion\n",
                           "phi_res = \"34 deg\"           # residual friction angle\n"})
    text = with(text, line, "");
  return with(text, "phi = \"34 deg\"", "psi = \"20 deg\"\nu_r = \"0.1 mm\"\nphi = \"34 deg\"");
}

// Promise: a deck of a concrete comes to it by one word and two numbers, beside creep, curves, the mixture
// rule and the predictor; the ledger closes, and nothing is infinite; a run that goes on from within an
// exchange, with creep under way, ends with the same bits.
TEST(MixedModeInARun, GoesThroughAHotTestOfConcrete) {
  Trial trial(with_mixed_mode(hot_concrete()));
  StateCopy copy;
  cut_batches(trial.run, 70);
  trial.run.stop_when(
      [&] { return trial.run.stage_number() == 1 && trial.simulation->field().mean() > 100.0; });
  while (trial.run.next()) {
  }
  ASSERT_EQ(trial.run.outcome(), Outcome::stopped);
  copy.take([&](StateVisitor& visitor) { trial.run.visit_state(visitor); });
  trial.run.stop_when([] { return false; });
  trial.run.go_on();
  trial.run.run();
  ASSERT_EQ(trial.run.outcome(), Outcome::completed);
  const History& history = trial.run.history();
  const auto last = [&](const char* column) { return history.last(column).value(); };
  const auto& contacts = trial.simulation->materials().contacts;
  EXPECT_STREQ(contacts[aggregate_mortar].law->name, "mixed_mode");
  EXPECT_STREQ(contacts[mortar_mortar].law->name, "mixed_mode");
  EXPECT_GT(last("dissipated_creep_J"), 0.0);
  EXPECT_GT(last("mixed_mortar_mortar_broken"), 0.0);
  double turnover = 0.0;
  for (const char* put_in :
       {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
    turnover += std::abs(last(put_in));
  EXPECT_LT(std::abs(last("energy_error_J")), 1e-3 * turnover);
  double largest = 0.0;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    for (const auto& cell : history.row(row)) EXPECT_TRUE(!cell || std::isfinite(*cell)) << row;
    largest = std::max(largest, history.cell(row, "stress_MPa").value_or(0.0));
  }
  EXPECT_GT(largest, 5.0);
  EXPECT_LT(largest, 60.0);

  Trial resumed(with_mixed_mode(hot_concrete()));
  copy.put([&](StateVisitor& visitor) { resumed.run.visit_state(visitor); });
  resumed.run.go_on();
  resumed.run.run();
  EXPECT_EQ(in_plane::mechanics(resumed.simulation->motion()).read().displacements(),
            in_plane::mechanics(trial.simulation->motion()).read().displacements());
  EXPECT_EQ(resumed.run.history().last("dissipated_creep_J"), history.last("dissipated_creep_J"));
}

}  // namespace
}  // namespace pyroclast
