#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bodies.hpp"
#include "copy_state.hpp"
#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/team.hpp"
#include "pyroclast/thermal/gap_conduction.hpp"

/// Heat through single contacts, by hand.
namespace pyroclast::gap_flow_test {
namespace {

constexpr double kJump = 2e-7;                 // m
constexpr double kBoltzmann = 5.670374419e-8;  // W/(m2 K4)

const std::string kNone = "no Error was thrown";

double kelvin(double celsius) {
  return celsius + 273.15;
}

/// Bridges alone: what the gas adds is lost in the last digit.
GapHeat bridges_alone(double conductance) {
  return {.bridges = conductance,
          .gas_conductivity = Curve::constant(1e-300),
          .jump_distance = kJump,
          .emissivity = 0.0,
          .split_below = 1e4};
}

/// Gas alone, of a conductivity that is linear between some points.
GapHeat gas_alone(std::vector<double> at, std::vector<double> conductivity) {
  return {.bridges = 0.0,
          .gas_conductivity = Curve::table(std::move(at), std::move(conductivity), temperature_axis()),
          .jump_distance = kJump,
          .emissivity = 0.0,
          .split_below = 1e4};
}

/// Two blocks side by side, 10 mm each, that meet in one face of 10 mm: two contacts of 5 mm each.
ModelOf<2> pair() {
  return plane_body({.blocks = {2, 1}, .size = {0.02, 0.01}});
}

/// The gaps of a body, whose contacts part as the gaps say.
struct Gaps {
  Gaps(const ModelOf<2>& of, const GapHeat& law, const Interval& range = {0.0, 1000.0},
       const std::vector<bool>& materials = {true})
      : model(of),
        conducts(blocks_of(model, materials)),
        gaps(model, conducts, law, TemperatureGrid(range), team) {}

  /// All contacts as wide open as that, with all gridpoints at a temperature.
  bool set(const ContactGap& gap, double temperature = 20.0) {
    const bool changes =
        gaps.set_gaps(std::vector<ContactGap>(model.contacts.size(), gap),
                      std::vector<double>(static_cast<std::size_t>(model.gridpoint_count()), temperature));
    nodes = join_through_contacts(model, conducts, gaps.parts());
    gaps.set_nodes(nodes);
    return changes;
  }
  bool parts(const ContactGap& gap) {
    set(gap);
    EXPECT_TRUE(std::ranges::all_of(gaps.parts(), [&](auto p) { return p == gaps.parts()[0]; }));
    return gaps.parts()[0] != 0;
  }
  /// Temperatures of the nodes, left and right of a plane.
  std::vector<double> sides(double x, double left, double right) const {
    std::vector<double> temperature;
    for (int node = 0; node < nodes.count(); ++node) temperature.push_back(is_left(node, x) ? left : right);
    return temperature;
  }
  bool is_left(int node, double x) const {
    const int g = nodes.gridpoint[node];
    int block = 0;
    while (model.block_gridpoints[block + 1] <= g) ++block;
    double centre = 0.0;
    const int first = model.block_gridpoints[block], last = model.block_gridpoints[block + 1];
    for (int i = first; i < last; ++i) centre += model.position[i][0] / (last - first);
    return centre < x;
  }
  bool is_at_gap(int node, double x) const {
    return std::abs(model.position[nodes.gridpoint[node]][0] - x) < 1e-9;
  }

  ModelOf<2> model;
  std::vector<bool> conducts;
  Team team{1};
  GapConduction<2> gaps;
  ThermalNodes nodes;
};

// ---- What parts, and what joins --------------------------------------------------------------------------

// Promise: a contact parts its sides below the stated conductance, not at it, and joins them above twice
// that, not at it; set_gaps says when that changed something, and only then.
TEST(GapFlow, PartsBelowAndJoinsAboveTwice) {
  Gaps g(pair(), bridges_alone(4e4));
  const auto of = [](double conductance) { return ContactGap{1.0 - conductance / 4e4, 0.0}; };
  EXPECT_FALSE(g.parts({0.0, 0.0}));
  EXPECT_FALSE(g.parts({0.75, 0.0})) << "at the bound, 1e4";
  EXPECT_TRUE(g.parts(of(0.999e4)));
  EXPECT_TRUE(g.parts({0.75, 0.0})) << "between";
  EXPECT_TRUE(g.parts({0.5, 0.0})) << "at twice the bound, 2e4";
  EXPECT_FALSE(g.parts(of(2.001e4)));
  EXPECT_FALSE(g.parts({0.75, 0.0})) << "between, joined";
  EXPECT_TRUE(g.set({1.0, 0.0}));
  EXPECT_FALSE(g.set({1.0, 0.0}));
  EXPECT_FALSE(g.set({0.9, 0.0}));
  EXPECT_TRUE(g.set({0.0, 0.0}));
  EXPECT_FALSE(g.set({0.0, 0.0}));
}

// Promise: one contact of many that changes is enough, the first, the last or one between.
TEST(GapFlow, OneContactThatPartsIsAChange) {
  const auto model = plane_body({.blocks = {3, 1}, .size = {0.03, 0.01}});
  const std::vector<double> cold(static_cast<std::size_t>(model.gridpoint_count()), 20.0);
  for (std::size_t one = 0; one < model.contacts.size(); ++one) {
    Gaps g(model, bridges_alone(4e4));
    std::vector<ContactGap> gaps(model.contacts.size());
    EXPECT_FALSE(g.gaps.set_gaps(gaps, cold));
    gaps[one].damage = 1.0;
    EXPECT_TRUE(g.gaps.set_gaps(gaps, cold));
    for (std::size_t i = 0; i < gaps.size(); ++i) EXPECT_EQ(g.gaps.parts()[i], i == one ? 1 : 0);
    EXPECT_FALSE(g.gaps.set_gaps(gaps, cold));
  }
}

// Promise: whether a contact parts depends on the temperatures of its own two sides.
TEST(GapFlow, PartsByTheTemperaturesOfItsSides) {
  // conducts 1e4 W/(m2 K) at 100 degC, in the mean of both sides
  const double width = 1e-6 - kJump;
  const auto model = pair();
  for (const auto& [left, right, parts] : {std::tuple{90.0, 108.0, true}, std::tuple{90.0, 112.0, false}}) {
    Gaps g(model, gas_alone({0.0, 1000.0}, {0.009, 0.019}), {0.0, 1000.0});
    std::vector<double> temperature;
    for (int p = 0; p < model.gridpoint_count(); ++p)
      temperature.push_back(p < model.block_gridpoints[1] ? left : right);
    // 0.009 + 1e-5 T = 0.01 at 100 degC
    g.gaps.set_gaps(std::vector<ContactGap>(model.contacts.size(), {1.0, width}), temperature);
    EXPECT_EQ(g.gaps.parts()[0] != 0, parts) << left << " " << right;
  }
}

// ---- Conductances ----------------------------------------------------------------------------------------

// Promise: bridges, gas at the mean temperature and radiation add up, also between the knots of the table.
TEST(GapFlow, BridgesGasAndRadiationAddUp) {
  GapHeat law = gas_alone({0.0, 400.0, 1000.0}, {0.02, 0.06, 0.03});
  law.bridges = 5e3;
  law.emissivity = 0.8;
  const auto model = pair();
  Gaps g(model, law);
  constexpr double width = 1e-4, damage = 0.75, a = 150.013, b = 320.0;
  g.set({damage, width});
  std::vector<double> temperature;
  for (int p = 0; p < model.gridpoint_count(); ++p)
    temperature.push_back(p < model.block_gridpoints[1] ? a : b);
  const double gas = 0.02 + 0.04 * 0.5 * (a + b) / 400.0;
  const double A = kelvin(a), B = kelvin(b);
  const double expected = 0.25 * 5e3 + gas / (width + kJump) +
                          kBoltzmann / (2.0 / 0.8 - 1.0) * (std::pow(A, 4) - std::pow(B, 4)) / (A - B);
  for (const double h : g.gaps.conductances(temperature)) EXPECT_NEAR(h, expected, 1e-9 * expected);
  // at both ends of the range too
  for (const auto& [at, k] : {std::pair{0.0, 0.02}, std::pair{400.0, 0.06}, std::pair{1000.0, 0.03}}) {
    GapHeat alone = law;
    alone.bridges = alone.emissivity = 0.0;
    Gaps end(model, alone);
    end.set({damage, width});
    const std::vector<double> even(temperature.size(), at);
    EXPECT_NEAR(end.gaps.conductances(even)[0], k / (width + kJump), 1e-9 * k / width) << at;
  }
}

// Promise: when the range of temperatures grows, the gas is known over all of it, and what was known stays.
TEST(GapFlow, AWiderRangeKnowsTheGasThere) {
  const GapHeat law = gas_alone({-50.0, 400.0, 1000.0}, {0.02, 0.065, 0.035});
  const auto model = pair();
  Gaps g(model, law, {20.0, 100.0});
  g.set({1.0, 1e-4});
  const auto at = [&](double t) {
    return g.gaps.conductances(std::vector<double>(static_cast<std::size_t>(model.gridpoint_count()), t))[0] *
           (1e-4 + kJump);
  };
  EXPECT_NEAR(at(60.0), 0.031, 1e-12);
  g.gaps.set_grid(TemperatureGrid({-20.0, 900.0}));
  EXPECT_NEAR(at(60.0), 0.031, 1e-12);
  EXPECT_NEAR(at(-20.0), 0.023, 1e-12);
  EXPECT_NEAR(at(400.0), 0.065, 1e-12);
  EXPECT_NEAR(at(900.0), 0.04, 1e-12);
  expect_in("does not cover", message([&] { g.gaps.set_grid(TemperatureGrid({-51.0, 900.0})); }));
  expect_in("does not cover", message([&] { g.gaps.set_grid(TemperatureGrid({-20.0, 1001.0})); }));
}

// ---- Flow between nodes ----------------------------------------------------------------------------------

// Promise: what flows out of one side flows into the other, area times conductance times the difference, from
// the hotter to the colder; nodes beside the gap get nothing.
TEST(GapFlow, HeatFlowsFromTheHotterSide) {
  const auto model = plane_body({.blocks = {3, 1}, .size = {0.03, 0.01}});
  Gaps g(model, bridges_alone(4e3));
  g.set({0.5, 0.0});  // 2000 W/(m2 K)
  EXPECT_NEAR(g.gaps.area(), 0.02, 1e-15);
  const auto temperature = g.sides(0.01, 300.0, 100.0);
  g.gaps.update(temperature);
  for (int node = 0; node < g.nodes.count(); ++node) {
    const double flow = g.is_at_gap(node, 0.01) ? 2000.0 * 0.005 * 200.0 : 0.0;
    EXPECT_NEAR(g.gaps.inflow(node), g.is_left(node, 0.01) ? -flow : flow, 1e-9 * 2000.0) << node;
  }
}

// Promise: a node's neighbours across its contacts bound its temperature, and no other node does.
TEST(GapFlow, TheNodeAcrossBoundsATemperature) {
  const auto model = plane_body({.blocks = {3, 1}, .size = {0.03, 0.01}});
  Gaps g(model, bridges_alone(4e3));
  g.set({1.0, 0.0});
  std::vector<double> temperature;
  for (int node = 0; node < g.nodes.count(); ++node)
    temperature.push_back(g.is_left(node, 0.01) ? 100.0 : g.is_left(node, 0.02) ? 200.0 : 400.0);
  for (int node = 0; node < g.nodes.count(); ++node) {
    Interval range{temperature[node], temperature[node]};
    g.gaps.add_around(node, temperature, range);
    Interval expected{temperature[node], temperature[node]};
    if (g.is_at_gap(node, 0.01)) expected = {100.0, 200.0};
    if (g.is_at_gap(node, 0.02)) expected = {200.0, 400.0};
    EXPECT_EQ(range.lower, expected.lower) << node;
    EXPECT_EQ(range.upper, expected.upper) << node;
  }
}

// Promise: the bound of a row is twice its conductance, by the best gas between coldest and hottest and by
// the hotter of the two sides: on the diagonal and beside it. It holds, and is not far too large.
TEST(GapFlow, ARowIsBoundedByItsSteepestContact) {
  constexpr double width = 1e-4;
  const auto bounds = [&](const GapHeat& law, double coldest, double left, double right) {
    Gaps g(pair(), law, {15.0, 1000.0});
    g.set({1.0, width});
    std::vector<double> rows(static_cast<std::size_t>(g.nodes.count()), 7.0);
    g.gaps.add_row_bound({coldest, std::max(left, right)}, g.sides(0.01, left, right), rows);
    double at_gap = 0.0;
    for (int node = 0; node < g.nodes.count(); ++node) {
      if (g.is_at_gap(node, 0.01)) at_gap = rows[node] - 7.0;
    }
    for (int node = 0; node < g.nodes.count(); ++node)
      EXPECT_EQ(rows[node] - 7.0, g.is_at_gap(node, 0.01) ? at_gap : 0.0);
    return at_gap / (2.0 * 0.005);  // W/(m2 K) of one contact of 5 mm
  };
  const auto best_gas = [&](double coldest, double left, double right) {
    return bounds(gas_alone({0.0, 400.0, 1000.0}, {0.02, 0.06, 0.03}), coldest, left, right) *
           (width + kJump);
  };
  const double cell = 0.1 * 1e-4;  // what the gas changes over a cell of the table, and a little
  EXPECT_NEAR(best_gas(100.0, 700.0, 300.0), 0.06, 1e-12);  // the peak lies between
  for (const auto& [left, right] : {std::pair{350.0, 250.0}, std::pair{250.0, 350.0}}) {
    EXPECT_GE(best_gas(100.0, left, right), 0.055);  // rises to the hottest
    EXPECT_LE(best_gas(100.0, left, right), 0.055 + cell);
  }
  EXPECT_GE(best_gas(600.0, 800.0, 900.0), 0.05);  // falls from the coldest
  EXPECT_LE(best_gas(600.0, 800.0, 900.0), 0.05 + cell);
  EXPECT_NEAR(best_gas(400.0, 1000.0, 1000.0), 0.06, 1e-12);  // to the end of the range
  // radiation, by the hotter side
  GapHeat radiates = gas_alone({0.0, 1000.0}, {1e-30, 1e-30});
  radiates.emissivity = 0.5;
  for (const auto& [left, right] : {std::pair{800.0, 100.0}, std::pair{100.0, 800.0}}) {
    const double steepest = 4.0 * kBoltzmann / 3.0 * std::pow(kelvin(800.0), 3);
    EXPECT_NEAR(bounds(radiates, 20.0, left, right), steepest, 1e-9 * steepest);
  }
}

// Promise: without contacts between nodes there is nothing to bound.
TEST(GapFlow, JoinedContactsAddNoBound) {
  Gaps g(pair(), bridges_alone(4e4));
  g.set({0.0, 0.0});
  std::vector<double> rows(static_cast<std::size_t>(g.nodes.count()), 3.0);
  g.gaps.add_row_bound({20.0, 50.0}, std::vector<double>(rows.size(), 50.0), rows);
  EXPECT_TRUE(std::ranges::all_of(rows, [](double r) { return r == 3.0; }));
  EXPECT_EQ(g.gaps.area(), 0.0);
}

// Promise: a contact is closed where one side does not conduct, whichever; it parts nothing and bears no
// heat.
TEST(GapFlow, AContactIsClosedWhereEitherSideIs) {
  const auto model =
      plane_body({.blocks = {3, 1},
                  .size = {0.03, 0.01},
                  .material = [](const Vec<2>& x) { return x[0] < 0.01 || x[0] > 0.02 ? 1 : 0; }},
                 2);
  for (const bool middle_conducts : {true, false}) {
    Gaps g(model, bridges_alone(4e3), {0.0, 1000.0}, {middle_conducts, !middle_conducts});
    EXPECT_FALSE(g.set({1.0, 0.0}));
    EXPECT_EQ(g.gaps.area(), 0.0);
    const std::vector<double> even(static_cast<std::size_t>(model.gridpoint_count()), 20.0);
    for (const double h : g.gaps.conductances(even)) EXPECT_EQ(h, 0.0);
    for (const auto parts : g.gaps.parts()) EXPECT_EQ(parts, 0);
  }
}

// Promise: the state holds what is left of the contacts, and which of them part.
TEST(GapFlow, ItsStateIsItsGaps) {
  Gaps first(pair(), bridges_alone(4e4)), second(pair(), bridges_alone(4e4));
  first.set({0.75, 0.0});
  first.set({1.0, 0.0});
  first.set({0.75, 0.0});  // between: parted, for it came from below
  copy_state(first.gaps, second.gaps);
  EXPECT_EQ(second.gaps.parts(), first.gaps.parts());
  EXPECT_EQ(second.gaps.parts()[0], 1);
  const std::vector<double> even(static_cast<std::size_t>(first.model.gridpoint_count()), 20.0);
  EXPECT_EQ(second.gaps.conductances(even), std::vector<double>(first.model.contacts.size(), 1e4));
}

// ---- Errors ----------------------------------------------------------------------------------------------

// Promise: what is at the end of a range is allowed, what is beyond it, or no number, is not.
TEST(GapFlow, EndsOfRangesAreAllowed) {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const auto law = [&](const auto& change) {
    GapHeat l = bridges_alone(1e4);
    change(l);
    return message([&] { Gaps(pair(), l); });
  };
  EXPECT_EQ(law([](GapHeat& l) { l.bridges = 0.0; }), kNone);
  EXPECT_EQ(law([](GapHeat& l) { l.split_below = 0.5; }), kNone);
  EXPECT_EQ(law([](GapHeat& l) { l.emissivity = 1.0; }), kNone);
  EXPECT_EQ(law([](GapHeat& l) { l.emissivity = 0.0; }), kNone);
  expect_in("bridges", law([&](GapHeat& l) { l.bridges = infinite; }));
  expect_in("bridges", law([&](GapHeat& l) { l.bridges = nan; }));
  expect_in("emissivity", law([](GapHeat& l) { l.emissivity = 1.001; }));
  expect_in("emissivity", law([](GapHeat& l) { l.emissivity = -0.001; }));
  expect_in("jump distance", law([](GapHeat& l) { l.jump_distance = -1e-9; }));
  expect_in("falls to -1", law([](GapHeat& l) { l.gas_conductivity = Curve::constant(-1.0); }));

  Gaps g(pair(), bridges_alone(1e4));
  const auto gap = [&](const ContactGap& one) { return message([&] { g.set(one); }); };
  EXPECT_EQ(gap({0.0, 0.0}), kNone);
  EXPECT_EQ(gap({1.0, 0.1}), kNone);
  expect_in("damage is -0.001", gap({-0.001, 0.0}));
  expect_in("damage is 1.001", gap({1.001, 0.0}));
  expect_in("damage", gap({nan, 0.0}));
  expect_in("opening", gap({0.0, -1e-12}));
  expect_in("opening", gap({0.0, infinite}));
  expect_in("opening", gap({0.0, nan}));
}

}  // namespace
}  // namespace pyroclast::gap_flow_test
