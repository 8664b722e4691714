#include "pyroclast/simulation/acting/spalling.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "mechanics/bodies.hpp"
#include "messages.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/watching/gauges.hpp"

/// Pieces that leave a body: which ones do, and what goes with them.
namespace pyroclast::spalling_test {
namespace {

std::string slab() {
  std::string text = with(shipped_case("spalling_slab"), "count = 1500", "count = 150");
  text = with(text, "size = \"2 mm\"", "size = \"8 mm\"");
  return with(text, "[[stages]]                   # the specimen",
              "[[record]]\nname = \"stress\"\nkind = \"stress\"\nset = \"specimen\"\ndirection = \"y\"\n\n"
              "[[record]]\nname = \"heat\"\nkind = \"temperature\"\nset = \"left\"\n\n"
              "[[record]]\nname = \"face\"\nkind = \"displacement\"\nset = \"left\"\ndirection = \"x\"\n\n"
              "[[stages]]                   # the specimen");
}

std::unique_ptr<Simulation> made(const std::string& text) {
  return make_simulation(read_setup(Deck::parse(text, "deck.toml"), "."));
}

/// Block at the left face that slides out most easily: the one whose neighbours lie most to its right.
int block_at_the_face(const Simulation& simulation) {
  const Model& model = simulation.model();
  std::vector<double> least(static_cast<std::size_t>(model.block_count()), -1.0);
  for (const int g : model.set("left")) least[model.block_of(g)] = 1.0;
  for (int c = 0; c < model.contact_count(); ++c) {
    const Joint& joint = model.joint(c);
    const double right = model.normal(c)[0];
    least[model.block_of(joint.a)] = std::min(least[model.block_of(joint.a)], right);
    least[model.block_of(joint.b)] = std::min(least[model.block_of(joint.b)], -right);
  }
  return static_cast<int>(std::ranges::max_element(least) - least.begin());
}

/// Breaks all contacts of a block, and draws it out of the body by half a millimetre.
void draw_out(Simulation& simulation, int block) {
  const Model& model = simulation.model();
  Motion& motion = simulation.motion();
  for (int c = 0; c < model.contact_count(); ++c) {
    const Joint& joint = model.joint(c);
    if (model.block_of(joint.a) != block && model.block_of(joint.b) != block) continue;
    ASSERT_TRUE(motion.break_contact(c));
  }
  constexpr int kSteps = 2000;
  const auto each = [&](auto f) {
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g)
      for (int i = 0; i < 2; ++i) f(g, i);
  };
  const double velocity = -0.5e-3 / (kSteps * motion.time_step());
  each([&](int g, int i) { motion.constraints().prescribe_velocity(g, i, i == 0 ? velocity : 0.0); });
  motion.advance(kSteps);
  EXPECT_FALSE(simulation.pieces_fly());  // what is held stays
  each([&](int g, int i) { motion.constraints().release(g, i); });
}

void heat(Simulation& simulation) {
  simulation.field().begin_exposure({20.0, 1200.0});
  for (int i = 0; i < 6; ++i) {
    simulation.field().advance(20.0, 900.0);
    simulation.follow_heat();
  }
}

TEST(Spalling, APieceThatFliesLeavesMotionHeatAndWater) {
  const auto simulation = made(slab());
  heat(*simulation);
  const int block = block_at_the_face(*simulation);
  simulation->record("face").require_there(*simulation, "until");
  simulation->motion().advance(100);
  EXPECT_FALSE(simulation->pieces_fly());
  draw_out(*simulation, block);
  ASSERT_TRUE(simulation->pieces_fly());
  const MoistureField& water = *simulation->moisture();
  const HeatLedger heat_before = simulation->field().conduction()->ledger();
  const double water_before = water.water().stored();
  simulation->let_pieces_go();
  EXPECT_FALSE(simulation->pieces_fly());
  ASSERT_EQ(simulation->spalling()->spalls().size(), 1U);
  const Spall& spall = simulation->spalling()->spalls().front();
  EXPECT_EQ(spall.blocks, std::vector<int>{block});
  EXPECT_EQ(spall.heating_time, simulation->heating_time());
  EXPECT_GT(spall.area, 0.0);
  EXPECT_GT(spall.temperature, 20.0);
  EXPECT_LE(spall.mean_depth, spall.largest_depth);
  EXPECT_NEAR(spall.mass, spall.volume * (spall.mass / spall.volume > 2400.0 ? 2650.0 : 2200.0),
              1e-9 * spall.mass);

  EXPECT_TRUE(simulation->motion().is_gone(block));
  const HeatLedger heat_after = simulation->field().conduction()->ledger();
  EXPECT_GT(heat_after.removed, 0.0);
  EXPECT_NEAR(heat_after.stored + heat_after.removed, heat_before.stored, 1e-11 * heat_before.stored);
  const double removed = water.water().state().ledger.removed;
  EXPECT_GT(removed, 0.0);
  EXPECT_NEAR(water.water().stored() + removed, water_before, 1e-13 * water_before);
  const int gridpoint = simulation->model().block_gridpoints[block];
  EXPECT_TRUE(std::isnan(simulation->field().gridpoints()[gridpoint]));
  EXPECT_TRUE(std::isnan(simulation->record("face").read(*simulation)));
  expect_in("until: blocks of the record \"face\" have left the body",
            message([&] { simulation->record("face").require_there(*simulation, "until"); }));
  EXPECT_TRUE(std::isfinite(simulation->field().mean()));
  for (const char* name : {"stress", "heat"}) {
    simulation->record(name).require_there(*simulation, "until");
    EXPECT_TRUE(std::isfinite(simulation->record(name).read(*simulation))) << name;
  }

  // what is left goes on, and so does the heat of the whole
  const double block_before = simulation->unspalled_field().gridpoints()[gridpoint];
  heat(*simulation);
  EXPECT_GT(simulation->unspalled_field().gridpoints()[gridpoint], block_before + 1.0);
  EXPECT_EQ(simulation->unspalled_field().time(), simulation->field().time());
  for (std::size_t bar = 0; bar < 2; ++bar)
    EXPECT_GT(simulation->spalling()->temperature_at(bar, simulation->field()),
              simulation->spalling()->temperature_at(bar, simulation->unspalled_field()));
  simulation->hand_over();
  simulation->motion().advance(500);
  EXPECT_TRUE(std::isfinite(simulation->motion().totals().energy().error()));
  expect_in("the set \"left\" has left the body",
            message([&] { simulation->hold("left", 0, {}, "deck.toml:9: stages[3]"); }));
  expect_in("deck.toml:9: stages[3]: block " + std::to_string(block),
            message([&] { simulation->hold("left", 0, {}, "deck.toml:9: stages[3]"); }));
}

TEST(Spalling, GoesOnFromItsStateToTheSameBits) {
  const auto simulation = made(slab());
  heat(*simulation);
  draw_out(*simulation, block_at_the_face(*simulation));
  simulation->let_pieces_go();
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { simulation->visit_state(visitor); });
  const auto resumed = made(slab());
  copy.put([&](StateVisitor& visitor) { resumed->visit_state(visitor); });
  EXPECT_EQ(resumed->spalling()->spalls().size(), 1U);
  for (Simulation* one : {simulation.get(), resumed.get()}) {
    heat(*one);
    one->show_cracks();
    one->hand_over();
    one->motion().advance(300);
  }
  EXPECT_EQ(resumed->moisture()->water().state().content, simulation->moisture()->water().state().content);
  EXPECT_EQ(resumed->field().zones(), simulation->field().zones());
  EXPECT_EQ(resumed->motion().totals().energy().error(), simulation->motion().totals().energy().error());
  EXPECT_EQ(resumed->motion().totals().energy().removed, simulation->motion().totals().energy().removed);
}

TEST(Spalling, ALoadOnAPieceThatLeavesIsAnErrorThatNamesTheBlock) {
  const auto simulation = made(slab());
  const int block = block_at_the_face(*simulation);
  SetLoad load;
  load.force = {{-1.0, 0.0, 0.0}};
  simulation->loads().set({{"left", load}});
  draw_out(*simulation, block);
  ASSERT_TRUE(simulation->pieces_fly());
  const std::string text = message([&] { simulation->let_pieces_go(); });
  expect_in("block " + std::to_string(block) + " leaves the body", text);
  expect_in("the load on the set \"left\"", text);
}

// Promise: a plane of symmetry holds no piece: what leaves there leaves together with its image.
TEST(Spalling, APieceLeavesAPlaneOfSymmetry) {
  ModelOf<2> model = bodies::column(2, 0.01);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (model.position[g][0] == 0.0) model.sets["left"].push_back(g);
  PlaneOfSymmetry plane;
  plane.side = "left";
  add_symmetry(model, {plane});
  auto contact = mortar_contact();
  contact.tensile_strength = 2.5e6;
  auto parameters = bodies::settling<2>(40);
  parameters.loses_blocks = true;
  BodyProperties p = by_interface(
      model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(29.4e9, 0.2)), {contact});
  p.pore_pressure.assign(model.contacts.size(), 3e6);
  const auto motion = make_motion(model, {2400.0}, p, parameters, nullptr);
  for (int g = 0; g < model.block_gridpoints[1]; ++g)
    for (int i = 0; i < 2; ++i) motion->constraints().prescribe_velocity(g, i, 0.0);
  for (const int g : model.set("left_symmetry")) motion->constraints().prescribe_velocity(g, 0, 0.0);
  BlockMaterial mortar;
  mortar.name = "mortar";
  mortar.density = Curve::constant(2400.0);
  const Spalling spalling(model, {mortar}, {}, {});
  motion->advance(20000);
  const auto spalls = spalling.find(*motion, TemperatureField(model, 20.0), nullptr);
  ASSERT_EQ(spalls.size(), 1U);
  EXPECT_EQ(spalls.front().blocks, std::vector<int>{1});
  motion->remove(spalls.front().blocks);
  motion->advance(100);
  EXPECT_TRUE(std::isfinite(motion->totals().energy().error()));
}

// Promise: depths count from the fire, whatever the other side has.
TEST(Spalling, DepthsCountFromTheFaceInTheFireAlone) {
  const auto simulation = made(slab());
  const Spalling& spalling = *simulation->spalling();
  EXPECT_NEAR(spalling.depth({{0.03, 0.1, 0.0}}), 0.03, 1e-9);
  EXPECT_NEAR(spalling.depth({{0.08, 0.1, 0.0}}), 0.08, 1e-9);
}

TEST(Spalling, ABarWhereNoBlockLiesIsRefusedAtItsPlace) {
  const std::string text = message([] { made(with(slab(), "\"35 mm\"]", "\"35 cm\"]")); });
  expect_in("spalling.bars: no block lies 350 mm below the faces that fire acts on", text);
  expect_in("deck.toml:", text);
}

// Promise: a block that a stated pressure pushes off a held one leaves in the increment in which its share
// comes to the tensile strength.
TEST(SpallingVerification, ABlockIsPushedOffWithinOneIncrementOfThePressure) {
  const ModelOf<2> model = bodies::column(2, 0.01);
  auto contact = mortar_contact();
  contact.tensile_strength = 2.5e6;
  for (const double biot : {1.0, 0.5}) {
    auto parameters = bodies::settling<2>(40);
    parameters.loses_blocks = true;
    const auto under = [&](double pressure) {
      BodyProperties p = by_interface(
          model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(29.4e9, 0.2)), {contact});
      p.pore_pressure.assign(model.contacts.size(), biot * pressure);
      return p;
    };
    const auto motion = make_motion(model, {2400.0}, under(0.0), parameters, nullptr);
    for (int g = 0; g < model.block_gridpoints[1]; ++g)
      for (int i = 0; i < 2; ++i) motion->constraints().prescribe_velocity(g, i, 0.0);
    BlockMaterial mortar;
    mortar.name = "mortar";
    mortar.density = Curve::constant(2400.0);
    const TemperatureField field(model, 20.0);
    const Spalling spalling(model, {mortar}, {}, {});
    constexpr double kIncrement = 0.05e6;
    double left_at = 0.0;
    for (double pressure = kIncrement; left_at == 0.0 && pressure < 6e6; pressure += kIncrement) {
      motion->set_properties(under(pressure));
      motion->advance(1000);
      const auto spalls = spalling.find(*motion, field, nullptr);
      if (spalls.empty()) continue;
      left_at = pressure;
      EXPECT_EQ(spalls.front().blocks, std::vector<int>{1});
    }
    EXPECT_NEAR(left_at, 2.5e6 / biot, 1.001 * kIncrement);
  }
}

}  // namespace
}  // namespace pyroclast::spalling_test
