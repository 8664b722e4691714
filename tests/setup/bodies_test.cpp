// Promise: bodies of their own and velocities at the start become parts of the model and of its first state,
// and a deck that asks for impossible ones is refused with its place. Pieces that fly too slowly, and those
// that passed through others, are told.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "messages.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/watching/loose_pieces.hpp"

namespace pyroclast {
namespace {

Setup setup_of(const std::string& deck) {
  return read_setup(Deck::parse(deck, "deck.toml"), ".");
}

/// The block that falls, of few blocks.
std::string drop() {
  return with(shipped_case("drop"), "count = 600", "count = 60");
}

TEST(LooseBodies, AreBlocksWithSetsAndAnInterface) {
  const auto simulation = make_simulation(setup_of(drop()));
  const auto& model = static_cast<const ModelOf<2>&>(simulation->model());
  const int plate = model.block_count() - 1;
  EXPECT_TRUE(model.is_of_bearing(plate));
  EXPECT_EQ(model.set("plate").size(),
            static_cast<std::size_t>(model.block_gridpoints[plate + 1] - model.block_gridpoints[plate]));
  EXPECT_EQ(model.set("plate").size(), 31U * 4U);
  EXPECT_EQ(model.set("plate_outline").size(), 66U);  // edges of 10 mm around 300 mm x 30 mm
  EXPECT_EQ(model.interface_names.back(), "plate");
  double area = 0.0;
  const auto volumes = model.zone_volumes();
  for (int z = model.block_zones[plate]; z < model.block_zones[plate + 1]; ++z) area += volumes[z];
  EXPECT_NEAR(area, 0.3 * 0.03, 1e-12);
  EXPECT_EQ(interfaces_of_loose_bodies(model)[plate], std::ssize(model.interface_names) - 1);
  EXPECT_EQ(interfaces_of_loose_bodies(model)[0], -1);
  const auto of_plate = simulation->materials().contacts.back();
  EXPECT_EQ(of_plate["friction"](20.0), 0.3);
}

// Promise: a round body has the area that its diameter says.
TEST(LooseBodies, MayBeRound) {
  const std::string ball = with(drop(),
                                "corners = [[\"-150 mm\", \"-31 mm\"], [\"150 mm\", \"-31 mm\"], "
                                "[\"150 mm\", \"-1 mm\"], [\"-150 mm\", \"-1 mm\"]]",
                                "centre = [\"0 mm\", \"-80 mm\"]\ndiameter = \"120 mm\"");
  const auto simulation = make_simulation(setup_of(ball));
  const auto& model = static_cast<const ModelOf<2>&>(simulation->model());
  const auto volumes = model.zone_volumes();
  double area = 0.0;
  for (int z = model.block_zones[model.block_count() - 1]; z < model.zone_count(); ++z) area += volumes[z];
  EXPECT_NEAR(area, 0.25 * std::numbers::pi * 0.12 * 0.12, 1e-12);
}

// Promise: the ledger counts what a body has at the start, and gravity adds to it.
TEST(StartVelocities, AreThoseOfTheFirstStep) {
  const auto simulation = make_simulation(setup_of(drop()));
  const Motion& motion = simulation->motion();
  const auto& model = simulation->model();
  for (const int g : model.set("specimen")) EXPECT_EQ(motion.read().velocity(g), (Vec<3>{{0.0, -4.0, 0.0}}));
  for (const int g : model.set("plate")) EXPECT_EQ(motion.read().velocity(g), Vec<3>{});
  const EnergyLedger start = motion.totals().energy();
  const double mass = 0.01 * 2200.0;  // some 24 kg, with its aggregate
  EXPECT_GT(start.kinetic, 0.5 * mass * 16.0);
  EXPECT_LT(start.kinetic, 1.2 * 0.5 * mass * 16.0);
  EXPECT_NEAR(start.error(), 0.0, 1e-12 * start.kinetic);
  simulation->motion().advance(100);
  const EnergyLedger later = motion.totals().energy();
  EXPECT_GT(later.kinetic, start.kinetic);
  EXPECT_NEAR(later.kinetic - start.kinetic, later.gravity, 0.01 * later.gravity);  // one step of 100
}

TEST(LooseBodies, WrongOnesAreRefusedWithTheirPlace) {
  const auto refusal = [](const std::string& value, const std::string& other) {
    return pyroclast::message([&] { make_simulation(setup_of(with(drop(), value, other))); });
  };
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string corners =
      "corners = [[\"-150 mm\", \"-31 mm\"], [\"150 mm\", \"-31 mm\"], "
      "[\"150 mm\", \"-1 mm\"], [\"-150 mm\", \"-1 mm\"]]";
  says(refusal("contacts = \"found\"", "contacts = \"first\""), "bodies[0]");
  says(refusal("name = \"plate\"", "name = \"mortar_mortar\""), "bodies[0].name");
  says(refusal("name = \"plate\"", "name = \"outline\""), "there is one already");
  says(refusal("friction = 0.3", "friction = -0.3"), "bodies[0].friction");
  says(refusal("edge = \"10 mm\"", "edge = \"0 mm\""), "bodies[0].edge");
  says(refusal("edge = \"10 mm\"", "material = \"mortar\""), "bodies[0].material");
  says(refusal("edge = \"10 mm\"", "material = \"wood\""), "materials.wood");
  says(refusal("edge = \"10 mm\"", "centre = [\"0 mm\", \"0 mm\"]\ndiameter = \"10 mm\""), "not both");
  says(refusal(corners,
               "corners = [[\"0 mm\", \"-31 mm\"], [\"9 mm\", \"-2 mm\"], [\"0 mm\", \"-20 mm\"], "
               "[\"-9 mm\", \"-2 mm\"]]"),
       "must go round a convex area");
  const std::string inside = refusal("\"-1 mm\"]]", "\"9 mm\"]]");
  says(inside, "lies in another block");
  says(inside, "deck.toml:");
  says(refusal("set = \"specimen\"\nvelocity", "set = \"spec\"\nvelocity"), "there is no set \"spec\"");
  says(refusal("[\"0 m/s\", \"-4 m/s\"]", "[\"-4 m/s\"]"), "velocities[0].velocity");
}

/// The block that falls, without a velocity at the start.
std::string at_rest() {
  return with(drop(), "\"-4 m/s\"", "\"0 m/s\"");
}

bool is_told(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::any_of(warnings, [&](const auto& w) { return w.find(words) != std::string::npos; });
}

// Promise: a piece that flies under local damping or with scaled mass is told with the share of gravity with
// which it falls, and it does fall so.
TEST(LoosePieces, ThatFallTooSlowlyAreTold) {
  const auto simulation = make_simulation(setup_of(at_rest()));
  const auto pieces = falling_pieces(*simulation);
  ASSERT_EQ(pieces.size(), 2U);  // no stage holds the plate yet
  EXPECT_EQ(std::ssize(pieces[0].blocks), simulation->model().block_count() - 1);
  EXPECT_NEAR(pieces[0].share_of_gravity, 1.0, 1e-12);
  EXPECT_EQ(warnings_of_loose_pieces(*simulation), std::vector<std::string>{});

  const std::string damped = with(at_rest(), "local_damping = 0.0", "local_damping = 0.8");
  for (const auto& [deck, cause, tolerance] :
       {std::tuple{with(damped, "\"combined\"", "\"local\""), "because of local damping;", 0.02},
        {damped, "because of local damping;", 0.02},
        {with(damped, "mass = \"real\"", "mass = \"scaled\"\ntime_step = \"2 us\""),
         "because of scaled mass and local damping;", 0.1}}) {
    const auto slow = make_simulation(setup_of(deck));
    const double share = falling_pieces(*slow)[0].share_of_gravity;
    EXPECT_LT(share, 0.61);
    EXPECT_TRUE(is_told(warnings_of_loose_pieces(*slow), "2 pieces are free, and fall too slowly"));
    EXPECT_TRUE(is_told(warnings_of_loose_pieces(*slow), cause));
    slow->motion().advance(400);
    const auto& of_specimen = slow->model().set("specimen");
    double velocity = 0.0;
    for (const int g : of_specimen) velocity -= slow->motion().read().velocity(g)[1];
    velocity /= static_cast<double>(of_specimen.size());
    EXPECT_NEAR(velocity / (9.81 * slow->motion().time()), share, tolerance * share) << deck;
  }
}

// Promise: what lies in blocks that it has no contact with is counted and named with its depth.
TEST(LoosePieces, ThatPassedThroughOthersAreTold) {
  for (const auto& [deck, velocity] :
       {std::pair{drop(), "\"-4 m/s\""}, {shipped_case("drop_3d"), "\"-8 m/s\""}}) {
    const auto simulation = make_simulation(setup_of(deck));
    const int plate = simulation->model().block_count() - 1;
    const auto moved_by = [&](double way) {  // m, in one step; no force acts before
      const double speed = -way / simulation->motion().time_step();
      const auto moved =
          make_simulation(setup_of(with(deck, velocity, "\"" + std::to_string(speed) + " m/s\"")));
      moved->motion().advance(1);
      return passed_through(*moved);
    };
    const PassedThrough none = moved_by(0.9e-3);
    EXPECT_EQ(none.gridpoints, 0);
    EXPECT_EQ(none.block, -1);
    const PassedThrough deep = moved_by(5e-3);
    EXPECT_NEAR(deep.depth, 4e-3, 1e-5);  // the plate lies 1 mm below the lowest corner
    EXPECT_GE(deep.gridpoints, 1);
    EXPECT_GE(deep.blocks, 1);
    EXPECT_LT(deep.blocks, 0.1 * plate);  // those at the lowest corner or edge
    EXPECT_EQ(deep.other, plate);
    EXPECT_LT(deep.block, plate);
  }
}

}  // namespace
}  // namespace pyroclast
