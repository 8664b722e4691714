#include <string>

#include <gtest/gtest.h>

#include "stages/small_runs.hpp"

/// Runs of what the constituents of a concrete do on their own.
namespace pyroclast {
namespace {

/// Strength of aggregate, with its loss by temperature (docs/deck.md), and what a test may change.
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

/// A prism whose mortar grows away from its aggregate; only contacts within aggregate can crack.
std::string strong_mortar(const std::string& aggregate_contact) {
  std::string text = deck(kUniform + kSettle + heat("120 degC"), "\"0 1/K\"");
  text = with(with(text, "fraction = 0.1", "fraction = 0.4"), "count = 60", "count = 150");
  text = with(text, "expansion = \"1e-5 1/K\"", "expansion = \"5e-5 1/K\"");
  text = with(text, "temperature_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.1]] }\n" + kMortarBond,
              "law = \"elastic\"\n");
  return text + aggregate_contact;
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

}  // namespace
}  // namespace pyroclast
