#include "pyroclast/thermal/gap_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "advance.hpp"
#include "bodies.hpp"
#include "copy_state.hpp"
#include "known.hpp"
#include "messages.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

// of its own, as tests of a module are one unit
namespace pyroclast::gap_conduction_test {
namespace {

constexpr double kConductivity = 1.6;   // W/(m K)
constexpr double kCapacity = 2.16e6;    // J/(m3 K)
constexpr double kJumpDistance = 2e-7;  // m
constexpr double kNever = 1e-9;         // W/(m K): as good as none

/// Of the gas alone, whose conductivity is such that a gap of 1 m would have 1 W/(m2 K).
GapHeat gas_alone() {
  return {.bridges = 0.0,
          .gas_conductivity = Curve::constant(1.0),
          .jump_distance = kJumpDistance,
          .emissivity = 0.0,
          .split_below = 1e4};
}

/// A contact through which the gas alone conducts with h.
ContactGap conducting(double h) {
  return {1.0, 1.0 / h - kJumpDistance};
}

GapHeat air_and_radiation() {
  return {.bridges = 5e4,
          .gas_conductivity = builtin_curves().at("air_conductivity").curve,
          .jump_distance = kJumpDistance,
          .emissivity = 0.9,
          .split_below = 1e4};
}

HeatParameters parameters(std::optional<GapHeat> gaps) {
  auto p = heat_parameters({20.0, 1200.0}, 20.0, 20.0, 1e4);
  p.gaps = std::move(gaps);
  return p;
}

/// Of every contact: open where the predicate says so of its place, else intact.
template <int Dim>
std::vector<ContactGap> gaps_where(const ModelOf<Dim>& model, const ContactGap& gap,
                                   const std::function<bool(const Contact<Dim>&, const Vec<Dim>&)>& is_open) {
  std::vector<ContactGap> gaps;
  for (const auto& c : model.contacts)
    gaps.push_back(is_open(c, model.position[c.a]) ? gap : ContactGap{0.0, 0.0});
  return gaps;
}

/// Contacts across a plane x = const.
template <int Dim>
auto across_x(double x) {
  return [x](const Contact<Dim>& c, const Vec<Dim>& at) {
    return std::abs(c.normal[0]) > 0.99 && std::abs(at[0] - x) < 1e-9;
  };
}

template <int Dim>
double temperature_at(const ModelOf<Dim>& model, const Conduction<Dim>& heat, const Vec<Dim>& x,
                      bool is_right) {
  const auto temperature = heat.gridpoint_temperatures(0.0);
  for (int b = 0; b < model.block_count(); ++b) {
    double centre = 0.0;
    const int first = model.block_gridpoints[b], last = model.block_gridpoints[b + 1];
    for (int g = first; g < last; ++g) centre += model.position[g][0] / (last - first);
    if ((centre > x[0]) != is_right) continue;
    for (int g = first; g < last; ++g)
      if (norm(model.position[g] - x) < 1e-9) return temperature[g];
  }
  ADD_FAILURE() << "no gridpoint there";
  return 0.0;
}

template <int Dim>
void hold_ends(Conduction<Dim>& heat, double length, double left, double right) {
  heat.prescribe_temperature(heat.faces(on_plane<Dim>(0, 0.0, 1e-9)), Curve::constant(left));
  heat.prescribe_temperature(heat.faces(on_plane<Dim>(0, length, 1e-9)), Curve::constant(right));
}

// ---- Closed forms ----------------------------------------------------------------------------------------

TEST(GapConductionVerification, TwoWallsWithAGapConductAsResistancesInSeries) {
  constexpr double L = 0.05, h = 80.0, hot = 500.0, cold = 20.0;
  const auto model = plane_body({.blocks = {10, 3}, .size = {2.0 * L, 0.03}});
  auto p = parameters(gas_alone());
  p.largest_change = 500.0;
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, p);
  heat.set_gaps(gaps_where<2>(model, conducting(h), across_x<2>(L)));
  hold_ends(heat, 2.0 * L, hot, cold);
  ASSERT_TRUE(advance_to_steady(heat, 1e-14, 1e8));
  const double flux = (hot - cold) / (2.0 * L / kConductivity + 1.0 / h);
  const double drop =
      temperature_at<2>(model, heat, {{L, 0.01}}, false) - temperature_at<2>(model, heat, {{L, 0.01}}, true);
  expect_known({"Two walls with a gap: steady heat flux", "(T_1 - T_2) / (2 L / k + 1 / h)", "W/m2"},
               h * drop, flux, 1e-9 * flux);
  expect_known({"Two walls with a gap: temperature of the hot wall at the gap", "T_1 - q L / k", "degC"},
               temperature_at<2>(model, heat, {{L, 0.02}}, false), hot - flux * L / kConductivity, 1e-8);
}

TEST(GapConductionVerification, CracksInSeriesAddTheirResistances) {
  constexpr double length = 0.08, hot = 300.0, cold = 100.0;
  const auto model = solid_body({.blocks = {4, 2, 2}, .size = {length, 0.04, 0.04}});
  auto p = parameters(gas_alone());
  p.largest_change = 500.0;
  Conduction<3> heat(model, {constant_material(kConductivity, kCapacity)}, p);
  std::vector<ContactGap> gaps(model.contacts.size());
  const std::vector<double> conductances{50.0, 200.0, 800.0};
  for (int i = 0; i < model.contact_count(); ++i)
    for (int crack = 0; crack < 3; ++crack)
      if (across_x<3>(0.02 * (crack + 1))(model.contacts[i], model.position[model.contacts[i].a]))
        gaps[i] = conducting(conductances[crack]);
  heat.set_gaps(gaps);
  hold_ends(heat, length, hot, cold);
  ASSERT_TRUE(advance_to_steady(heat, 1e-14, 1e8));
  const double drop = temperature_at<3>(model, heat, {{0.02, 0.02, 0.0}}, false) -
                      temperature_at<3>(model, heat, {{0.02, 0.02, 0.0}}, true);
  const double flux = (hot - cold) / (length / kConductivity + 1.0 / 50.0 + 1.0 / 200.0 + 1.0 / 800.0);
  expect_known(
      {"Three cracks in series, tetrahedra: steady heat flux", "(T_1 - T_2) / (L / k + sum 1 / h)", "W/m2"},
      50.0 * drop, flux, 1e-9 * flux);
}

TEST(GapConductionVerification, AGapThatRadiatesPassesTheDifferenceOfFourthPowers) {
  constexpr double L = 0.05, hot = 900.0, cold = 20.0, emissivity = 0.9;
  const auto model = plane_body({.blocks = {10, 1}, .size = {2.0 * L, 0.01}});
  GapHeat law = gas_alone();
  law.bridges = 1e6;  // of the contacts that are intact
  law.gas_conductivity = Curve::constant(kNever);
  law.emissivity = emissivity;
  auto p = parameters(law);
  p.largest_change = 1000.0;
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, p);
  heat.set_gaps(gaps_where<2>(model, {1.0, 0.01}, across_x<2>(L)));
  hold_ends(heat, 2.0 * L, hot, cold);
  ASSERT_TRUE(advance_to_steady(heat, 1e-13, 1e8));
  // q = s (T_a^4 - T_b^4) with T_a = T_1 - q L / k, T_b = T_2 + q L / k, by bisection
  const auto excess = [&](double q) {
    const double a = hot + 273.15 - q * L / kConductivity, b = cold + 273.15 + q * L / kConductivity;
    return 5.670374419e-8 / (2.0 / emissivity - 1.0) * (std::pow(a, 4) - std::pow(b, 4)) - q;
  };
  double low = 0.0, high = 0.5 * (hot - cold) * kConductivity / L;
  for (int i = 0; i < 200; ++i) (excess(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const double face = temperature_at<2>(model, heat, {{L, 0.0}}, false);
  expect_known({"Two walls with a gap that radiates: steady heat flux",
                "series of L / k and s (T_a^4 - T_b^4) / (2 / e - 1), bisected", "W/m2"},
               (hot - face) * kConductivity / L, low, 1e-6 * low);
}

/// Temperatures over the depth of a slab with one gap, heated on its left by convection, after a time:
/// explicit finite volumes of even width, as fine as one likes. The gap lies between cells and passes heat as
/// a function of the temperatures of its two faces, which are half a cell from the cells' middles.
class Slab {
 public:
  Slab(double length, int cells, double gap_at)
      : dx_(length / cells), gap_(static_cast<int>(std::lround(gap_at / dx_))), T_(cells, 20.0) {}

  /// \param conductance  W/(m2 K), of the temperatures of both faces, °C
  void heat(double until, double coefficient, double gas,
            const std::function<double(double, double)>& conductance) {
    const double dt = 0.4 * dx_ * dx_ * kCapacity / kConductivity;
    const auto steps = static_cast<int>(std::ceil(until / dt));
    const double half = 0.5 * dx_ / kConductivity;
    std::vector<double> flux(T_.size() + 1, 0.0);
    for (int step = 0; step < steps; ++step) {
      flux[0] = (gas - T_[0]) / (1.0 / coefficient + half);
      for (int i = 1; i < static_cast<int>(T_.size()); ++i) flux[i] = (T_[i - 1] - T_[i]) / (2.0 * half);
      double& q = flux[gap_];
      q = last_;
      for (int i = 0; i < 20; ++i) {  // of the faces, which depend on the flux
        const double a = T_[gap_ - 1] - q * half, b = T_[gap_] + q * half;
        q = (T_[gap_ - 1] - T_[gap_]) / (2.0 * half + 1.0 / conductance(a, b));
      }
      last_ = q;
      for (std::size_t i = 0; i < T_.size(); ++i)
        T_[i] += until / steps * (flux[i] - flux[i + 1]) / (kCapacity * dx_);
    }
  }
  /// At the middle of the cell to the right of a place.
  double right_of(double x) const { return T_[static_cast<std::size_t>(std::lround(x / dx_))]; }
  double left_of(double x) const { return T_[static_cast<std::size_t>(std::lround(x / dx_)) - 1]; }

 private:
  double dx_;
  int gap_;
  std::vector<double> T_;
  double last_ = 0.0;
};

TEST(GapConductionVerification, ASlabWithACrackHeatsAsInOneDimension) {
  constexpr double length = 0.1, crack = 0.03, until = 3600.0, coefficient = 50.0, gas = 800.0, w = 3e-4;
  const auto model = plane_body({.blocks = {50, 2}, .size = {length, 0.004}});
  auto p = parameters(air_and_radiation());
  p.largest_change = 5.0;
  p.largest_step = 20.0;
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, p);
  heat.set_gaps(gaps_where<2>(model, {1.0, w}, across_x<2>(crack)));
  heat.apply(heat.faces(on_plane<2>(0, 0.0, 1e-9)),
             Convection{Curve::constant(coefficient), Curve::constant(gas)});
  advance_to(heat, until);
  Slab slab(length, 200, crack);
  slab.heat(until, coefficient, gas, [&](double a, double b) {
    const double K = 0.5 * (a + b) + 273.15, A = a + 273.15, B = b + 273.15;
    const double air = 0.0241 * std::pow(K / 273.0, 1.5) * 467.0 / (K + 194.0);
    return air / (w + 2e-7) + 5.670374419e-8 / (2.0 / 0.9 - 1.0) * (A * A + B * B) * (A + B);
  });
  double worst = 0.0;
  for (int i = 1; i < 50; ++i) {
    const double x = 0.002 * i;
    const double there = 0.5 * (slab.left_of(x) + slab.right_of(x));
    if (std::abs(x - crack) > 1e-9)
      worst = std::max(worst, std::abs(temperature_at<2>(model, heat, {{x, 0.0}}, true) - there));
  }
  const double drop = temperature_at<2>(model, heat, {{crack, 0.002}}, false) -
                      temperature_at<2>(model, heat, {{crack, 0.002}}, true);
  EXPECT_GT(drop, 20.0);
  expect_known_field({"A slab with a crack of 0.3 mm in hot gas: temperatures after 1 h",
                      "explicit finite volumes in one dimension, cells of 0.5 mm", "K"},
                     worst, gas - 20.0, 0.3);
}

// ---- Limits ----------------------------------------------------------------------------------------------

void expose_to_fire(Conduction<2>& heat) {
  pyroclast::expose_to_fire(heat, heat.faces(on_plane<2>(0, 0.0, 1e-9)));
}

ModelOf<2> irregular() {
  return plane_body({.blocks = {12, 8}, .size = {0.06, 0.04}, .jitter = 0.25});
}

/// Every contact damaged a little, as if the body had cracked finely all over.
std::vector<ContactGap> hairs(const ModelOf<2>& model, double opening) {
  return std::vector<ContactGap>(model.contacts.size(), {1.0, opening});
}

TEST(GapConduction, ContactsThatConductWellChangeNoBit) {
  const auto model = irregular();
  const auto run = [&](const std::optional<GapHeat>& law) {
    Conduction<2> heat(model, {moist_concrete()}, parameters(law));
    expose_to_fire(heat);
    if (law) heat.set_gaps(hairs(model, 1e-7));
    advance_to(heat, 600.0);
    return heat.state();
  };
  EXPECT_TRUE(run(std::nullopt) == run(air_and_radiation()));
}

TEST(GapConduction, ManySplitNodesThatConductWellComeToTheSameTemperatures) {
  const auto model = irregular();
  GapHeat law = gas_alone();
  law.split_below = 1e9;
  const auto finely = [](const std::optional<GapHeat>& gaps) {
    auto p = parameters(gaps);
    p.largest_change = 1.0;
    return p;
  };
  std::vector<double> differences;
  for (const double h : {1e4, 1e5, 1e6}) {
    Conduction<2> heat(model, {moist_concrete()}, finely(law));
    heat.set_gaps(std::vector<ContactGap>(model.contacts.size(), conducting(h)));
    EXPECT_EQ(heat.nodes().count(), model.gridpoint_count());
    expose_to_fire(heat);
    advance_to(heat, 600.0);
    Conduction<2> today(model, {moist_concrete()}, finely(std::nullopt));
    expose_to_fire(today);
    advance_to(today, 600.0);
    const auto with = heat.gridpoint_temperatures(0.0), without = today.gridpoint_temperatures(0.0);
    double worst = 0.0;
    for (std::size_t g = 0; g < with.size(); ++g) worst = std::max(worst, std::abs(with[g] - without[g]));
    differences.push_back(worst);
  }
  EXPECT_LT(differences[1], 0.2 * differences[0]);
  EXPECT_LT(differences[2], 0.2 * differences[1]);
  EXPECT_LT(differences[2], 0.05);
}

// ---- Splitting and merging -------------------------------------------------------------------------------

TEST(GapConduction, NoHeatIsLostWhereNodesSplitAndMerge) {
  const auto model = irregular();
  Conduction<2> heat(model, {moist_concrete()}, parameters(air_and_radiation()));
  expose_to_fire(heat);
  advance_to(heat, 300.0);
  double stored = heat.ledger().stored;
  const int joined = heat.nodes().count();
  const auto before = heat.gridpoint_temperatures(0.0);
  heat.set_gaps(hairs(model, 5e-4));
  EXPECT_EQ(heat.nodes().count(), model.gridpoint_count());
  EXPECT_EQ(heat.gridpoint_temperatures(0.0), before) << "parts take their temperature along";
  EXPECT_NEAR(heat.ledger().stored, stored, 1e-12 * stored);
  advance_to(heat, 900.0);
  EXPECT_NEAR(heat.ledger().error(), 0.0, 1e-10 * heat.ledger().stored);
  stored = heat.ledger().stored;
  const auto apart = heat.gridpoint_temperatures(0.0);
  heat.set_gaps(hairs(model, 0.0));
  EXPECT_EQ(heat.nodes().count(), joined);
  EXPECT_NEAR(heat.ledger().stored, stored, 1e-12 * stored);
  const auto together = heat.gridpoint_temperatures(0.0);
  double largest = 0.0;
  for (std::size_t g = 0; g < apart.size(); ++g)
    largest = std::max(largest, std::abs(apart[g] - together[g]));
  EXPECT_GT(largest, 5.0) << "the cracks held heat back";
  advance_to(heat, 1200.0);
  EXPECT_NEAR(heat.ledger().error(), 0.0, 1e-10 * heat.ledger().stored);
}

TEST(GapConduction, WhatMergesHasTheMeanTemperatureByCapacity) {
  const auto model = plane_body({.blocks = {2, 1},
                                 .size = {0.02, 0.01},
                                 .material = [](const Vec<2>& x) { return x[0] < 0.01 ? 0 : 1; }},
                                2);
  Conduction<2> heat(model, {constant_material(1.0, 1e6), constant_material(1.0, 3e6)},
                     parameters(gas_alone()));
  heat.set_gaps(hairs(model, 1.0));
  std::vector<double> temperature;
  for (int node = 0; node < heat.nodes().count(); ++node)
    temperature.push_back(heat.nodes().gridpoint[node] < model.block_gridpoints[1] ? 500.0 : 100.0);
  heat.set_temperature(temperature);
  heat.set_gaps(hairs(model, 0.0));
  EXPECT_NEAR(temperature_at<2>(model, heat, {{0.01, 0.0}}, true), (500.0 + 3.0 * 100.0) / 4.0, 1e-9);
  EXPECT_EQ(temperature_at<2>(model, heat, {{0.01, 0.0}}, false),
            temperature_at<2>(model, heat, {{0.01, 0.0}}, true));
  EXPECT_EQ(temperature_at<2>(model, heat, {{0.0, 0.0}}, true), 500.0);
}

TEST(GapConduction, HeatGoesAroundTheTipOfACrack) {
  const auto model = plane_body({.blocks = {2, 4}, .size = {0.02, 0.04}});
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, parameters(gas_alone()));
  const int joined = heat.nodes().count();
  std::vector<ContactGap> gaps(model.contacts.size());
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& c = model.contacts[i];
    const auto& other = model.contacts[i ^ 1];  // the two contacts of a face stand together
    const double middle = 0.5 * (model.position[c.a][1] + model.position[other.a][1]);
    if (std::abs(c.normal[0]) > 0.99 && middle < 0.02) gaps[i] = {1.0, 1.0};
  }
  heat.set_gaps(gaps);
  // the crack runs from y = 0 to its tip at 0.02, around which intact contacts lead
  EXPECT_EQ(heat.nodes().count(), joined + 2);
  EXPECT_EQ(temperature_at<2>(model, heat, {{0.01, 0.02}}, false),
            temperature_at<2>(model, heat, {{0.01, 0.02}}, true));
  EXPECT_NEAR(heat.gaps()->area(), 0.015, 1e-12) << "half of the second face ends at the tip";
}

TEST(GapConduction, AContactJoinsOnlyAboveTwiceWhatItPartsBelow) {
  const auto model = plane_body({.blocks = {2, 1}, .size = {0.02, 0.01}});
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, parameters(gas_alone()));
  const int joined = heat.nodes().count();
  const auto nodes_at = [&](double h) {
    heat.set_gaps(std::vector<ContactGap>(model.contacts.size(), conducting(h)));
    return heat.nodes().count();
  };
  EXPECT_EQ(nodes_at(1.5e4), joined);
  EXPECT_EQ(nodes_at(0.9e4), joined + 2);
  EXPECT_EQ(nodes_at(1.5e4), joined + 2);
  EXPECT_EQ(nodes_at(2.1e4), joined);
  EXPECT_EQ(nodes_at(1.5e4), joined);
}

TEST(GapConduction, BoundariesActOnBothSidesOfACrackThatReachesThem) {
  const auto model = plane_body({.blocks = {3, 2}, .size = {0.03, 0.02}});
  const auto lengthwise = gaps_where<2>(
      model, {1.0, 1.0}, [](const Contact<2>& c, const Vec<2>&) { return std::abs(c.normal[1]) > 0.99; });
  const auto run = [&](bool parts) {
    Conduction<2> heat(model, {constant_material(kConductivity, kCapacity)}, parameters(gas_alone()));
    const auto right = heat.faces(on_plane<2>(0, 0.03, 1e-9));
    heat.apply(right, Convection{Curve::constant(30.0), Curve::constant(20.0)});
    heat.prescribe_temperature(heat.faces(on_plane<2>(0, 0.0, 1e-9)), Curve::constant(300.0));
    advance_to(heat, 30.0);
    if (parts) heat.set_gaps(lengthwise);
    advance_to(heat, 600.0);
    EXPECT_NEAR(heat.ledger().error(), 0.0, 1e-11 * heat.ledger().stored);
    return std::pair{heat.gridpoint_temperatures(0.0), heat.ledger().boundary.convection};
  };
  // heat runs along the crack, so that it is as if it were not there
  const auto [with, given] = run(true);
  const auto [without, given_without] = run(false);
  for (std::size_t g = 0; g < with.size(); ++g) EXPECT_NEAR(with[g], without[g], 1e-9);
  EXPECT_NEAR(given, given_without, 1e-9 * std::abs(given));
}

TEST(GapConduction, ContactsWithBearingsAreClosedToHeat) {
  const auto model = plane_body({.blocks = {3, 1},
                                 .size = {0.03, 0.01},
                                 .material = [](const Vec<2>& x) { return x[0] < 0.01 ? 1 : 0; }},
                                2);
  Conduction<2> heat(model, {constant_material(kConductivity, kCapacity), std::nullopt},
                     parameters(gas_alone()));
  heat.set_gaps(hairs(model, 0.1));
  const auto conductances = heat.gaps()->conductances(heat.gridpoint_temperatures(20.0));
  for (int i = 0; i < model.contact_count(); ++i)
    EXPECT_EQ(conductances[i] > 0.0, model.position[model.contacts[i].a][0] > 0.015) << i;
  EXPECT_NEAR(heat.gaps()->area(), 0.01, 1e-12);
}

// ---- State -----------------------------------------------------------------------------------------------

TEST(GapConduction, IsBitwiseTheSameOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    const auto model = plane_body({.blocks = {60, 60}, .size = {0.15, 0.15}, .jitter = 0.3});
    Conduction<2> heat(model, {moist_concrete()}, parameters(air_and_radiation()),
                       std::make_shared<Team>(threads, WhenCrowded::stay));
    expose_to_fire(heat);
    heat.set_gaps(hairs(model, 1e-4));
    EXPECT_GE(heat.gaps()->parts().size(), 2 * fewest_for_threads);
    advance_to(heat, 10.0);
    return heat.temperature();
  };
  const auto one = run(1), three = run(3);
  EXPECT_EQ(one, three);
}

TEST(GapConduction, GoesOnToTheBitFromAStateWithSplitNodes) {
  const auto model = irregular();
  const auto cracked = gaps_where<2>(
      model, {1.0, 2e-4}, [](const Contact<2>&, const Vec<2>& at) { return at[0] > 0.01 && at[0] < 0.04; });
  const auto made = [&] {
    auto heat = std::make_unique<Conduction<2>>(
        model, std::vector<std::optional<HeatMaterial>>{moist_concrete()}, parameters(air_and_radiation()));
    expose_to_fire(*heat);
    return heat;
  };
  const auto first = made(), second = made();
  first->set_gaps(cracked);
  advance_to(*first, 200.0);
  std::int64_t stages = 3;
  EXPECT_FALSE(first->advance_step(300.0, stages));
  copy_state(*first, *second);
  for (auto* heat : {first.get(), second.get()}) {
    advance_to(*heat, 300.0);
    heat->set_gaps(hairs(model, 0.0));
    advance_to(*heat, 400.0);
  }
  EXPECT_TRUE(first->state() == second->state());
}

// ---- Errors ----------------------------------------------------------------------------------------------

TEST(GapConduction, RefusesWhatIsNoGap) {
  const auto model = plane_body({.blocks = {2, 1}, .size = {0.02, 0.01}});
  const auto material = constant_material(kConductivity, kCapacity);
  Conduction<2> heat(model, {material}, parameters(gas_alone()));
  expect_in("1 gaps are given for 2 contacts", message([&] { heat.set_gaps({{0.0, 0.0}}); }));
  expect_in("damage is 1.5", message([&] { heat.set_gaps({{0.0, 0.0}, {1.5, 0.0}}); }));
  expect_in("opening [m] is -1", message([&] { heat.set_gaps({{0.0, -1.0}, {0.5, 0.0}}); }));
  Conduction<2> without(model, {material}, parameters(std::nullopt));
  expect_in("nothing says how heat crosses gaps", message([&] { without.set_gaps(hairs(model, 0.0)); }));
}

TEST(GapConduction, RefusesALawThatIsNone) {
  const auto model = plane_body({.blocks = {2, 1}, .size = {0.02, 0.01}});
  const auto with = [&](const std::function<void(GapHeat&)>& change) {
    GapHeat law = air_and_radiation();
    change(law);
    return message(
        [&] { Conduction<2>(model, {constant_material(kConductivity, kCapacity)}, parameters(law)); });
  };
  expect_in("bridges [W/(m2 K)] is -1", with([](GapHeat& law) { law.bridges = -1.0; }));
  expect_in("jump distance [m] is 0", with([](GapHeat& law) { law.jump_distance = 0.0; }));
  expect_in("emissivity is 1.1", with([](GapHeat& law) { law.emissivity = 1.1; }));
  expect_in("split [W/(m2 K)] is 0", with([](GapHeat& law) { law.split_below = 0.0; }));
  expect_in("does not cover", with([](GapHeat& law) {
              law.gas_conductivity = Curve::table({20.0, 500.0}, {0.02, 0.05}, temperature_axis());
            }));
  expect_in("falls to 0", with([](GapHeat& law) { law.gas_conductivity = Curve::constant(0.0); }));
  expect_in("curve of the temperature", with([](GapHeat& law) {
              law.gas_conductivity = Curve::table({0.0, 5000.0}, {0.02, 0.05}, time_axis());
            }));
}

}  // namespace
}  // namespace pyroclast::gap_conduction_test
