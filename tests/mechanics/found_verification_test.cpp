#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "all_pairs.hpp"
#include "hertz.hpp"
#include "known.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// Found contacts beside closed forms, and beside a code that knows neither lists nor rows.
namespace pyroclast {
namespace {

using namespace bodies;

template <class Where>
std::vector<int> gridpoints_where(const ModelOf<2>& model, Where where) {
  std::vector<int> found;
  for (int g = 0; g < model.gridpoint_count(); ++g)
    if (where(g)) found.push_back(g);
  return found;
}

// Promise: the halves of a broken prism rub with mu N while they slide on each other, over edges that are not
// their partners, as far as one and a half of them.
TEST(FoundContactsVerification, HalvesOfAPrismRubWithCoulombsFriction) {
  constexpr int kWide = 6, kHigh = 2;
  constexpr double kEdge = 0.01, kPressure = 2e6, kSpeed = 0.2, kFar = 1.5;
  const ModelOf<2> model = two_rows(kWide, kEdge);
  auto bond = mortar_contact();
  bond.residual_cohesion = 0.0;
  bond.normal_stiffness = 1e12;
  bond.shear_stiffness = 0.4e12;
  bond.compressive_limit = 1e12;
  auto parameters = flying(0.0, 0.5);
  parameters.local_damping = 0.8;  // with less, halves that slide faster shake, and rub less in the mean
  parameters.damping_form = DampingForm::combined;
  auto m = mechanics<2>(model, bond, parameters, 30e9);
  for (int c = 0; c < model.contact_count(); ++c)
    if (std::abs(model.contacts[c].normal[1]) > 0.5) {
      ASSERT_TRUE(m.break_contact(c));
    }
  const auto at_height = [&](double y) {
    return gridpoints_where(model, [&](int g) { return std::abs(model.position[g][1] - y) < 1e-9; });
  };
  const std::vector<int> bottom = at_height(0.0), top = at_height(kHigh * kEdge);
  const double force = kPressure * kWide * kEdge * model.thickness;
  for (const int g : bottom)
    for (int i = 0; i < 2; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
  for (const int g : top) m.constraints().apply_force(g, {{0.0, -force / static_cast<double>(top.size())}});
  m.advance(3000);
  for (int part = 1; part <= 30; ++part) {  // not at once
    for (const int g : top) m.constraints().prescribe_velocity(g, 0, kSpeed * part / 30);
    m.advance(100);
  }
  const double expected = std::tan(bond.residual_friction_angle) * force;
  const auto slid = [&] { return m.read().displacement(top.front())[0] / kEdge; };
  double sum = 0.0;
  int count = 0;
  while (slid() < kFar) {
    m.advance(50);
    if (slid() < 0.1) continue;
    for (const int g : bottom) sum += m.read().force(g)[0];
    ++count;
  }
  expect_known({"A broken prism whose halves slide by 1.5 edges: friction over mu N", "Coulomb's law", "1"},
               sum / count / expected, 1.0, 0.015);
  // some faces lie on two others now
  std::map<int, std::vector<int>> partners;
  for (const FoundPoint& point : found_points(m.body())) partners[point.blocks[1]].push_back(point.blocks[0]);
  EXPECT_TRUE(std::ranges::any_of(
      partners, [](const auto& of_block) { return of_block.second.front() != of_block.second.back(); }));
  EXPECT_LT(std::abs(m.totals().energy().error()), 5e-4 * turnover(m.totals().energy()));
}

/// Sector of a disc as one block, its zones finer where it touches a plate below.
ModelOf<2> sector(const Round& round) {
  std::vector<double> angles = round.angles();
  for (std::size_t i = 1, half = angles.size(); i < half; ++i) angles.push_back(-angles[i]);
  std::ranges::sort(angles);
  const int columns = static_cast<int>(angles.size()) - 1;
  std::vector<Vec<2>> gridpoints;
  for (int j = 0; j <= round.layers; ++j)
    for (const double angle : angles)
      gridpoints.push_back(Vec<2>{{std::sin(angle), -std::cos(angle)}} * round.at_layer(j));
  std::vector<std::array<int, 3>> zones;
  for (int j = 0; j < round.layers; ++j)
    for (int i = 0; i < columns; ++i) {
      const int low = j * (columns + 1) + i, high = low + columns + 1;
      const std::array<int, 4> corners{low, low + 1, high + 1, high};
      Vec<2> middle{};
      for (const int g : corners) middle += gridpoints[g] * 0.25;
      const int centre = static_cast<int>(gridpoints.size());
      gridpoints.push_back(middle);
      for (int k = 0; k < 4; ++k) zones.push_back({corners[k], corners[(k + 1) % 4], centre});
    }
  ModelOf<2> model = empty_model();
  model.add_block(gridpoints, zones, 0);
  return model;
}

// Promise: a disc of facets presses a plate that was not made with it as Hertz's cylinder does.
TEST(FoundContactsVerification, DiscOnAPlatePressesAsHertzSays) {
  constexpr double kYoung = 30e9;
  const Round round{.radius = 0.05,
                    .depth = 0.012,
                    .facet_angle = 0.25 * std::numbers::pi / 180.0,
                    .fine = 12,
                    .coarse = 12,
                    .layers = 14};
  ModelOf<2> model = sector(round);
  const double low = std::ranges::min(model.position, {}, [](const Vec<2>& x) { return x[1]; })[1];
  add_block(model, rectangle(-0.03, low - 0.01, 0.06, 0.01));
  const PressedSpot spot = press(model, round, kYoung, 6.5e-5, 3000, 6000);
  const double force = spot.force / model.thickness,
               half_width = std::sqrt(4.0 * force * round.radius / (std::numbers::pi * kYoung)),
               pressure = 2.0 * force / (std::numbers::pi * half_width);
  EXPECT_NEAR(2.0 * half_width / round.facet(), 14.0, 0.5);
  const std::string what = "A disc of facets on a plate of its own, 14 of them pressed: ",
                    hertz = "Hertz (Johnson 1985, 4.2)";
  expect_known({what + "half width", hertz, "m"}, 2.0 * std::sqrt(spot.mean_square), half_width,
               0.02 * half_width);
  expect_known({what + "largest pressure", hertz, "Pa"}, spot.largest, pressure, 0.02 * pressure);
}

// Promise: a disc that plates split keeps its energy, the pieces that part and meet again included.
TEST(FoundContactsVerification, CrushedDiscKeepsItsEnergy) {
  constexpr double kDiameter = 0.1, kSpeed = 0.1, kFar = 0.3e-3;
  std::vector<Vec<2>> outline;
  for (int i = 0; i < 36; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / 36 - 0.5 * std::numbers::pi;
    outline.push_back({{0.5 * kDiameter * std::cos(angle), 0.5 * kDiameter * std::sin(angle)}});
  }
  ModelOf<2> model = tessellated(80, specimen::Region::polygon(outline, {"rim"}, true), kDiameter, 1);
  const double low = std::ranges::min(model.position, {}, [](const Vec<2>& x) { return x[1]; })[1];
  const int lower = add_block(model, rectangle(-0.06, low - 0.02, 0.12, 0.02));
  const int upper = add_block(model, rectangle(-0.06, -low, 0.12, 0.02));
  auto bond = mortar_contact();
  bond.residual_cohesion = 0.0;
  bond.normal_stiffness *= 0.5;
  bond.shear_stiffness *= 0.5;
  auto parameters = flying(0.0, 0.05);  // the error is of the first order of the step
  parameters.local_damping = 0.3;
  parameters.damping_form = DampingForm::combined;
  auto m = mechanics<2>(model, bond, parameters);
  hold(m, lower);
  for (int g = model.block_gridpoints[upper]; g < model.block_gridpoints[upper + 1]; ++g) {
    m.constraints().prescribe_velocity(g, 0, 0.0);
    m.constraints().prescribe_velocity(g, 1, -kSpeed);
  }
  while (m.time() < kFar / kSpeed) m.advance(1000);
  const EnergyLedger e = m.totals().energy();
  const auto handed_over = std::ranges::count(m.body().found->is_handed_over, true);
  EXPECT_GT(handed_over, 20);
  EXPECT_LT(std::abs(e.error()), 1e-5 * e.loading);
}

// Promise: blocks that fall, turn, rub and bounce go the same way as with all pairs in each step.
TEST(FoundContactsVerification, ListsAndRowsAgreeWithAllPairsInEachStep) {
  constexpr int kHeld = 3;
  ModelOf<2> model = empty_model();
  add_block(model, rectangle(-0.1, -0.05, 0.2, 0.05));
  add_block(model, rectangle(-0.1, 0.0, 0.03, 0.2));
  add_block(model, rectangle(0.07, 0.0, 0.03, 0.2));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec<2> at{{-0.055 + 0.04 * i, 0.004 + 0.042 * j}};
      add_block(model, rectangle(at[0], at[1], 0.03, 0.02 + 0.002 * i, 0.08 * (i - 1) + 0.3 * j,
                                 at + Vec<2>{{0.015, 0.01}}));
    }
  std::vector<Vec<2>> velocities(model.position.size());
  for (int b = kHeld; b < model.block_count(); ++b)
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g)
      velocities[g] = {{0.4 * (b % 3 - 1), -1.0}};
  expect_the_way_of_all_pairs(model, kHeld, velocities, 0.05, 500);
}

}  // namespace
}  // namespace pyroclast
