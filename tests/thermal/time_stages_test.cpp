#include "pyroclast/thermal/time_stages.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "known.hpp"

namespace pyroclast {
namespace {

std::vector<TimeStage> time_stages(HeatScheme scheme, std::int64_t count) {
  const TimeStages stages(scheme, count);
  EXPECT_EQ(stages.count(), count);
  std::vector<TimeStage> all;
  for (std::int64_t j = 0; j < count; ++j) all.push_back(stages[j]);
  return all;
}

/// Value after one step of dy/dt = rate(t) y with y(0) = 1.
template <class Rate>
double advance(const std::vector<TimeStage>& stages, double step, Rate rate) {
  double increment = 0.0, before = 0.0;
  const double first = rate(0.0);
  for (const auto& stage : stages) {
    const double next =
        stage.previous * increment + stage.before * before +
        step * (stage.rate * rate(stage.begin * step) * (1.0 + increment) + stage.first_rate * first);
    before = increment;
    increment = next;
  }
  return 1.0 + increment;
}

TEST(TimeStages, EndAtTheEndOfTheStep) {
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping})
    for (int count : {3, 7, 51}) EXPECT_NEAR(time_stages(scheme, count).back().end, 1.0, 1e-12) << count;
}

TEST(TimeStages, WeightsMakeUpTheIncrementOfTheStep) {
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping}) {
    const auto stages = time_stages(scheme, 9);
    // dy/dt = 1 + t + t²: the increment by the recurrence and by the weights must be one.
    const auto rate = [](double t) { return 1.0 + t + t * t; };
    double increment = 0.0, before = 0.0, weighted = 0.0;
    for (const auto& stage : stages) {
      const double next = stage.previous * increment + stage.before * before +
                          stage.rate * rate(stage.begin) + stage.first_rate * rate(0.0);
      before = increment;
      increment = next;
      weighted += stage.weight * rate(stage.begin);
    }
    EXPECT_NEAR(weighted, increment, 1e-13);
  }
}

TEST(TimeStagesVerification, SuperTimeSteppingIsOfSecondOrder) {
  // dy/dt = -(1 + t) y
  const auto error = [](double step) {
    const double exact = std::exp(-step - 0.5 * step * step);
    return std::abs(
        advance(time_stages(HeatScheme::super_time_stepping, 5), step, [](double t) { return -(1.0 + t); }) -
        exact);
  };
  // The error of one step goes with its cube.
  expect_known({"Order of the error of one super time step",
                "Meyer, Balsara and Aslam 2014: second order, so 3 a step", "1"},
               std::log2(error(0.02) / error(0.01)), 3.0, 0.1);
}

TEST(TimeStages, AreStableUpToTheRatioThatTheyAreChosenFor) {
  for (const auto scheme : {HeatScheme::euler, HeatScheme::super_time_stepping})
    for (double ratio : {0.1, 1.0, 2.5, 10.0, 100.0, 1000.0}) {
      const auto stages = time_stages(scheme, fewest_stages(scheme, ratio));
      // The stable step of forward Euler is 2 over the fastest rate; slower ones must decay too.
      for (double part = 0.001; part <= 1.0; part += 0.001)
        ASSERT_LE(std::abs(advance(stages, 1.0, [&](double) { return -2.0 * ratio * part; })), 1.0 + 1e-12)
            << ratio << " " << part;
    }
}

TEST(TimeStages, OfEulerMayBeMoreThanMemoryHolds) {
  const auto count = fewest_stages(HeatScheme::euler, 1e13);
  EXPECT_EQ(count, 10'000'000'000'000);
  const TimeStages stages(HeatScheme::euler, count);
  EXPECT_EQ(stages[count / 2].begin, 0.5);
  EXPECT_EQ(stages[count - 1].end, 1.0);
}

TEST(TimeStages, SuperTimeSteppingNeedsTwiceTheRootOfTheStepsOfEuler) {
  EXPECT_EQ(fewest_stages(HeatScheme::euler, 400.0), 400);
  EXPECT_LE(fewest_stages(HeatScheme::super_time_stepping, 400.0), 41);
}

}  // namespace
}  // namespace pyroclast
