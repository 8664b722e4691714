#include "pyroclast/moisture/moisture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "known.hpp"
#include "mechanics/bodies.hpp"
#include "moisture/strip.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {
namespace {

constexpr double kHot = 300.0, kLong = 0.1;

/// Flow of vapour through a bar, kg/(m2 s), from the integral of density over pressure, at 300 degC.
double darcy(double permeability, double from, double to) {
  const double s = water::compressibility_slope(kHot), gas = water::kGasConstant * (kHot + 273.15);
  const auto potential = [&](double p) { return (-p / s - std::log1p(-s * p) / (s * s)) / gas; };
  return permeability / water::vapour_viscosity(kHot) * (potential(from) - potential(to)) / kLong;
}

// Promise: p^2 is linear in steady flow of vapour, which is that of Darcy's law, whatever the number of
// cells.
TEST(SteadyVapourVerification, FlowsByDarcysLaw) {
  PoreMaterial pores = dry_pores(1e-17);
  pores.tortuosity = 0.0;  // no diffusion
  MoistBody<2> body = strip(20, kLong, pores, {.largest_step = 1e6});
  body.moisture.start_with_pressure(1e6, kHot);
  const double flow = body.steady_flow(1e6, 1e5, kLong, body.everywhere(kHot)) / 0.01;
  const double exact = darcy(1e-17, 1e6, 1e5);
  expect_known({"Steady flow of vapour from 1 MPa to 0.1 MPa through 0.1 m at 300 degC",
                "integral of density over pressure, with the compressibility of the program", "kg/(m2 s)"},
               flow, exact, 1e-4 * exact);
  // but for the compressibility
  EXPECT_NEAR(exact / (1e-17 * (1e12 - 1e10) /
                       (2.0 * water::vapour_viscosity(kHot) * water::kGasConstant * (kHot + 273.15) * kLong)),
              1.0, 0.03);
  const auto x = body.centroids();
  for (std::size_t c = 0; c < x.size(); ++c) {
    const double share = x[c][0] / kLong;
    EXPECT_NEAR(std::sqrt(1e12 + share * (1e10 - 1e12)) / body.moisture.state().pressure[c], 1.0, 0.01);
  }
}

/// A bar of 0.1 m by 0.05 m by 0.05 m along x, of random cells whose edges below a share of the mean are
/// merged.
ModelOf<3> bar_of_random_cells(double shortest_edge) {
  const std::string bar = "width = \"100 mm\"\nheight = \"50 mm\"\ndepth = \"50 mm\"\nseed = 3\n";
  std::string deck = shipped_case("starter_3d");
  const auto begin = deck.find("shape = \"cylinder\""), end = deck.find("[aggregates]");
  deck.replace(begin, end - begin, bar);
  deck = with(with(with(deck, "fraction = 0.28", "fraction = 0"), "count = 3000", "count = 2000"),
              "shortest_edge = 0.35", "shortest_edge = " + std::to_string(shortest_edge));
  const auto simulation = make_simulation(read_setup(Deck::parse(deck, "deck.toml"), "."));
  ModelOf<3> model = make_model(std::get<specimen::Specimen<3>>(*simulation->specimen()));
  model.block_material.assign(model.block_material.size(), 0);
  return model;
}

// Promise: cells of random shape are as permeable as the material: with transmissibilities along the lines of
// centroids neither tighter nor more open.
TEST(RandomCellsVerification, AreAsPermeableAsTheMaterial) {
  const PoreMaterial pores = [] {
    PoreMaterial m = dry_pores(1e-17);
    m.tortuosity = 0.0;
    return m;
  }();
  const double from = 1.01e5, to = 1e5;
  MoistBody<2> plane(bodies::tessellated(1500, kLong, 0.05, 5), pores, {.largest_step = 1e6});
  plane.moisture.start_with_pressure(from, kHot);
  const double in_plane =
      plane.steady_flow(from, to, kLong, plane.everywhere(kHot)) / 0.05 / darcy(1e-17, from, to);
  expect_known({"Permeability of 1,500 random cells in the plane over that of the material",
                "permeability of the material", "1"},
               in_plane, 1.0, 0.015);
  for (const double merged : {0.0, 0.35}) {
    MoistBody<3> space(bar_of_random_cells(merged), pores, {.largest_step = 1e6});
    space.moisture.start_with_pressure(from, kHot);
    const double in_space =
        space.steady_flow(from, to, kLong, space.everywhere(kHot)) / 0.0025 / darcy(1e-17, from, to);
    expect_known(
        {merged > 0.0
             ? "Permeability of 2,000 random cells in space, short edges merged, over that of the material"
             : "Permeability of 2,000 random cells in space over that of the material",
         "permeability of the material", "1"},
        in_space, 1.0, 0.015);
  }
}

// Promise: vapour diffuses at a total pressure that is the atmosphere's: order 1 in time, 2 in space.
TEST(DiffusionVerification, FollowsTheErrorFunction) {
  const double from = 2e3, to = 1e3, time = 100.0;
  const PoreMaterial pores = dry_pores(1e-40);
  const auto worst = [&](int cells, double step) {
    MoistBody<2> body = strip(cells, 0.4, pores, {.largest_step = step});
    body.moisture.start_with_pressure(from, kHot);
    body.moisture.apply(body.end(0.0), GivenPressure{Curve::constant(to)});
    body.moisture.advance(time, body.everywhere(kHot));
    const double diffusivity =
        pores.tortuosity * water::diffusivity_times_pressure(kHot) / water::kAtmosphere;
    double off = 0.0;
    const auto x = body.centroids();
    for (std::size_t c = 0; c < x.size(); ++c) {
      const double exact = to + (from - to) * std::erf(x[c][0] / (2.0 * std::sqrt(diffusivity * time)));
      off = std::max(off, std::abs(body.moisture.state().pressure[c] - exact));
    }
    return off;
  };
  expect_known_field({"Vapour that diffuses out of a half space", "error function", "Pa"}, worst(200, 1.0),
                     from - to, 2e-3 * (from - to));
  EXPECT_NEAR(worst(200, 8.0) / worst(200, 4.0), 2.0, 0.2);
}

// Promise: water above saturation flows out by the storage of its pores (Terzaghi's consolidation).
TEST(ConsolidationVerification, FollowsTheSeries) {
  PoreMaterial pores = dry_pores(1e-18);
  pores.tortuosity = 0.0;
  const double from = 3e6, to = 2e6, cold = 20.0;
  MoistBody<2> body = strip(50, kLong, pores, {.largest_step = 20.0});
  body.moisture.start_with_pressure(from, cold);
  body.moisture.apply(body.end(0.0), GivenPressure{Curve::constant(to)});
  const double density = water::liquid_density(cold);
  const double diffusivity =
      pores.permeability / (water::liquid_viscosity(cold) * pores.porosity * pores.compliance);
  const double time = 0.2 * kLong * kLong / diffusivity;
  body.moisture.advance(time, body.everywhere(cold));
  double off = 0.0;
  const auto x = body.centroids();
  for (std::size_t c = 0; c < x.size(); ++c) {
    double exact = to;
    for (int k = 1; k < 60; k += 2) {
      const double wave = 0.5 * k * std::numbers::pi;
      exact += (from - to) * 2.0 / wave * std::sin(wave * x[c][0] / kLong) * std::exp(-wave * wave * 0.2);
    }
    off = std::max(off, std::abs(body.moisture.state().pressure[c] - exact));
  }
  EXPECT_GT(density, 990.0);
  expect_known_field(
      {"Consolidation of pores that are full, after 0.2 of its time", "Terzaghi's series", "Pa"}, off,
      from - to, 0.005 * (from - to));
}

// Promise: along a bar that is hot at one end, the flow is that of the integral over the temperatures.
TEST(SteadyVapourVerification, FlowsAlongABarOfUnevenTemperature) {
  PoreMaterial pores = dry_pores(1e-16);
  pores.tortuosity = 0.0;
  pores.permeability_ratio = permeability_growing(0.008);
  const double from = 4e3, to = 2e3;  // so low that vapour is an ideal gas
  const auto temperature = [](double x) { return 100.0 + 200.0 * x / kLong; };
  const auto flow = [&](int cells) {
    MoistBody<2> body = strip(cells, kLong, pores, {.largest_step = 1e6, .largest_temperature_step = 1e3});
    body.moisture.start_with_pressure(from, kHot - 100.0);
    std::vector<double> hot;
    for (const auto& x : body.centroids()) hot.push_back(temperature(x[0]));
    // permeability remembers the highest temperature: none was above these
    Moisture& m = body.moisture;
    MoistureState state = m.state();
    state.temperature = state.highest_temperature = hot;
    m.go_on_from(state);
    return body.steady_flow(from, to, kLong, hot) / 0.01;
  };
  // (p1^2 - p2^2) / 2 = J R/M int mu T / K dx, by Simpson's rule
  double integral = 0.0;
  constexpr int kParts = 2000;
  for (int i = 0; i <= kParts; ++i) {
    const double t = temperature(kLong * i / kParts);
    const double weight = i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    integral += weight * water::vapour_viscosity(t) * (t + 273.15) / (1e-16 * pores.permeability_ratio(t)) *
                kLong / kParts / 3.0;
  }
  const double exact = (from * from - to * to) / (2.0 * water::kGasConstant * integral);
  expect_known({"Steady flow of vapour along a bar of 100 to 300 degC", "Simpson's rule", "kg/(m2 s)"},
               flow(80), exact, 0.005 * exact);
  EXPECT_GT(std::abs(flow(20) / exact - 1.0), 1.7 * std::abs(flow(40) / exact - 1.0));
}

/// A wall of high-strength concrete with its left face in a fire, cell by cell.
std::vector<double> heated(const MoistBody<2>& body, double minutes) {
  std::vector<double> found;
  for (const auto& x : body.centroids())
    found.push_back(20.0 + (20.0 * minutes) * std::exp(-x[0] / (0.004 * std::sqrt(minutes + 0.01))));
  return found;
}

void open_left(MoistBody<2>& body) {
  body.moisture.apply(body.end(0.0), MoistAir{0.018, Curve::constant(0.0138)});
}

// Promise: no water is lost but to rounding, while a wall dries, wets behind the front, and hydrates give
// water back.
TEST(Moisture, KeepsItsWaterToRounding) {
  MoistBody<2> body = strip(40, 0.12, high_strength());
  body.moisture.start_with_saturation(0.77, 20.0);
  open_left(body);
  for (int minute = 1; minute <= 20; ++minute) body.moisture.advance(60.0, heated(body, minute));
  const MoistureState& s = body.moisture.state();
  EXPECT_GT(s.ledger.left, 0.01 * s.ledger.at_start);
  EXPECT_GT(s.ledger.released, 0.001 * s.ledger.at_start);
  EXPECT_LT(std::abs(body.moisture.imbalance()), 1e-14 * s.ledger.at_start);
  std::vector<double> saturation;
  for (int c = 0; c < body.moisture.mesh().cell_count(); ++c)
    saturation.push_back(body.moisture.saturation(c));
  EXPECT_LT(saturation.front(), 0.01);
  EXPECT_GT(*std::ranges::max_element(saturation), 0.80);  // behind the front vapour condenses
  EXPECT_NEAR(saturation.back(), 0.77, 1e-3);
  const auto ratio = body.moisture.pressure_ratio();
  EXPECT_LT(*std::ranges::max_element(ratio), 1.1);
}

// Promise: a copy of the state is all that a field needs to go on bitwise as before, wherever it is broken
// off.
TEST(Moisture, GoesOnBitwiseFromItsState) {
  const auto wall = [] {
    MoistBody<2> body = strip(30, 0.12, high_strength());
    open_left(body);
    return body;
  };
  MoistBody<2> whole = wall();
  whole.moisture.start_with_saturation(0.77, 20.0);
  MoistureState state = whole.moisture.state();
  for (int minute = 1; minute <= 6; ++minute) {
    whole.moisture.advance(60.0, heated(whole, minute));
    MoistBody<2> part = wall();
    part.moisture.go_on_from(state);
    part.moisture.advance(60.0, heated(part, minute));
    state = part.moisture.state();
  }
  EXPECT_EQ(whole.moisture.state().pressure, state.pressure);
  EXPECT_EQ(whole.moisture.state().content, state.content);
  EXPECT_EQ(whole.moisture.state().steps, state.steps);
}

// Promise: a body without openings keeps its water, and a part of it without pores takes none.
TEST(Moisture, SealedBodiesKeepTheirWater) {
  MoistBody<2> body = strip(10, 0.1, high_strength());
  body.moisture.start_with_saturation(0.5, 20.0);
  const std::vector<double> before = body.moisture.state().content;
  body.moisture.advance(3600.0, body.everywhere(150.0));
  for (std::size_t c = 0; c < before.size(); ++c)
    EXPECT_NEAR(body.moisture.state().content[c] / before[c], 1.0, 1e-12);
}

// Promise: cells that leave take their water along, and the others dry where they are bared as a body that
// never had them.
TEST(Moisture, GoesOnWithoutCellsThatLeave) {
  const MoistAir air{0.018, Curve::constant(0.0138)};
  const auto reduced = [](MoistBody<2>& body) {
    std::vector<bool> stays(body.model.block_count(), true);
    stays[0] = false;
    const auto now = outline(body.model, body.geometry, stays);
    body.moisture.reduce_to(moisture_mesh(body.model, body.geometry, stays, now),
                            earlier_faces(body.outer, now));
  };
  auto body = strip(6, 0.06, high_strength()), rest = strip(5, 0.05, high_strength());
  for (auto* of : {&body, &rest}) {
    of->moisture.apply(of->end(0.0), air);
    of->moisture.start_with_saturation(0.7, 20.0);
  }
  reduced(body);
  EXPECT_NEAR(body.moisture.stored(), rest.moisture.stored(), 1e-12);
  body.moisture.advance(600.0, std::vector<double>(5, 150.0));
  rest.moisture.advance(600.0, std::vector<double>(5, 150.0));
  for (int c = 0; c < 5; ++c)
    EXPECT_NEAR(body.moisture.state().content[c], rest.moisture.state().content[c], 1e-8);

  auto cracked = strip(6, 0.06, high_strength());
  cracked.moisture.apply(cracked.end(0.0), air);
  cracked.moisture.start_with_saturation(0.7, 20.0);
  cracked.moisture.set_cracks({{0, 20e-6, {20e-6, 20e-6}}, {3, 10e-6, {10e-6, 10e-6}}});
  cracked.moisture.advance(300.0, cracked.everywhere(120.0));
  const MoistureState before = cracked.moisture.state();
  const double leaves = cracked.moisture.mesh().volume[0] * before.content[0] + before.crack_water[0];
  const double stored = cracked.moisture.stored();
  reduced(cracked);
  const MoistureState& now = cracked.moisture.state();
  EXPECT_NEAR(now.ledger.removed, leaves, 1e-12 * stored);
  ASSERT_EQ(now.cracks.size(), 1U);
  EXPECT_EQ(now.crack_water[0], before.crack_water[1]);
  EXPECT_EQ(now.pressure[0], before.pressure[1]);
  cracked.moisture.advance(300.0, std::vector<double>(5, 160.0));
  EXPECT_LT(std::abs(cracked.moisture.imbalance()), 1e-14 * stored + 1e-16);
  EXPECT_GT(now.ledger.left, before.ledger.left);
}

TEST(Moisture, WhatIsOutOfRangeIsRefused) {
  MoistBody<2> body = strip(2, 0.1, high_strength());
  EXPECT_THROW(body.moisture.start_with_saturation(1.1, 20.0), Error);
  EXPECT_THROW(body.moisture.start_with_saturation(0.0, 20.0), Error);
  EXPECT_THROW(body.moisture.start_with_pressure(0.0, 20.0), Error);
  EXPECT_THROW(body.moisture.apply({0}, MoistAir{-1.0}), Error);
  EXPECT_THROW(strip(2, 0.1, high_strength(), {.largest_step = 0.0}), Error);
}

}  // namespace
}  // namespace pyroclast
