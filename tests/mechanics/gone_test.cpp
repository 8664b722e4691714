#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/base/random.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"

/// Blocks that leave a body: the rest goes on as a body without them, and the ledger knows where their energy
/// went.
namespace pyroclast::gone_test {
namespace {

using namespace bodies;

constexpr double young = 29.4e9, poisson = 0.2;

template <int Dim>
MechanicsParameters that_loses_blocks(Kinematics kinematics) {
  auto parameters = quasi_static<Dim>(0.3);
  parameters.viscous_damping = 20.0;
  parameters.mass = MassChoice::real;
  parameters.kinematics = kinematics;
  parameters.safety = 0.2;
  parameters.gravity = {{3.0, -9.81, 0.0}};
  parameters.loses_blocks = true;
  return parameters;
}

template <int Dim>
BodyProperties under_pressure(const ModelOf<Dim>& model, const ContactProperties& contact) {
  BodyProperties p = by_interface(
      model, std::vector<ZoneProperties>(model.zones.size(), zone_properties<Dim>(young, poisson, 1e-5)),
      {contact});
  Random random(7);
  for (int c = 0; c < model.contact_count(); ++c) p.pore_pressure.push_back(random.uniform(0.0, 2e6));
  return p;
}

template <int Dim>
Mechanics<Dim> shaken(const ModelOf<Dim>& model, const ContactProperties& contact,
                      const MechanicsParameters& parameters) {
  Mechanics<Dim> m(model, {2400.0}, under_pressure(model, contact), parameters);
  Random random(4);
  std::vector<Vec<Dim>> velocities(model.position.size());
  for (auto& v : velocities)
    for (double& component : v.c) component = random.uniform(-0.02, 0.02);
  m.begin_moving(velocities);
  return m;
}

/// Promise: energy before is energy after with that of the blocks that went, whatever they were doing.
template <int Dim>
void expect_balance(const ModelOf<Dim>& model, const MechanicsParameters& parameters, double within) {
  auto m = shaken(model, elastic_contact(), parameters);
  m.advance(200);
  const EnergyLedger before = m.totals().energy();
  std::vector<int> blocks;
  for (int b = 0; b < model.block_count(); b += 5) blocks.push_back(b);
  m.remove(blocks);
  m.advance(1);
  const EnergyLedger now = m.totals().energy();
  EXPECT_GT(std::abs(now.removed), 1e-2 * (before.kinetic + before.elastic()));
  EXPECT_LT(std::abs(now.error() - before.error()), within * turnover(before));
  m.advance(300);
  const EnergyLedger after = m.totals().energy();
  EXPECT_EQ(after.removed, now.removed);
  EXPECT_LT(std::abs(after.error() - before.error()), within * turnover(after));
  for (const int block : blocks)
    for (int g = model.block_gridpoints[block]; g < model.block_gridpoints[block + 1]; ++g) {
      EXPECT_EQ(norm(m.read().velocity(g)), 0.0);
      EXPECT_EQ(norm(m.read().force(g)), 0.0);
    }
  // new properties reach the others alone
  auto hotter = under_pressure(model, elastic_contact());
  for (auto& zone : hotter.zones) zone.thermal_strain = 5e-5;
  m.set_properties(hotter);
  m.advance(300);
  const EnergyLedger last = m.totals().energy();
  EXPECT_EQ(last.removed, now.removed);
  EXPECT_LT(std::abs(last.error() - before.error()), within * turnover(last));
  for (const int block : blocks) EXPECT_EQ(norm(m.read().force(model.block_gridpoints[block])), 0.0);
}

TEST(GoneBlocks, TakeTheirEnergyAlong) {
  const ModelOf<2> plane = tessellated(40, 0.05, 0.05, 3);
  expect_balance(plane, that_loses_blocks<2>(Kinematics::small), 1e-9);
  expect_balance(plane, that_loses_blocks<2>(Kinematics::finite), 1e-4);
  expect_balance(laguerre_cells(30, 0.05, 2), that_loses_blocks<3>(Kinematics::small), 1e-9);
  expect_balance(laguerre_cells(30, 0.05, 2), that_loses_blocks<3>(Kinematics::finite), 1e-4);
}

TEST(GoneBlocks, TakeTheirEnergyAlongUnderScaledMass) {
  auto parameters = that_loses_blocks<2>(Kinematics::small);
  parameters.mass = MassChoice::scaled;
  parameters.time_step = 1e-7;
  expect_balance(tessellated(40, 0.05, 0.05, 3), parameters, 1e-9);
}

/// Promise: what is left moves as a body that never had the others, to the bit.
TEST(GoneBlocks, LeaveABodyThatMovesAsIfItWereAlone) {
  const ModelOf<2> all = column(4, 0.01), two = column(2, 0.01);
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    const auto parameters = that_loses_blocks<2>(kinematics);
    const auto properties = [&](const ModelOf<2>& model) {
      return by_interface(model,
                          std::vector<ZoneProperties>(model.zones.size(), zone_properties<2>(young, poisson)),
                          {mortar_contact()});
    };
    Mechanics<2> m(all, {2400.0}, properties(all), parameters);
    Mechanics<2> alone(two, {2400.0}, properties(two), parameters);
    ASSERT_EQ(m.time_step(), alone.time_step());
    std::vector<Vec<2>> velocities(all.position.size());
    Random random(9);
    for (auto& v : velocities) v = {{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)}};
    m.begin_moving(velocities);
    alone.begin_moving({velocities.begin(), velocities.begin() + two.gridpoint_count()});
    m.remove({2, 3});
    m.advance(500);
    alone.advance(500);
    for (int g = 0; g < two.gridpoint_count(); ++g)
      EXPECT_EQ(norm(m.read().displacement(g) - alone.read().displacement(g)), 0.0);
    EXPECT_DOUBLE_EQ(m.totals().unbalanced_ratio(), alone.totals().unbalanced_ratio());
  }
}

/// Promise: contacts that were found forget a block that goes, but for what they lost; what lay on it falls.
TEST(GoneBlocks, AreForgottenByFoundContacts) {
  ModelOf<2> model = empty_model();
  const int floor = add_block(model, rectangle(0.0, -0.02, 0.06, 0.02));
  const int lower = add_block(model, rectangle(0.01, 0.0, 0.02, 0.02));
  const int upper = add_block(model, rectangle(0.015, 0.0201, 0.02, 0.02));
  auto parameters = flying(kGravity, 0.3);
  parameters.loses_blocks = true;
  parameters.local_damping = 0.2;
  const auto make = [&] {
    auto m = mechanics<2>(model, rubbing(1e11, 0.4), parameters, 30e9);
    hold(m, floor);
    return m;
  };
  auto m = make();
  while (m.time() < 0.02) m.advance(500);
  ASSERT_FALSE(found_points(m.body()).empty());
  const EnergyLedger before = m.totals().energy();
  m.remove({lower});
  m.advance(1);
  const EnergyLedger now = m.totals().energy();
  EXPECT_NEAR(now.error(), before.error(), 1e-9 * turnover(before));
  EXPECT_GE(now.dissipated.total(), before.dissipated.total());
  EXPECT_TRUE(found_points(m.body()).empty());
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { m.visit_state(visitor); });
  auto resumed = make();
  copy.put([&](StateVisitor& visitor) { resumed.visit_state(visitor); });
  for (auto* body : {&m, &resumed})
    while (body->time() < 0.12) body->advance(500);
  EXPECT_LT(lowest(m, upper), 0.01);  // it fell through the place of the other, and jumps back from the floor
  EXPECT_GT(lowest(m, upper), -0.001);
  for (const FoundPoint& point : found_points(m.body()))
    for (const int block : point.blocks) EXPECT_NE(block, lower);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    EXPECT_EQ(norm(m.read().displacement(g) - resumed.read().displacement(g)), 0.0);
}

TEST(GoneBlocks, StayGoneInAState) {
  const ModelOf<2> model = tessellated(40, 0.05, 0.05, 3);
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    const auto parameters = that_loses_blocks<2>(kinematics);
    auto m = shaken(model, mortar_contact(), parameters);
    m.advance(150);
    m.remove({3, 17});
    StateCopy copy;
    copy.take([&](StateVisitor& visitor) { m.visit_state(visitor); });
    Mechanics<2> resumed(model, {2400.0}, under_pressure(model, mortar_contact()), parameters);
    copy.put([&](StateVisitor& visitor) { resumed.visit_state(visitor); });
    for (auto* body : {&m, &resumed}) {
      body->advance(100);
      body->set_properties(under_pressure(model, mortar_contact()));
      body->remove({5});
      body->advance(100);
    }
    for (int g = 0; g < model.gridpoint_count(); ++g)
      EXPECT_EQ(norm(m.read().displacement(g) - resumed.read().displacement(g)), 0.0);
    EXPECT_EQ(m.totals().energy().removed, resumed.totals().energy().removed);
    EXPECT_EQ(m.totals().energy().error(), resumed.totals().energy().error());
  }
}

}  // namespace
}  // namespace pyroclast::gone_test
