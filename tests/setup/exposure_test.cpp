#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {
namespace {

// ---- Later exposures -------------------------------------------------------------------------------------

/// A shipped case on a few blocks: three minutes of fire on one face, and what comes after them. A
/// conductivity that rises only beyond the first fire's 502 °C makes the stable step one of the range.
Setup fire_and_then(const std::string& later) {
  std::string deck = with(shipped_case("fire_one_side"), "count = 2000", "count = 200");
  deck = with(deck, "temperature_range = [\"20 degC\", \"800 degC\"]", "");
  deck = with(deck, "duration = \"30 min\"", "duration = \"3 min\"");
  for (int material = 0; material < 2; ++material)
    deck = with(deck, "{ builtin = \"en1992_conductivity_lower\" }",
                "{ table = [[\"20 degC\", \"1.5 W/(m K)\"], [\"505 degC\", \"1.2 W/(m K)\"], "
                "[\"1200 degC\", \"20 W/(m K)\"]] }");
  return read_setup(Deck::parse(with(deck, "[coupling]", later + "[coupling]"), "deck.toml"), ".");
}

void expose(Simulation& simulation, double duration) {
  TemperatureField& field = simulation.field();
  const double end = field.time() + duration;
  field.begin_exposure(temperature_range(simulation.heat(), end));
  while (field.time() < end) field.advance(5.0, end);
}

TEST(TemperatureField, WhatALaterAndHotterExposureBringsChangesNoBitBeforeIt) {
  const auto alone = fire_and_then("");
  const auto followed =
      fire_and_then("[[stages]]\nkind = \"expose\"\nduration = \"10 min\"\nplaten = \"force\"\n");
  ASSERT_GT(followed.temperatures.upper, alone.temperatures.upper + 100.0);
  const auto first = make_simulation(alone), second = make_simulation(followed);
  for (auto* simulation : {first.get(), second.get()}) expose(*simulation, 180.0);
  const TemperatureField &a = first->field(), &b = second->field();
  EXPECT_GT(a.maximum(), 100.0);  // through the peak of the specific heat
  EXPECT_EQ(a.gridpoints(), b.gridpoints());
  EXPECT_EQ(a.mean(), b.mean());
  const HeatSolver &one = *a.conduction(), &other = *b.conduction();
  EXPECT_EQ(one.temperature(), other.temperature());
  EXPECT_EQ(one.rate(), other.rate());
  EXPECT_EQ(one.work().stages, other.work().stages);
  const HeatLedger heat = one.ledger(), same = other.ledger();
  EXPECT_EQ(heat.stored, same.stored);
  EXPECT_EQ(heat.boundary.convection, same.boundary.convection);
  EXPECT_EQ(heat.boundary.radiation, same.boundary.radiation);

  expose(*second, 600.0);
  EXPECT_EQ(b.time(), 780.0);
  EXPECT_GT(b.maximum(), a.maximum() + 100.0);
  const HeatLedger later = other.ledger();
  EXPECT_LT(std::abs(later.error()), 1e-10 * later.stored);
}

}  // namespace
}  // namespace pyroclast
