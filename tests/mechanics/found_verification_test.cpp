#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "hertz.hpp"
#include "known.hpp"
#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
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

/// Contacts of loose rectangles as one writes them without lists: in each step every edge meets every edge of
/// the other blocks, one pair after the other, with the law of one point.
class AllPairs {
 public:
  AllPairs(const ModelOf<2>& model, const Frictional::Properties<double>& law)
      : model_(model), constants_(Frictional::derive(law)) {
    for (int b = 0; b < model.block_count(); ++b) {
      const int first = model.block_gridpoints[b];
      double area = 0.0, longest = 0.0;
      for (int i = 0; i < 4; ++i) {
        const int from = first + i, to = first + (i + 1) % 4;
        const double length = norm(model.position[to] - model.position[from]);
        edges_.push_back({b, from, to, length});
        area += 0.5 * cross(model.position[from] - model.position[first],
                            model.position[to] - model.position[first]);
        longest = std::max(longest, length);
      }
      most_depth_.push_back(0.25 * area / longest);
    }
    ends_.resize(edges_.size() * edges_.size());
  }

  double rubbed = 0.0;  ///< energy lost to friction, J

  /// Puts the forces at the present places on the gridpoints of a body that has no contacts.
  void load(Mechanics<2>& m, int held_blocks) {
    std::vector<Vec<2>> forces(model_.position.size());
    for (std::size_t a = 0; a < edges_.size(); ++a)
      for (std::size_t b = a + 1; b < edges_.size(); ++b)
        if (edges_[a].block != edges_[b].block) add(m, a, b, forces);
    for (int g = model_.block_gridpoints[held_blocks]; g < model_.gridpoint_count(); ++g)
      m.constraints().apply_force(g, forces[g]);
  }

 private:
  struct Edge {
    int block, from, to;
    double length;
  };
  struct End {
    double area = 0.0, shift = 0.0, held = 0.0;
    Frictional::Internals<2, double> internals{};
  };

  void add(const Mechanics<2>& m, std::size_t a, std::size_t b, std::vector<Vec<2>>& forces) {
    const Edge &edge_a = edges_[a], &edge_b = edges_[b];
    const std::array<int, 4> corners{edge_a.from, edge_a.to, edge_b.to, edge_b.from};
    const auto at = [&](int i) { return model_.position[corners[i]] + m.read().displacement(corners[i]); };
    const auto p = edge_pair<double>({at(0), at(1)}, {at(2), at(3)}, edge_a.length, edge_b.length);
    const double most_depth = std::min(most_depth_[edge_a.block], most_depth_[edge_b.block]);
    const EndAreas<double> areas(p, model_.thickness, 0.0, most_depth, p.gap);
    EndAreas<double> of_pressed = areas;
    EndTractions<double> tractions;
    for (int k = 0; k < 2; ++k) {
      End& end = ends_[(a * edges_.size() + b)][k];
      if (!p.face || p.gap[k] >= 0.0 || -p.gap[k] >= most_depth || areas.area[k] <= 0.0) {
        if (end.area > 0.0)  // what was held is let go
          rubbed += 0.5 * constants_.shear_stiffness * end.held * end.held * end.area;
        end = {};
        of_pressed.area[k] = 0.0;
        of_pressed.ends[k].share = of_pressed.ends[k].slope = of_pressed.ends[k].depth = 0.0;
        continue;
      }
      if (end.area == 0.0) end.shift = -p.slide[k];
      if (end.area > 0.0 && areas.area[k] > end.area) {  // the force stays
        const double held = end.held * end.area / areas.area[k];
        end.shift -= end.held - held;
        end.internals.held_jump = std::abs(held);
      }
      Frictional::Losses<double> losses{};
      const auto response = Frictional::update<2, double>(
          constants_, p.gap[k], Tangential<2, double>{{p.slide[k] + end.shift}}, end.internals, losses);
      end.area = areas.area[k];
      end.held = response.shear_traction[0] / constants_.shear_stiffness;
      rubbed += losses.friction * end.area;
      tractions.normal[k] = response.normal_traction;
      tractions.shear[k] = response.shear_traction[0];
      tractions.stored[k] = response.stored - 0.5 * response.shear_traction[0] * end.held;
    }
    if (!(of_pressed.area[0] > 0.0) && !(of_pressed.area[1] > 0.0)) return;
    const auto f = corner_forces(p, of_pressed, tractions);
    for (int i = 0; i < 4; ++i) forces[corners[i]] += f[i];
  }

  const ModelOf<2>& model_;
  Frictional::Constants<double> constants_;
  std::vector<Edge> edges_;
  std::vector<double> most_depth_;
  std::vector<std::array<End, 2>> ends_;  // by edge a, then b
};

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
  const auto law = rubbing(1e8, 0.4);
  auto parameters = flying(kGravity, 0.3);
  auto m = mechanics<2>(model, law, parameters, 3e8);
  parameters.found.is_on = false;
  const double own_step = mechanics<2>(model, law, parameters, 3e8).time_step();
  parameters.safety *= m.time_step() / own_step;
  auto expected = mechanics<2>(model, law, parameters, 3e8);
  ASSERT_NEAR(expected.time_step(), m.time_step(), 1e-15 * m.time_step());
  for (Mechanics<2>* body : {&m, &expected}) {
    for (int b = 0; b < kHeld; ++b) hold(*body, b);
    body->begin_moving(velocities);
  }
  AllPairs pairs(model, law);
  while (m.time() < 0.05) {
    pairs.load(expected, kHeld);
    expected.advance(1);
    m.advance(1);
    if (m.steps() % 500 != 0) continue;
    double difference = 0.0;
    for (int g = 0; g < model.gridpoint_count(); ++g)
      difference = std::max(difference, norm(m.read().displacement(g) - expected.read().displacement(g)));
    EXPECT_LT(difference, 1e-13);  // rounding; blocks have gone some 50 mm
  }
  const EnergyLedger e = m.totals().energy();
  EXPECT_GT(e.dissipated.of("friction"), 0.2 * e.kinetic);  // blocks have met
  EXPECT_NEAR(e.dissipated.of("friction"), pairs.rubbed, 1e-10 * pairs.rubbed);
}

}  // namespace
}  // namespace pyroclast
