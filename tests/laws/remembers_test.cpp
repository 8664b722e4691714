#include "pyroclast/laws/remembers.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "table_2.hpp"

namespace pyroclast {
namespace {

/// Returns the numbers of a list.
template <class List>
std::vector<double> numbers(const List& list) {
  std::vector<double> all;
  List::each([&](const auto&, const auto& number) { all.push_back(number); }, list);
  return all;
}

/// Returns parameters whose strengths are multiplied.
template <class Properties>
Properties with_strengths_times(Properties p, double factor) {
  Properties::each(
      [&](const auto& info, double& number) {
        if (info.role == Role::strength) number *= factor;
      },
      p);
  return p;
}

template <class Law, class Properties>
void expect_weakened_as_derived(const Properties& p) {
  for (const double left : {1.0, 0.9, 0.37}) {
    const auto weakened = numbers(Law::template weakened<double>(Law::derive(p), left));
    const auto derived = numbers(Law::derive(with_strengths_times(p, left)));
    ASSERT_EQ(weakened.size(), derived.size());
    for (std::size_t i = 0; i < derived.size(); ++i)
      EXPECT_NEAR(weakened[i], derived[i], 1e-12 * std::abs(derived[i])) << i << " at " << left;
  }
}

TEST(Remembers, AShareOfTheStrengthsIsWhatWeakerStrengthsGive) {
  expect_weakened_as_derived<Cohesive>(mortar_contact());
  auto p = mixed_mode_contact();
  for (const auto softening : {MixedMode::Softening::bilinear, MixedMode::Softening::exponential,
                               MixedMode::Softening::linear, MixedMode::Softening::tailed}) {
    p.softening = softening;
    expect_weakened_as_derived<MixedMode>(p);
  }
}

/// Contact point of the paper's mortar that remembers, at one share of cracks after the other.
struct Point {
  using Law = CohesiveWithMemory;

  Point() {
    static_cast<Cohesive::Properties<double>&>(properties) = mortar_contact();
    properties.closing_pressure = 2.5e6;
  }

  /// Goes to an opening with the share A that its temperature brings. Returns the normal traction.
  double go(double cracks, double opening) {
    properties.cracks = cracks;
    const auto r = Law::update<2, double>(Law::derive(properties), opening, {}, internals, losses);
    return r.normal_traction;
  }
  /// Returns the opening at which a closed point presses, m.
  double opening_at(double pressure) const { return -pressure / properties.normal_stiffness; }

  Law::Properties<double> properties;
  Law::Internals<2, double> internals;
  Law::Losses<double> losses{};
};

TEST(Remembers, APointWithoutPressureLosesAllOfA) {
  Point point;
  point.go(0.1, 0.0);
  point.go(0.22, 0.0);
  EXPECT_NEAR(point.internals.lost, 0.22, 1e-15);
  const double begins = 0.78 * 2.5e6 / point.properties.normal_stiffness;
  EXPECT_NEAR(point.go(0.22, begins), 0.78 * 2.5e6, 1.0);
  EXPECT_EQ(point.internals.tension_damage, 0.0);
}

TEST(Remembers, PressureSparesAPointInProportionUpToPClose) {
  for (const double pressure : {0.0, 1e6, 2.5e6, 10e6}) {
    Point point;
    point.go(0.0, point.opening_at(pressure));
    point.go(0.22, point.opening_at(pressure));
    EXPECT_NEAR(point.internals.lost, 0.22 * std::max(0.0, 1.0 - pressure / 2.5e6), 1e-12) << pressure;
  }
}

TEST(Remembers, OnlyTheFirstUpdateAfterAChangeCounts) {
  Point once, often;
  for (Point* point : {&once, &often}) point->go(0.0, point->opening_at(1e6));
  once.go(0.22, once.opening_at(0.0));
  for (int i = 100; i >= 0; --i) often.go(0.22, often.opening_at(1e4 * i));
  EXPECT_EQ(once.internals.lost, often.internals.lost);
}

TEST(Remembers, CoolingOpensTheCracksAgainOnceAndReheatingDoesNothing) {
  Point point;
  point.go(0.2, 0.0);
  point.go(0.05, 0.0);
  EXPECT_NEAR(point.internals.lost, 0.35, 1e-15);
  point.go(0.2, 0.0);
  point.go(0.1, 0.0);
  EXPECT_NEAR(point.internals.lost, 0.35, 1e-15);
  point.go(0.0, 0.0);
  EXPECT_NEAR(point.internals.lost, 0.4, 1e-15);
  point.go(0.25, 0.0);
  EXPECT_NEAR(point.internals.lost, 0.45, 1e-15);
}

TEST(Remembers, PressureSparesAPointOnCoolingToo) {
  Point point;
  point.go(0.2, 0.0);
  point.go(0.2, point.opening_at(1.25e6));
  point.go(0.0, point.opening_at(1.25e6));
  EXPECT_NEAR(point.internals.lost, 0.3, 1e-12);
}

}  // namespace
}  // namespace pyroclast
