#include "pyroclast/mechanics/found/found.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "crushing.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "small_chunks.hpp"

namespace pyroclast {
namespace {

using namespace bodies;

struct Fall {
  double restitution = 0.0, fastest = 0.0;  ///< velocity after over velocity before, and that before, m/s
  double error = 0.0, damped = 0.0;  ///< largest error of the ledger, and what damping took, over E_kin
};

/// A block that falls by 2 mm on a held one, with a contact that is softer than the block.
Fall fall(double damping) {
  ModelOf<2> model = empty_model();
  add_block(model, rectangle(-0.5, -0.1, 1.0, 0.1));
  const int falling = add_block(model, rectangle(-0.025, 0.002, 0.05, 0.05));
  auto parameters = flying(kGravity, 0.2);
  parameters.found.damping = damping;
  auto m = mechanics<2>(model, rubbing(1e10, 0.0), parameters, 30e9);
  hold(m, 0);
  double fastest_down = 0.0, fastest_up = 0.0, worst = 0.0, kinetic = 0.0, damped = 0.0;
  while (m.time() < 0.04) {
    m.advance(1);
    const double v = velocity_of_block(m, falling)[1];
    fastest_down = std::min(fastest_down, v);
    fastest_up = std::max(fastest_up, v);
    const EnergyLedger e = m.totals().energy();
    kinetic = std::max(kinetic, e.kinetic);
    worst = std::max(worst, std::abs(e.error()));
    damped = e.dissipated.of("contact_damping");
  }
  return {-fastest_up / fastest_down, -fastest_down, worst / kinetic, damped / kinetic};
}

// Promise: a block that falls on another one comes back as fast as it fell, and the ledger closes.
TEST(FoundContactsVerification, BlockThatFallsComesBack) {
  const Fall free = fall(0.0);
  EXPECT_NEAR(free.fastest, std::sqrt(2 * kGravity * 0.002), 1e-4);
  EXPECT_NEAR(free.restitution, 1.0, 1e-4);
  // the step in which edges meet puts in up to K (v dt)^2 A / 4: 3e-5 of the kinetic energy
  EXPECT_LT(free.error, 4e-5);
  EXPECT_EQ(free.damped, 0.0);
}

// Promise: damping is a share of critical that never pulls: the contact ends where its force does (Schwager
// and Pöschel, Granular Matter 9, 2007).
TEST(FoundContactsVerification, DampingTakesItsShareOfABounce) {
  for (const double share : {0.05, 0.2}) {
    const Fall damped = fall(share);
    const double root = std::sqrt(1.0 - share * share);
    const double closed =
        std::exp(-share / root * (std::numbers::pi - std::atan2(2 * share * root, 1 - 2 * share * share)));
    EXPECT_NEAR(damped.restitution, closed, 2e-3);
    EXPECT_NEAR(damped.damped, 1.0 - damped.restitution * damped.restitution,
                3e-3);  // the block rings a little
    EXPECT_LT(damped.error, 4e-5);
  }
}

// Promise: a brick slides down over the joints of an incline of several blocks as down one plane.
TEST(FoundContactsVerification, BrickSlidesDownAnInclineOfSeveralBlocks) {
  constexpr double kAngle = 30.0 * std::numbers::pi / 180.0, kFriction = 0.3;
  ModelOf<2> model = empty_model();
  for (int i = 0; i < 5; ++i) add_block(model, rectangle(i * 0.05, -0.05, 0.05, 0.05, -kAngle));
  const int brick = add_block(model, rectangle(0.02, 0.0, 0.04, 0.04, -kAngle));
  auto m = mechanics<2>(model, rubbing(1e11, kFriction), flying(kGravity, 0.3), 30e9);
  for (int b = 0; b < brick; ++b) hold(m, b);
  const double acceleration = kGravity * (std::sin(kAngle) - kFriction * std::cos(kAngle));
  const Vec<2> down{{std::cos(kAngle), -std::sin(kAngle)}};
  while (m.time() < 0.11) m.advance(500);  // before it leaves the first block, where it chatters
  // the brick bounces a little on its contact, and friction takes its share of that momentum too
  const Vec<2> v = velocity_of_block(m, brick), up{{-down[1], down[0]}};
  EXPECT_NEAR((dot(v, down) + kFriction * dot(v, up)) / (acceleration * m.time()), 1.0, 2e-4);
  const EnergyLedger e = m.totals().energy();
  EXPECT_LT(std::abs(e.error()), 2e-5 * e.kinetic);
  EXPECT_GT(e.dissipated.of("friction"), 0.1 * e.gravity);
}

// Promise: a bearing, whose law never breaks, is handed over once its sides have slid by 10 % of the face.
// Before that, the facets of a platen are free for other blocks alone. The block slides on over the platen's
// facets.
TEST(FoundContactsVerification, BrickSlidesAlongABearingOfSeveralFacets) {
  constexpr double kSize = 0.05, kSpeed = 2.0, kFriction = 0.3;
  ModelOf<2> model = empty_model();
  std::vector<Vec<2>> corners{{{0.0, -kSize}}, {{5.0 * kSize, -kSize}}};
  for (int i = 5; i >= 0; --i) corners.push_back({{i * kSize, 0.0}});
  add_block(model, corners);
  const int brick = add_block(model, rectangle(0.0, 0.0, kSize, kSize)),
            first = model.block_gridpoints[brick];
  model.join_faces({6, 7}, {first + 1, first}, 0);
  auto m = mechanics<2>(model, rubbing(1e10, kFriction), flying(kGravity, 0.3), 30e9);
  hold(m, 0);
  std::vector<Vec<2>> velocity(model.position.size());
  std::fill(velocity.begin() + first, velocity.end(), Vec<2>{{kSpeed, 0.0}});
  m.begin_moving(velocity);
  const auto& found = *m.body().found;
  const auto is_free = [&](int block) {
    return std::ranges::all_of(found.facets, [&](const BlockFacet<2>& facet) {
      return facet.block != block || facet.face < 0 || facet.is_free;
    });
  };
  EXPECT_TRUE(is_free(0) && !found.is_handed_over[0]);
  m.advance(64);
  EXPECT_EQ(found.is_handed_over[0], kSpeed * m.time() > 0.1 * kSize);
  const double pressed = 2400.0 * kGravity * kSize / 1e10;  // m, at rest
  double highest = -1.0, deepest = 1.0;
  while (m.time() < 0.08) {
    m.advance(500);
    highest = std::max(highest, lowest(m, brick));
    deepest = std::min(deepest, lowest(m, brick));
  }
  EXPECT_TRUE(found.is_handed_over[0] && is_free(brick));
  const Vec<2> v = velocity_of_block(m, brick);
  EXPECT_NEAR((kSpeed - v[0] + kFriction * v[1]) / (kFriction * kGravity * m.time()), 1.0, 1e-3);
  EXPECT_LT(highest, 0.0);
  EXPECT_GT(deepest, -5.0 * pressed);
  const EnergyLedger e = m.totals().energy();
  EXPECT_LT(std::abs(e.error()), 1e-5 * e.kinetic);
}

// Promise: a broken face that is handed over presses on as it did: neither energy nor forces change.
TEST(FoundContacts, FaceThatIsHandedOverPressesOn) {
  const ModelOf<2> model = two_rows(3, 0.01);
  auto bond = mortar_contact();
  bond.residual_cohesion = 0.0;
  auto parameters = flying(0.0, 0.5);
  parameters.damping_form = DampingForm::combined;
  parameters.local_damping = 0.3;
  auto m = mechanics<2>(model, bond, parameters);
  auto never = parameters;
  never.found.is_on = false;
  auto first = mechanics<2>(model, bond, never);
  for (Mechanics<2>* body : {&m, &first}) {
    for (int c = 0; c < model.contact_count(); ++c)
      if (std::abs(model.contacts[c].normal[1]) > 0.5) {
        EXPECT_TRUE(body->break_contact(c));
      }
    for (int b = 0; b < 3; ++b) hold(*body, b);
    for (int b = 3; b < 6; ++b)
      for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g)
        body->constraints().apply_force(g, {{20.0, -3000.0}});
  }
  m.advance(1);  // handed over before the first step
  EXPECT_TRUE(m.body().found->is_handed_over[1] || m.body().found->is_handed_over[2]);
  first.advance(1);
  m.advance(3000);
  first.advance(3000);
  const EnergyLedger a = m.totals().energy(), b = first.totals().energy();
  EXPECT_NEAR(a.contacts, b.contacts, 1e-2 * b.contacts);
  EXPECT_LT(std::abs(a.error()), 1e-6 * turnover(a));
}

// Promise: a broken face that opens rests, in no row, until it closes; then it presses as the first contact
// does that was never handed over.
TEST(FoundContacts, FaceThatOpensRestsUntilItCloses) {
  const ModelOf<2> model = two_rows(1, 0.01);
  auto parameters = flying(0.0, 0.5);
  parameters.found.steps = 10.0;  // lists that end soon
  auto never = parameters;
  never.found.is_on = false;
  auto m = mechanics<2>(model, mortar_contact(), parameters);
  auto first = mechanics<2>(model, mortar_contact(), never);
  for (Mechanics<2>* body : {&m, &first}) {
    for (int c = 0; c < model.contact_count(); ++c) {
      EXPECT_TRUE(body->break_contact(c));
    }
    hold(*body, 0);
  }
  const auto move = [&](double way, int steps) {  // of a step, m
    for (Mechanics<2>* body : {&m, &first}) {
      for (int g = model.block_gridpoints[1]; g < model.block_gridpoints[2]; ++g) {
        body->constraints().prescribe_velocity(g, 0, 0.0);
        body->constraints().prescribe_velocity(g, 1, way / body->time_step());
      }
      body->advance(steps);
    }
  };
  const auto sleeps = [&] {
    const auto& found = *m.body().found;
    const auto pair = std::ranges::find_if(found.pairs, [](const auto& p) { return p.is_handed_over; });
    if (pair == found.pairs.end()) return false;
    return pair->slot < 0 || found.arrays.rows[pair->slot / kLanes].wakes >= 1.0;
  };
  move(-1e-7, 40);  // crushes the contact, which keeps a closure
  EXPECT_FALSE(sleeps());
  move(1e-6, 1000);
  EXPECT_TRUE(sleeps());
  EXPECT_EQ(m.totals().energy().contacts, 0.0);
  move(-1e-6, 1000);
  EXPECT_FALSE(sleeps());
  const EnergyLedger a = m.totals().energy(), b = first.totals().energy();
  EXPECT_GT(b.contacts, 0.0);
  EXPECT_NEAR(a.contacts, b.contacts, 1e-6 * b.contacts);
  EXPECT_GT(b.dissipated.of("compression"), 0.0);
  EXPECT_NEAR(a.dissipated.of("compression"), b.dissipated.of("compression"),
              1e-6 * b.dissipated.of("compression"));
}

TEST(FoundContacts, HandOverKeepsEnergyAndForces) {
  const ModelOf<2> model = two_rows(3, 0.01);
  auto bond = mortar_contact();
  bond.residual_cohesion = 0.0;
  auto parameters = flying(0.0, 0.5);
  parameters.local_damping = 0.3;
  auto m = mechanics<2>(model, bond, parameters);
  for (int b = 0; b < 3; ++b) hold(m, b);
  for (int b = 3; b < 6; ++b)
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g)
      m.constraints().apply_force(g, {{200.0, -3000.0}});
  m.advance(64 * 40 - 1);
  for (int c = 0; c < model.contact_count(); ++c)
    if (std::abs(model.contacts[c].normal[1]) > 0.5) {
      EXPECT_TRUE(m.break_contact(c));
    }
  m.advance(1);  // the last step without found pairs
  const EnergyLedger before = m.totals().energy();
  EXPECT_TRUE(m.body().found->pairs.empty() || !m.body().found->pairs.front().is_handed_over);
  m.advance(1);
  const EnergyLedger after = m.totals().energy();
  int handed_over = 0;
  for (const auto& pair : m.body().found->pairs) handed_over += pair.is_handed_over ? 1 : 0;
  EXPECT_EQ(handed_over, 3);
  EXPECT_NEAR(after.error(), before.error(), 1e-9);
  EXPECT_GE(after.dissipated.total(), before.dissipated.total());
  EXPECT_GT(after.contacts, 1e-4);
}

/// A specimen that is crushed between its held lower and its driven upper side, until pieces part.
Mechanics<2> crushed(const ModelOf<2>& model, MechanicsParameters parameters, int threads, int batch,
                     int steps) {
  auto m = mechanics<2>(model, brittle(), parameters, 29.4e9, 0.2,
                        std::make_shared<Team>(threads, WhenCrowded::stay));
  crush(m);
  for (int left = steps; left > 0; left -= batch) m.advance(std::min(batch, left));
  return m;
}

void expect_equal(const Mechanics<2>& m, const Mechanics<2>& expected, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_TRUE(m.read().displacements() == expected.read().displacements());
  EXPECT_TRUE(m.read().velocities() == expected.read().velocities());
  EXPECT_TRUE(m.read().forces() == expected.read().forces());
  const EnergyLedger a = m.totals().energy(), b = expected.totals().energy();
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.dissipated.energies, b.dissipated.energies);
  EXPECT_EQ(m.totals().unbalanced_ratio(), expected.totals().unbalanced_ratio());
}

/// Tells whether each free facet stands in a row with each of every other block.
bool has_all_pairs_in_rows(const FoundData<2>& found) {
  std::size_t all = 0;
  for (const BlockFacet<2>& a : found.facets)
    for (const BlockFacet<2>& b : found.facets) all += a.is_free && b.is_free && a.block < b.block ? 1 : 0;
  const auto in_rows = std::ranges::count_if(found.pairs, [](const FoundPair<2>& p) { return p.slot >= 0; });
  return static_cast<std::size_t>(in_rows) == all;
}

constexpr int kCrushingSteps = 1200;

// Promise: bits depend neither on threads and instruction sets, nor on batches, nor on the time and the
// width of a search.
TEST(FoundContacts, BitsDependOnPairsThatPressAlone) {
  const ModelOf<2> model = tessellated(40, 0.1, 0.1, 3);
  const auto expected = crushed(model, crushing<2>(), 1, kCrushingSteps, kCrushingSteps);
  int handed_over = 0, pressed = 0;
  for (const bool face : expected.body().found->is_handed_over) handed_over += face ? 1 : 0;
  for (const auto& pair : expected.body().found->pairs)
    pressed += pair.slot >= 0 &&
               expected.body().found->arrays.rows[pair.slot / kLanes].stored.number[pair.slot % kLanes] > 0.0;
  EXPECT_GT(handed_over, 5);
  EXPECT_GT(pressed, 3);
  auto never = crushing<2>();
  never.found.is_on = false;
  const EnergyLedger e = expected.totals().energy();
  const EnergyLedger first = crushed(model, never, 1, kCrushingSteps, kCrushingSteps).totals().energy();
  EXPECT_LT(std::abs(e.error()), 1.1 * std::abs(first.error()));
  EXPECT_GT(e.dissipated.of("contact_area"), 0.0);
  for (const int threads : {2, 3})
    expect_equal(crushed(model, crushing<2>(), threads, kCrushingSteps, kCrushingSteps), expected,
                 std::to_string(threads) + " threads");
  for (const int batch : {1, 50})
    expect_equal(crushed(model, crushing<2>(), 1, batch, kCrushingSteps), expected,
                 "batches of " + std::to_string(batch));
  for (const InstructionSet set : usable_instruction_sets()) {
    auto parameters = crushing<2>();
    parameters.instructions = set;
    expect_equal(crushed(model, parameters, 2, 100, kCrushingSteps), expected, name(set));
  }
  for (const double steps : {20.0, 2000.0}) {
    auto parameters = crushing<2>();
    parameters.found.steps = steps;
    const auto m = crushed(model, parameters, 1, 100, kCrushingSteps);
    EXPECT_EQ(m.body().found->searches > expected.body().found->searches, steps < 250.0);
    expect_equal(m, expected, std::to_string(steps) + " steps to the next search");
  }
  for (const double width : {0.1, 0.5, 16.0}) {
    auto parameters = crushing<2>();
    parameters.found.skin = parameters.found.reach = width;
    const auto m = crushed(model, parameters, 1, 100, kCrushingSteps);
    expect_equal(m, expected, "lists as wide as " + std::to_string(width) + " edges");
    EXPECT_EQ(has_all_pairs_in_rows(*m.body().found), width > 10.0);  // the body is 10 edges wide
  }
  {
    const SmallChunks few(7);
    const ModelOf<2> cut = tessellated(40, 0.1, 0.1, 3);
    ASSERT_GT(cut.chunks().count(), 1);
    const auto m = crushed(cut, crushing<2>(), 2, 100, kCrushingSteps);  // its sums have other last digits
    EXPECT_TRUE(m.read().displacements() == expected.read().displacements());
    EXPECT_TRUE(m.read().forces() == expected.read().forces());
  }
  auto parameters = crushing<2>();
  parameters.layout.fewest_blocks = 2;
  const auto m = crushed(model, parameters, 1, 100, kCrushingSteps);  // its sums have other last digits
  EXPECT_TRUE(m.read().displacements() == expected.read().displacements());
  EXPECT_TRUE(m.read().forces() == expected.read().forces());
}

// Promise: a state that is copied at any step goes on with the same bits.
TEST(FoundContacts, CopiedStatesGoOnWithTheSameBits) {
  const ModelOf<2> model = tessellated(40, 0.1, 0.1, 3);
  const auto expected = crushed(model, crushing<2>(), 1, kCrushingSteps, kCrushingSteps);
  for (const int step : {63, 64, 65, 700, 1023, 1024, 1025}) {
    auto half = crushed(model, crushing<2>(), 1, step, step);
    auto other = crushed(model, crushing<2>(), 1, 1, 1);
    copy_state(half, other);
    EXPECT_EQ(other.totals().energy().contacts, half.totals().energy().contacts);
    other.advance(kCrushingSteps - step);
    expect_equal(other, expected, "copied at step " + std::to_string(step));
  }
}

// Promise: found contacts follow new properties as first ones do: the ledger closes, nothing that was lost
// comes back, and a copied state goes on with the same bits.
TEST(FoundContacts, FollowAChangeOfProperties) {
  const ModelOf<2> model = tessellated(40, 0.1, 0.1, 3);
  const auto heat = [&](Mechanics<2>& m) {
    BodyProperties p;
    for (int z = 0; z < model.zone_count(); ++z)
      p.zones.push_back(zone_properties<2>(20e9, 0.2, 1e-6 * (z % 100)));
    auto contact = mortar_contact();
    contact.normal_stiffness *= 0.6;
    contact.shear_stiffness *= 0.6;
    for (int c = 0; c < model.contact_count(); ++c) {  // each contact has its own temperature
      contact.friction_angle = contact.residual_friction_angle = 0.3 - 1e-4 * (c % 100);
      p.contacts.add(contact);
      p.of_contact.push_back(c);
    }
    p.contacts.add(contact);
    p.of_interface = {model.contact_count()};
    m.set_properties(std::move(p));
  };
  auto m = crushed(model, crushing<2>(), 1, 900, 900);
  const EnergyLedger before = m.totals().energy();
  heat(m);
  const EnergyLedger after = m.totals().energy();
  EXPECT_NE(after.contacts, before.contacts);
  EXPECT_GE(after.dissipated.total(), before.dissipated.total());
  EXPECT_NEAR(after.error(), before.error(), 1e-9 * turnover(after));
  m.advance(500);
  auto other = crushed(model, crushing<2>(), 2, 1, 1);
  copy_state(m, other);
  EXPECT_EQ(other.totals().energy().contacts, m.totals().energy().contacts);
  const double error = m.totals().energy().error();
  EXPECT_LT(std::abs(error), 2e-4 * turnover(m.totals().energy()));
  m.advance(300);
  other.advance(300);
  expect_equal(other, m, "copied after a change of properties");
}

// Promise: loose blocks in a box keep their energy without friction, and none passes another one.
TEST(FoundContactsVerification, LoosePileKeepsItsEnergy) {
  for (const auto& [friction, damping] : {std::pair{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.3}}) {
    ModelOf<2> model = empty_model();
    add_block(model, rectangle(-0.15, -0.05, 0.35, 0.05));
    add_block(model, rectangle(-0.15, 0.0, 0.05, 0.4));
    add_block(model, rectangle(0.15, 0.0, 0.05, 0.4));
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 5; ++j) {
        const Vec<2> at{{-0.08 + 0.052 * i, 0.02 + 0.055 * j}};
        add_block(model, rectangle(at[0], at[1], 0.03 + 0.002 * (i % 3), 0.03, 0.3 * i + 0.7 * j,
                                   at + Vec<2>{{0.015, 0.015}}));
      }
    auto parameters = flying(kGravity, 0.3);
    parameters.found.damping = damping;
    auto m = mechanics<2>(model, rubbing(1e10, friction), parameters, 30e9);
    for (int b = 0; b < 3; ++b) hold(m, b);
    while (m.time() < 0.1) m.advance(500);
    const EnergyLedger e = m.totals().energy();
    // Friction that comes and goes within a few steps is booked to the first order of the step.
    EXPECT_LT(std::abs(e.error()), (friction > 0.0 ? 2e-3 : 4e-6) * e.gravity);
    EXPECT_EQ(e.dissipated.of("friction") > 0.01 * e.gravity, friction > 0.0);
    for (int b = 3; b < model.block_count(); ++b) EXPECT_GT(lowest(m, b), -1e-3);
  }
}

TEST(FoundContacts, BodiesThatCannotHaveThemAreRefused) {
  const ModelOf<2> model = two_rows(2, 0.01);
  auto small = flying(0.0, 0.5);
  small.kinematics = Kinematics::small;
  EXPECT_THROW(mechanics<2>(model, mortar_contact(), small), Error);
  EXPECT_THROW(mechanics<2>(model, elastic_contact(), flying(0.0, 0.5)), Error);
}

}  // namespace
}  // namespace pyroclast
