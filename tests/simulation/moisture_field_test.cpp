#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/setup/setup.hpp"

/// Water in the pores of bodies of decks.
namespace pyroclast {
namespace {

std::string slab(const std::string& count = "count = 150") {
  return with(shipped_case("kalifa_m100"), "count = 1500", count);
}

std::unique_ptr<Simulation> made(const std::string& text) {
  return make_simulation(read_setup(Deck::parse(text, "deck.toml"), "."));
}

double area_of(const Simulation& simulation) {
  double sum = 0.0;
  for (const double volume : simulation.model().zone_volumes()) sum += volume;
  return sum;
}

/// Heats by so many exchanges of `change` K.
void heat(Simulation& simulation, int exchanges, double change = 10.0) {
  simulation.field().begin_exposure({20.0, 500.0});
  for (int i = 0; i < exchanges; ++i) {
    simulation.field().advance(change, 14400.0);
    simulation.follow_heat();
  }
}

TEST(PoresOfMatrix, HoldWhatStonesDoNot) {
  PoreMaterial concrete;
  concrete.porosity = 0.12;
  concrete.permeability = 1e-19;
  concrete.cement = 400.0;
  const PoreMaterial plane = pores_of_matrix(concrete, 0.4, 2), space = pores_of_matrix(concrete, 0.4, 3);
  EXPECT_DOUBLE_EQ(plane.porosity, 0.2);
  EXPECT_DOUBLE_EQ(plane.cement, 400.0 / 0.6);
  EXPECT_DOUBLE_EQ(plane.permeability, 1e-19 * 1.4 / 0.6);
  EXPECT_DOUBLE_EQ(space.porosity, 0.2);
  EXPECT_DOUBLE_EQ(space.permeability, 1e-19 * 2.4 / 1.2);
  EXPECT_DOUBLE_EQ(pores_of_matrix(concrete, 0.0, 2).permeability, 1e-19);
}

TEST(MoistureField, WaterFollowsHeatAndIsKept) {
  const auto simulation = made(slab());
  const MoistureField& moisture = *simulation->moisture();
  const double first = moisture.water().stored();
  EXPECT_EQ(moisture.largest_pore_pressure(), 0.0);
  heat(*simulation, 20);
  EXPECT_EQ(moisture.water().state().time, simulation->field().time());
  EXPECT_EQ(simulation->heating_time(), simulation->field().time());
  const MoistureLedger& ledger = moisture.water().state().ledger;
  EXPECT_GT(ledger.left, 0.01 * first);
  EXPECT_GT(moisture.largest_pore_pressure(), 2e5);
  EXPECT_LT(std::abs(moisture.water().imbalance()), 1e-14 * first);
  for (int b = 0; b < simulation->model().block_count(); ++b) {
    EXPECT_GE(moisture.saturation(b), 0.0);
    EXPECT_LE(moisture.saturation(b), 1.0);
    EXPECT_GE(moisture.content(b), 0.0);
  }
}

TEST(MoistureField, GoesOnFromItsStateToTheSameBits) {
  const auto one = made(slab()), other = made(slab());
  heat(*one, 5);
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { one->visit_state(visitor); });
  heat(*one, 5);
  copy.put([&](StateVisitor& visitor) { other->visit_state(visitor); });
  heat(*other, 5);
  EXPECT_EQ(one->moisture()->water().state().content, other->moisture()->water().state().content);
  EXPECT_EQ(one->moisture()->water().state().pressure, other->moisture()->water().state().pressure);
  EXPECT_EQ(one->moisture()->saturation(0), other->moisture()->saturation(0));
}

TEST(MoistureField, TheWaterAtTheStartIsThatOfTheDeck) {
  const auto initial = [](const std::string& amount) {
    return made(with(slab(), "saturation = 0.77", amount));
  };
  const auto humid = initial("humidity = 0.6");
  EXPECT_DOUBLE_EQ(humid->moisture()->largest_pressure_ratio(), 0.6);
  const auto stated = initial("content = \"3 %\"");
  const SpecimenNumbers& numbers = stated->numbers();
  const double dry = 2650.0 * numbers.fraction[0] + 2350.0 * numbers.fraction[1];
  EXPECT_NEAR(stated->moisture()->water().stored(), 0.03 * dry * area_of(*stated), 1e-9 * dry);
  try {
    initial("content = 0.3");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("moisture.initial.content: the pores hold"), std::string::npos)
        << error.what();
  }
}

// Promise: the same water, however much of the concrete is stone.
TEST(MoistureField, TheWholeHoldsWhatIsStatedOfTheConcrete) {
  const std::string full = with(slab(), "saturation = 0.77", "saturation = 1");
  const auto simulation =
      made(with(full, "moisture = { class = \"rock\" }", "moisture = { class = \"rock\", porosity = 1e-6 }"));
  const double of_concrete = 0.12 * water::liquid_density(20.0);
  EXPECT_NEAR(simulation->moisture()->water().stored() / area_of(*simulation), of_concrete,
              1e-4 * of_concrete);
}

TEST(MoistureField, TwoConditionsOnOneFaceAreRefusedAtTheirPlace) {
  const std::string box =
      "\n[[moisture.boundaries]]\nfaces = \"box\"\nbox_low = [\"0 mm\", \"0 mm\"]\nbox_high = [\"1 mm\", "
      "\"75 mm\"]\nkind = \"air\"\n";
  try {
    made(slab() + box);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("moisture.boundaries[2]: acts on faces that have"),
              std::string::npos)
        << error.what();
  }
}

TEST(MoistureField, TellsBlocksThatStonesCloseIn) {
  const auto slab_in_air = made(slab("count = 600")),
             sealed = made(with(with(slab("count = 600"), "faces = \"left\"\nkind = \"air\"",
                                     "faces = \"left\"\nkind = \"sealed\""),
                                "faces = \"right\"\nkind = \"air\"", "faces = \"right\"\nkind = \"sealed\""));
  int mortar = 0;
  for (int b = 0; b < sealed->model().block_count(); ++b)
    mortar += sealed->model().block_material[b] == 1 ? 1 : 0;
  EXPECT_EQ(sealed->moisture()->pocket_blocks(), mortar);
  EXPECT_LT(slab_in_air->moisture()->pocket_blocks(), mortar / 10);
}

TEST(MoistureField, SeveralProcessesAreRefused) {
  EXPECT_NO_THROW(require_one_process(1));
  EXPECT_THROW(require_one_process(2), Error);
}

}  // namespace
}  // namespace pyroclast
