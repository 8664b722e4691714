#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "stages/small_runs.hpp"

/// Runs of bodies whose contacts remember the load under which they were heated.
namespace pyroclast {
namespace {

constexpr double kCracks = 0.24;  // A at 220 degC

/// A body that neither expands apart nor weighs anything, so that its contacts are pressed by its load alone.
std::string remembering(const std::string& stages, const std::string& law = "remembers") {
  std::string text = with(deck(kUniform + kSettle + stages, "\"0 1/K\""), "expansion = \"1e-5 1/K\"", "");
  if (law == "cohesive") return text;
  return with(
      text, "[contacts.mortar_mortar]\n",
      "[contacts.mortar_mortar]\nlaw = \"" + law +
          "\"\ncracks = { table = [[\"20 degC\", 0], [\"220 degC\", 0.24], [\"820 degC\", 0.24]] }\n");
}

/// Mean share of strength that contacts of concrete have lost whose lines stand up to 30 degrees from the
/// load's direction, or from across it, weighted by their length.
double mean_lost(const Simulation& simulation, bool along) {
  const Model& model = simulation.model();
  double lost = 0.0, length = 0.0;
  for (int c = 0; c < model.contact_count(); ++c) {
    if (model.is_of_bearing(model.joint(c))) continue;
    const double level = std::abs(model.normal(c)[1]);  // 1 where the line lies across the load
    if (along ? level > 0.5 : level < std::sqrt(0.75)) continue;
    lost += simulation.motion().read().contact(c).remembered(Remembers::lost_strength) * model.extent(c);
    length += model.extent(c);
  }
  return lost / length;
}

// Promise: a contact that nothing presses has the strength of the stated curve, from the deck on.
TEST(RemembersInARun, WithoutLoadTheBodyIsThatOfTheCurve) {
  const std::string stages = heat("220 degC") + kFailure;
  const Finished remembers(remembering(stages)), cohesive(remembering(stages, "cohesive"));
  ASSERT_EQ(cohesive.run.outcome(), Outcome::completed);
  const double strength = cohesive.result(2, "f_c_MPa").value();
  EXPECT_NEAR(remembers.result(2, "f_c_MPa").value(), strength, 1e-3 * strength);
  // a body that is at rest but for a thousandth is pressed a little here and there
  EXPECT_NEAR(mean_lost(*remembers.simulation, true), kCracks, 0.05 * kCracks);
  EXPECT_NEAR(mean_lost(*remembers.simulation, false), kCracks, 0.05 * kCracks);
}

// Promise: a load spares the contacts that it presses; those along it lose as without load. What the contacts
// lose at a hand-over is in the ledger, as a change of properties.
TEST(RemembersInARun, ALoadSparesTheContactsAcrossIt) {
  const Finished r(remembering(load("stress = \"1.5 MPa\"") + heat("220 degC")));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(mean_lost(*r.simulation, false), (1.0 - 1.5 / 2.5) * kCracks, 0.1 * kCracks);
  EXPECT_GT(mean_lost(*r.simulation, true), 0.9 * kCracks);
  EXPECT_LT(r.energy_error_over_turnover(), 1e-6);
}

TEST(RemembersInARun, IsStrongerWhereItWasHeatedUnderLoadAndWeakerAfterCooling) {
  const auto strength = [](const std::string& law, const std::string& load_stage, const std::string& cool) {
    const Finished r(remembering(load_stage + heat("220 degC") + cool + kFailure, law));
    EXPECT_LT(r.energy_error_over_turnover(), 1e-3);
    return r.result(static_cast<int>(r.run.stages().size()) - 1, "f_c_MPa").value();
  };
  const std::string pressed = load("stress = \"4 MPa\"");
  const double hot = strength("remembers", "", "");
  EXPECT_GT(strength("remembers", pressed, ""), 1.05 * hot);
  EXPECT_NEAR(strength("cohesive", pressed, ""), strength("cohesive", "", ""), 0.02 * hot);
  const std::string cooled = heat("20 degC");
  EXPECT_LT(strength("remembers", "", cooled), 0.9 * strength("cohesive", "", cooled));
}

// Promise: one damage remembers likewise.
TEST(RemembersInARun, AroundTheLawOfOneDamageToo) {
  std::string text = remembering(load("stress = \"1.5 MPa\"") + heat("220 degC"), "remembers_mixed_mode");
  for (const char* line : {"c_res = \"0.038 MPa\"\n", "phi_res = \"34 deg\"\n"}) text = with(text, line, "");
  const Finished r(with(text, "G_f2 = ", "psi = \"0 deg\"\nu_r = \"1 um\"\nsoftening = \"linear\"\nG_f2 = "));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(mean_lost(*r.simulation, false), (1.0 - 1.5 / 2.5) * kCracks, 0.1 * kCracks);
  EXPECT_GT(mean_lost(*r.simulation, true), 0.9 * kCracks);
  EXPECT_LT(r.energy_error_over_turnover(), 1e-6);
}

// Promise: a solid remembers likewise.
TEST(RemembersInARun, InSpaceToo) {
  const Finished r(with(remembering(load("stress = \"1.5 MPa\"") + heat("220 degC")), "height = \"120 mm\"",
                        "height = \"120 mm\"\ndepth = \"60 mm\""));
  ASSERT_EQ(r.run.outcome(), Outcome::completed);
  EXPECT_NEAR(mean_lost(*r.simulation, false), (1.0 - 1.5 / 2.5) * kCracks, 0.15 * kCracks);
  EXPECT_GT(mean_lost(*r.simulation, true), 0.9 * kCracks);
  EXPECT_LT(r.energy_error_over_turnover(), 1e-6);
}

// Promise: p_close is f_t at 20 °C, of the weaker interface too, unless a deck states another.
TEST(RemembersInADeck, ClosesAtTheTensileStrengthUnlessStated) {
  const auto closing = [](const std::string& text) {
    const Trial trial(text);
    std::vector<double> all;
    for (const ContactMaterial& contact : trial.simulation->materials().contacts)
      if (contact.law == &table_of<CohesiveWithMemory>()) all.push_back(contact["p_close"](220.0));
    return all;
  };
  const std::string text =
      with(remembering(heat("220 degC")), "strength_factor = 1.0", "strength_factor = 0.8");
  EXPECT_EQ(closing(text), (std::vector{2e6, 2.5e6}));
  EXPECT_EQ(closing(with(text, "cracks = ", "p_close = \"5 MPa\"\ncracks = ")), (std::vector{4e6, 5e6}));
  EXPECT_EQ(closing(with(text, "strength_factor = 0.8", "strength_factor = 0.8\nf_t = \"1 MPa\"")),
            (std::vector{1e6, 2.5e6}));
}

TEST(RemembersInADeck, RefusesCracksThatHealOrThatAreThereAtTwentyDegrees) {
  const auto expect_refused = [](const std::string& from, const std::string& to, const std::string& why) {
    const std::string text = with(remembering(heat("520 degC")), from, to);
    const std::string error = message([&] { read(text); });
    expect_in("contacts.mortar_mortar.cracks", error);
    expect_in(why, error);
  };
  expect_refused("[\"820 degC\", 0.24]", "[\"820 degC\", 0.1]", "only grow");
  expect_refused("[\"20 degC\", 0]", "[\"20 degC\", 0.1]", "must be 0 there");
  expect_refused("[\"820 degC\", 0.24]", "[\"820 degC\", 0.9]", "0.5");
}

}  // namespace
}  // namespace pyroclast
