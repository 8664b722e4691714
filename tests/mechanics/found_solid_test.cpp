#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "all_pairs.hpp"
#include "copy_state.hpp"
#include "crushing.hpp"
#include "hertz.hpp"
#include "known.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// Contacts that are found between blocks in space.
namespace pyroclast::solids {
namespace {

using namespace bodies;

constexpr double kEdge = 0.05;  // m, of the cube that moves

std::vector<Vec<3>> velocities(const ModelOf<3>& model, int block, const Vec<3>& velocity) {
  std::vector<Vec<3>> all(model.position.size());
  std::fill(all.begin() + model.block_gridpoints[block], all.begin() + model.block_gridpoints[block + 1],
            velocity);
  return all;
}

/// A cube that falls on a held box.
struct Drop {
  const char* name;
  std::vector<Vec<3>> turns_of_box, turns;
  Vec<3> aside{};  // m
};

const std::vector<Drop> kDrops{
    {"face", {}, {{{0, 0, 0.5}}}, {{0.01, 0.004, 0}}},
    {"edge", {}, {{{std::numbers::pi / 4, 0, 0}}, {{0, 0, 0.3}}}, {{0.006, 0.003, 0}}},
    {"corner", {}, {{{std::numbers::pi / 4, 0, 0}}, {{0, 0.6154797, 0}}}, {{0.006, 0.003, 0}}},
    {"crossed edges",
     {{{std::numbers::pi / 4, 0, 0}}},
     {{{0, std::numbers::pi / 4, 0}}},
     {{0.004, 0.003, 0}}},
    {"skew edges",
     {{{std::numbers::pi / 4, 0, 0}}},
     {{{0, std::numbers::pi / 4, 0}}, {{0, 0, 0.7}}},
     {{0.004, 0.001, 0}}},
    {"parallel edges", {{{std::numbers::pi / 4, 0, 0}}}, {{{std::numbers::pi / 4, 0, 0}}}, {{0.004, 0, 0}}},
    {"aligned", {}, {}, {{0, 0, 0}}},
    {"aligned to 1e-6", {}, {{{0, 0, 1e-6}}}, {{0, 0, 0}}},
    {"aligned to 1e-4", {}, {{{0, 0, 1e-4}}}, {{0, 0, 0}}}};

// Promise: a cube that falls on a face, an edge, a corner or crossed edges gives back the energy that the
// contact takes, also where edges are parallel.
TEST(FoundContactsVerification, CubeInSpaceKeepsItsEnergyOnFacesEdgesAndCorners) {
  for (const Drop& drop : kDrops) {
    ModelOf<3> model = empty_model<3>();
    const bool is_aligned = std::string(drop.name).starts_with("aligned");
    const double size = is_aligned ? kEdge : 0.1;
    const int box = add_box(model, {{size, size, size}}, {}, drop.turns_of_box);
    const int cube = add_box(model, {{kEdge, kEdge, kEdge}}, drop.aside, drop.turns);
    double low = 1.0, high = -1.0;
    for (int g = 0; g < model.gridpoint_count(); ++g)
      (g < model.block_gridpoints[cube] ? high : low) = g < model.block_gridpoints[cube]
                                                            ? std::max(high, model.position[g][2])
                                                            : std::min(low, model.position[g][2]);
    for (int g = model.block_gridpoints[cube]; g < model.gridpoint_count(); ++g)
      model.position[g][2] += high - low + 1e-4;
    auto m = mechanics<3>(model, rubbing(1e9, 0.0), flying<3>(0.0, 0.3), 30e9);
    hold(m, box);
    m.begin_moving(velocities(model, cube, {{0, 0, -0.1}}));
    const double kinetic = m.totals().energy().kinetic;
    double worst = 0.0, stored = 0.0;
    bool has_met = false, has_left = false;
    while (m.time() < 0.03 && !has_left) {
      m.advance(1);
      const EnergyLedger e = m.totals().energy();
      worst = std::max(worst, std::abs(e.error()));
      stored = std::max(stored, e.contacts);
      has_left = has_met && e.contacts == 0.0;
      has_met = e.contacts > 0.0;
    }
    EXPECT_GT(stored, 0.5 * kinetic) << drop.name;
    EXPECT_LT(worst, 1e-5 * kinetic) << drop.name;
    EXPECT_TRUE(has_left) << drop.name;
  }
}

// Promise: a cube slides over four boxes that lie side by side by Coulomb's law, tips over the edge of the
// last ones and falls off. What the corners of overlaps carry over is little beside the friction.
TEST(FoundContactsVerification, CubeInSpaceSlidesByCoulombsLawAndFallsOffTheEdge) {
  constexpr double kFriction = 0.3, kSide = 0.06, kNearEdge = 0.005;
  ModelOf<3> model = empty_model<3>();
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      add_box(model, {{kSide, kSide, kSide}}, {{x * kSide, y * kSide, -0.5 * kSide}}, {});
  const int cube =
      add_box(model, {{kEdge, kEdge, kEdge}}, {{-0.02, -0.008, 0.5 * kEdge + 1e-6}}, {{{0, 0, 0.5}}});
  auto m = mechanics<3>(model, rubbing(1e10, kFriction), flying<3>(kGravity, 0.5), 3e9);
  for (int box = 0; box < cube; ++box) hold(m, box);
  const Vec<3> start{{0.9, 0.15, 0.0}}, way = start * (1.0 / norm(start));
  m.begin_moving(velocities(model, cube, start));
  const auto middle = [&] {
    const int g = model.gridpoint_count() - 1;
    return model.position[g] + m.read().displacement(g);
  };
  while (middle()[0] < kSide - kNearEdge) m.advance(100);
  const Vec<3> v = velocity_of_block(m, cube);
  const double expected = norm(start) - kFriction * kGravity * m.time();
  // The cube bounces a little, and friction takes its share of that momentum too. Sides of boxes that it
  // passes lift it by less than 0.1 % of its weight, without friction.
  expect_known(
      {"A cube that slides over four boxes side by side: velocity near the edge", "Coulomb's law", "m/s"},
      dot(v, way) + kFriction * v[2], expected, 2e-3 * expected);
  while (middle()[2] > 0.0) m.advance(100);
  const EnergyLedger e = m.totals().energy();
  EXPECT_EQ(e.contacts, 0.0);
  EXPECT_LT(std::abs(e.dissipated.of("contact_area")), 2e-4 * e.dissipated.of("friction"));
  EXPECT_LT(std::abs(e.error()), 2e-4 * e.dissipated.of("friction"));
}

// Promise: a cube without friction that tips over the edge of a box keeps its energy, though edges cross ever
// more steeply, and far sides of the box and the cube face each other beside the edge.
TEST(FoundContactsVerification, CubeThatTipsOverAnEdgeKeepsItsEnergy) {
  constexpr double kSide = 0.06;
  struct Tip {
    double turn, most;  ///< rad; error over the largest energy that contacts store
  };
  for (const Tip& tip : {Tip{0.1, 1e-6}, Tip{0.7, 1e-3}}) {
    ModelOf<3> model = empty_model<3>();
    const int box = add_box(model, {{kSide, kSide, kSide}}, {{-0.5 * kSide, 0.0, -0.5 * kSide}}, {});
    const int cube =
        add_box(model, {{kEdge, kEdge, kEdge}}, {{0.003, 0.002, 0.5 * kEdge}}, {{{0, 0, tip.turn}}});
    auto m = mechanics<3>(model, rubbing(1e8, 0.0), flying<3>(kGravity, 0.3), 30e9);
    hold(m, box);
    double worst = 0.0, stored = 0.0, height = 0.0;
    while (height > -kEdge) {
      m.advance(20);
      const EnergyLedger e = m.totals().energy();
      worst = std::max(worst, std::abs(e.error()));
      stored = std::max(stored, e.contacts);
      height = m.read().displacement(model.block_gridpoints[cube])[2];
    }
    EXPECT_GT(stored, 1e-4);
    EXPECT_LT(worst, tip.most * stored);
  }
}

/// Quarter of a ball around its lowest point as one block, its zones finer where it touches a plate below:
/// prisms on rings of triangles, each cut into three tetrahedra.
ModelOf<3> quarter_ball(const Round& round) {
  const std::vector<double> angles = round.angles();
  const int rings = static_cast<int>(angles.size()) - 1, of_layer = (rings + 1) * (rings + 1);
  std::vector<Vec<3>> gridpoints;
  for (int j = 0; j <= round.layers; ++j)
    for (int ring = 0; ring <= rings; ++ring)
      for (int k = 0; k <= 2 * ring; ++k) {
        const double around = ring == 0 ? 0.0 : 0.25 * std::numbers::pi * k / ring;
        const double out = std::sin(angles[ring]);
        gridpoints.push_back(
            Vec<3>{{out * std::cos(around), out * std::sin(around), -std::cos(angles[ring])}} *
            round.at_layer(j));
      }
  std::vector<std::array<int, 4>> zones;
  const auto add = [&](std::array<int, 3> triangle) {
    std::ranges::sort(triangle);  // so that prisms that share a side cut it by the same diagonal
    for (int j = 0; j < round.layers; ++j)
      for (int i = 0; i < 3; ++i) {
        std::array<int, 4> zone{};
        for (int corner = 0; corner < 4; ++corner)
          zone[corner] =
              corner <= i ? triangle[corner] + j * of_layer : triangle[corner - 1] + (j + 1) * of_layer;
        const auto from_first = [&](int corner) { return gridpoints[zone[corner]] - gridpoints[zone[0]]; };
        if (dot(cross(from_first(1), from_first(2)), from_first(3)) < 0.0) std::swap(zone[2], zone[3]);
        zones.push_back(zone);
      }
  };
  for (int ring = 0; ring < rings; ++ring)
    for (const int half : {0, 1}) {  // each ring has one side more in 45 degrees than the one within
      const int inner = ring * ring + half * ring, outer = (ring + 1) * (ring + 1) + half * (ring + 1);
      for (int k = 0; k <= ring; ++k) add({inner + k, outer + k, outer + k + 1});
      for (int k = 0; k < ring; ++k) add({inner + k, inner + k + 1, outer + k + 1});
    }
  ModelOf<3> model = empty_model<3>();
  model.add_block(gridpoints, zones, 0);
  return model;
}

// Promise: a ball of facets presses a plate that was not made with it as Hertz's sphere does.
TEST(FoundContactsVerification, BallOnAPlatePressesAsHertzSays) {
  constexpr double kYoung = 30e9, kPoisson = 0.2;
  const Round round{.radius = 0.05,
                    .depth = 0.012,
                    .facet_angle = 0.25 * std::numbers::pi / 180.0,
                    .fine = 8,
                    .coarse = 7,
                    .layers = 10,
                    .growth = 1.3};
  ModelOf<3> model = quarter_ball(round);
  const double low = std::ranges::min(model.position, {}, [](const Vec<3>& x) { return x[2]; })[2];
  add_box(model, {{0.06, 0.06, 0.01}}, {{0.0007, 0.0002, low - 0.005}}, {});
  const PressedSpot quarter = press(model, round, kYoung, 4.2e-5, 1000, 3000);
  const double force = 4.0 * quarter.force,
               radius = std::cbrt(0.75 * force * round.radius * (1.0 - kPoisson * kPoisson) / kYoung),
               pressure = 1.5 * force / (std::numbers::pi * radius * radius);
  EXPECT_NEAR(radius / round.facet(), 6.5, 0.5);
  const std::string what = "A ball of facets on a plate of its own, 6 of them over the pressed radius: ",
                    hertz = "Hertz (Johnson 1985, 4.2)";
  expect_known({what + "pressed radius", hertz, "m"}, std::sqrt(2.5 * quarter.mean_square), radius,
               0.02 * radius);
  expect_known({what + "largest pressure", hertz, "Pa"}, quarter.largest, pressure, 0.02 * pressure);
}

// Promise: boxes that fall on each other in space, turn, rub and bounce go the same way as with all pairs of
// triangles in each step.
TEST(FoundContactsVerification, ListsAndRowsInSpaceAgreeWithAllPairsInEachStep) {
  constexpr int kHeld = 2;
  ModelOf<3> model = empty_model<3>();
  add_box(model, {{0.2, 0.2, 0.05}}, {{0.01, 0.004, -0.025}}, {});
  add_box(model, {{0.03, 0.2, 0.1}}, {{-0.06, 0.003, 0.05}}, {{{0, 0, 0.1}}});
  for (int i = 0; i < 5; ++i) {
    Vec<3> place{{-0.02 + 0.04 * (i / 2), -0.02 + 0.04 * (i % 2), 0.016 + 0.002 * i}};
    if (i == 4) place = {{0.004, 0.001, 0.05}};  // it falls on the others
    add_box(model, {{0.028, 0.02 + 0.002 * i, 0.02}}, place, {{{0.08 * (i - 1), 0.1 - 0.05 * i, 0.2 * i}}});
  }
  std::vector<Vec<3>> velocities(model.position.size());
  for (int b = kHeld; b < model.block_count(); ++b)
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g)
      velocities[g] = {{0.4 * (b % 3 - 1), 0.3 * (b % 2), -1.0}};
  expect_the_way_of_all_pairs(model, kHeld, velocities, 0.03, 250);
}

/// A cube that hits a box obliquely on its edge, rubs and turns.
Mechanics<3> oblique(const ModelOf<3>& model, const MechanicsParameters& parameters, int threads) {
  auto m = mechanics<3>(model, rubbing(1e9, 0.4), parameters, 3e9, 0.2,
                        std::make_shared<Team>(threads, WhenCrowded::stay));
  hold(m, 0);
  m.begin_moving(velocities(model, 1, {{0.3, 0.1, -0.5}}));
  return m;
}

void expect_equal(const Mechanics<3>& m, const Mechanics<3>& expected, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_TRUE(m.read().displacements() == expected.read().displacements());
  EXPECT_TRUE(m.read().velocities() == expected.read().velocities());
  EXPECT_EQ(m.totals().energy().contacts, expected.totals().energy().contacts);
  EXPECT_EQ(m.totals().energy().dissipated.energies, expected.totals().energy().dissipated.energies);
}

// Promise: in space too bits depend neither on threads and instruction sets, nor on the time and the width of
// a search, and a state that is copied goes on with the same bits.
TEST(FoundContacts, BitsInSpaceDependOnPairsThatPressAlone) {
  constexpr int kSteps = 1500;
  ModelOf<3> model = empty_model<3>();
  add_box(model, {{0.2, 0.1, 0.1}}, {{0, 0, -0.05}}, {});
  add_box(model, {{kEdge, kEdge, kEdge}}, {{-0.02, 0.01, 0.03}}, {{{0.1, 0.05, 0.5}}});
  auto parameters = flying<3>(0.0, 0.5);
  parameters.found.damping = 0.05;
  auto expected = oblique(model, parameters, 1);
  expected.advance(kSteps);
  const EnergyLedger e = expected.totals().energy();
  EXPECT_GT(e.dissipated.of("friction"), 0.02 * e.kinetic);
  for (const InstructionSet set : usable_instruction_sets()) {
    auto other = parameters;
    other.instructions = set;
    auto m = oblique(model, other, 2);
    m.advance(kSteps);
    expect_equal(m, expected, name(set));
  }
  for (const double width : {0.1, 16.0}) {
    auto other = parameters;
    other.found.skin = other.found.reach = width;
    auto m = oblique(model, other, 1);
    for (int i = 0; i < kSteps; i += 50) m.advance(50);
    expect_equal(m, expected, "lists as wide as " + std::to_string(width) + " edges");
  }
  auto m = oblique(model, parameters, 1);
  for (int i = 0; i < kSteps; i += 250) {
    auto other = oblique(model, parameters, 1);
    copy_state(m, other);
    other.advance(kSteps - i);
    expect_equal(other, expected, "copied at step " + std::to_string(i));
    m.advance(250);
  }
}

// Promise: a broken face of a solid that is handed over presses and holds on as it did, and keeps its energy.
TEST(FoundContacts, FaceOfASolidThatIsHandedOverPressesOn) {
  const ModelOf<3> model = cubes(2, 0.01);
  auto bond = mortar_contact();
  bond.residual_cohesion = 0.0;
  auto parameters = flying<3>(0.0, 0.5);
  parameters.damping_form = DampingForm::combined;
  parameters.local_damping = 0.3;
  auto never = parameters;
  never.found.is_on = false;
  for (const int steps_before : {0, 3008}) {
    auto m = mechanics<3>(model, bond, parameters), first = mechanics<3>(model, bond, never);
    for (Mechanics<3>* body : {&m, &first}) {
      hold(*body, 0);
      for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g)
        body->constraints().apply_force(g, {{40.0, 10.0, -300.0}});
      if (steps_before > 0) body->advance(steps_before);
      for (int c = 0; c < model.contact_count(); ++c) EXPECT_TRUE(body->break_contact(c));
    }
    const double before = m.totals().energy().contacts;
    for (Mechanics<3>* body : {&m, &first}) body->advance(1);
    EXPECT_TRUE(m.body().found->is_handed_over[0]);
    EXPECT_NEAR(m.totals().energy().contacts, before, 1e-6 * before);
    EXPECT_LT(std::abs(m.totals().energy().dissipated.of("contact_area")), 1e-5 * before + 1e-12);
    for (Mechanics<3>* body : {&m, &first}) body->advance(4000);
    const EnergyLedger later = m.totals().energy(), expected = first.totals().energy();
    EXPECT_NEAR(later.contacts, expected.contacts, 1e-3 * expected.contacts);
    EXPECT_LT(std::abs(later.error()), 1.1 * std::abs(expected.error()));
    EXPECT_NEAR(velocity_of_block(m, 1)[2], 0.0, 1e-6);
  }
}

/// A cube of blocks that two plates of prescribed gridpoints crush.
Mechanics<3> crushed(const ModelOf<3>& model, const MechanicsParameters& parameters, int steps, int threads) {
  auto m = mechanics<3>(model, brittle(), parameters, 29.4e9, 0.2,
                        std::make_shared<Team>(threads, WhenCrowded::stay));
  crush(m);
  m.advance(steps);
  return m;
}

// Promise: a solid that is crushed while its faces are handed over has the same bits for any number of
// threads and width of lists, and where its state is copied. Its ledger closes, though edges cross steeply
// and overlaps of faces that rest change.
TEST(FoundContacts, CrushedSolidKeepsItsEnergyAndItsBits) {
  constexpr int kSteps = 1000, kCopied = 700;
  const ModelOf<3> model = laguerre_cells(12, kCrushedSize, 3);
  const auto parameters = crushing<3>();
  const auto expected = crushed(model, parameters, kSteps, 1);
  const auto& found = *expected.body().found;
  int pressed = 0;
  for (const auto& pair : found.pairs)
    pressed +=
        pair.slot >= 0 && found.arrays.rows[pair.slot / kLanes].stored.number[pair.slot % kLanes] > 0.0;
  EXPECT_GT(std::ranges::count(found.is_handed_over, true), 10);
  EXPECT_GT(pressed, 50);
  const EnergyLedger e = expected.totals().energy();
  EXPECT_LT(std::abs(e.error()), 1e-4 * turnover(e));
  auto wide = parameters;
  wide.found.skin = wide.found.reach = 0.5;
  expect_equal(crushed(model, wide, kSteps, 2), expected, "2 threads, wide lists");
  auto half = crushed(model, parameters, kCopied, 1), other = crushed(model, parameters, 1, 1);
  copy_state(half, other);
  other.advance(kSteps - kCopied);
  expect_equal(other, expected, "copied");
}

}  // namespace
}  // namespace pyroclast::solids
