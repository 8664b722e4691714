#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/base/state_copy.hpp"
#include "small_runs.hpp"

/// Pressure of pore water in whole runs: it acts on the body, whose cracks drain it.
namespace pyroclast::pore_pressure_stages_test {
namespace {

/// A prism in a fire on its left, whose pores are full.
std::string wet_deck(const std::string& keys = "") {
  std::string text = hot_deck("");
  text = with(text, "[materials.aggregate]\n", "[materials.aggregate]\nmoisture = { class = \"rock\" }\n");
  text = with(text, "[materials.mortar]\n", "[materials.mortar]\nmoisture = { class = \"high strength\" }\n");
  return text + "[moisture]\ninitial = { saturation = 0.9 }\n" + keys +
         "[[moisture.boundaries]]\nfaces = \"left\"\nkind = \"air\"\n";
}

std::vector<std::optional<double>> cells(const History& history, const std::vector<std::string>& columns) {
  std::vector<std::optional<double>> all;
  for (std::size_t row = 0; row < history.row_count(); ++row)
    for (const auto& name : columns) all.push_back(history.cell(row, name));
  return all;
}

std::vector<std::string> columns_of(const History& history) {
  std::vector<std::string> names;
  for (const Column& column : history.columns()) names.push_back(column.name);
  return names;
}

TEST(PorePressureOfDecks, ActsOnTheBodyWhoseCracksDrainIt) {
  const Finished idle(wet_deck("acts = \"no\"\n")), zones(wet_deck("acts = \"zones\"\n")), all(wet_deck());
  for (const Finished* run : {&idle, &zones, &all}) ASSERT_EQ(run->run.outcome(), Outcome::completed);
  EXPECT_FALSE(idle.run.history().has("energy_pore_pressure_J"));
  EXPECT_FALSE(zones.run.history().has("energy_pore_pressure_J"));
  EXPECT_NE(zones.last("energy_zones_J"), idle.last("energy_zones_J"));
  EXPECT_GT(all.last("energy_pore_pressure_J"), 0.01);
  EXPECT_GT(all.last("dissipated_tension_J"), 1.2 * idle.last("dissipated_tension_J"));
  double turnover = 0.0;
  for (const Column& column : all.run.history().columns())
    if (column.role == ColumnRole::energy_put_in) turnover += std::abs(all.last(column.name.c_str()));
  EXPECT_LT(std::abs(all.last("energy_error_J")), 0.01 * turnover);
  EXPECT_FALSE(all.simulation->moisture()->water().state().cracks.empty());
  EXPECT_LT(std::abs(all.last("water_error_kg")), 1e-14 * all.last("water_kg"));
  // pressure asks for exchanges of its own
  EXPECT_GT(all.run.history().row_count(), idle.run.history().row_count());
}

// Promise: the history tells where pressure comes to the strength of an intact contact, by the share of the
// pressure that the contact bears and the strength that is left at its temperature.
TEST(PorePressureOfDecks, IsToldOverTheStrengthOfIntactContacts) {
  const Finished idle(wet_deck("acts = \"no\"\n"));
  EXPECT_FALSE(idle.run.history().has("pore_pressure_over_strength_max"));
  constexpr double kBiot = 0.3;
  const Finished run(wet_deck("biot = 0.3\n"));
  const Simulation& s = *run.simulation;
  double largest = 0.0;
  for (int c = 0; c < s.model().contact_count(); ++c) {
    const double pressure = s.moisture()->contact_pressure(c);
    if (pressure == 0.0 || s.motion().read().remembered(c, Remembers::tension_damage) > 0.0) continue;
    const ContactMaterial& contact = s.materials().contacts[s.model().joint(c).interface];
    if (contact.law->name == std::string_view("elastic")) continue;  // blocks of stones that touch
    largest = std::max(largest, kBiot * pressure / contact["f_t"](s.field().contacts()[c]));
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_DOUBLE_EQ(run.last("pore_pressure_over_strength_max"), largest);
}

TEST(PorePressureOfDecks, ChangesNoBitOfTheMotionWhereItDoesNotAct) {
  const Finished dry(hot_deck("")), idle(wet_deck("acts = \"no\"\n"));
  const auto columns = columns_of(dry.run.history());
  EXPECT_EQ(cells(idle.run.history(), columns), cells(dry.run.history(), columns));
}

// Promise: where batches end, and where a run is taken up from a copy, changes no bit.
TEST(PorePressureOfDecks, GoesOnToTheSameBits) {
  const Finished whole(wet_deck());
  Trial one(wet_deck());
  cut_batches(one.run, 37);
  const std::size_t half = whole.run.history().row_count() / 2;
  while (one.run.history().row_count() < half) ASSERT_TRUE(one.run.next());
  EXPECT_FALSE(one.simulation->moisture()->water().state().cracks.empty());
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { one.run.visit_state(visitor); });
  Trial other(wet_deck());
  copy.put([&](StateVisitor& visitor) { other.run.visit_state(visitor); });
  for (Trial* trial : {&one, &other}) {
    while (trial->run.next()) continue;
    EXPECT_EQ(cells(trial->run.history(), columns_of(whole.run.history())),
              cells(whole.run.history(), columns_of(whole.run.history())));
  }
}

TEST(PorePressureOfDecks, ActsWithFiniteKinematicsAndFoundContacts) {
  const std::string soon = with(wet_deck(), "duration = \"6 min\"", "duration = \"4.7 min\"");
  const std::string finite = with(soon, "[mechanics]\n", "[mechanics]\nkinematics = \"finite\"\n");
  const Finished first(finite), found(with(finite, "[mechanics]\n", "[mechanics]\ncontacts = \"found\"\n"));
  for (const Finished* run : {&first, &found}) {
    ASSERT_EQ(run->run.outcome(), Outcome::completed);
    EXPECT_GT(run->last("energy_pore_pressure_J"), 0.01);
  }
}

}  // namespace
}  // namespace pyroclast::pore_pressure_stages_test
