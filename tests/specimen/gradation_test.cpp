#include "pyroclast/specimen/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "examples.hpp"
#include "known.hpp"
#include "pyroclast/specimen/stone.hpp"

namespace pyroclast::specimen {
namespace {

double total_area(const std::vector<Stone<2>>& stones) {
  double sum = 0;
  for (const Stone<2>& stone : stones) sum += extent(stone);
  return sum;
}

TEST(GradationVerification, FullerRunsFromNothingAtTheSmallestToAllAtTheLargest) {
  const AggregateParameters p = paper_aggregates();
  EXPECT_EQ(fuller_passing(p, p.d_min), 0);
  EXPECT_EQ(fuller_passing(p, p.d_max), 1);
  // Equation 16 with the share below d_min taken off.
  const double below = std::pow(p.d_min / p.d_max, 0.45);
  expect_known(
      {"Fuller's curve at half the largest diameter", "the paper, Eq. (16), less what is below d_min", "1"},
      fuller_passing(p, p.d_max / 2), (std::pow(0.5, 0.45) - below) / (1 - below), 1e-15);
}

TEST(Gradation, TotalAreaIsOffByAtMostHalfTheSmallestAggregate) {
  const AggregateParameters p = paper_aggregates();
  for (int seed = 0; seed < 50; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const double specimen_area = 0.15 * 0.3;
    EXPECT_NEAR(total_area(draw_stones<2>(p, specimen_area, random)), p.fraction * specimen_area,
                0.5 * circle_area(p.d_min) * (1 + 1e-9));
  }
}

TEST(Gradation, DiametersDescendWithinTheRange) {
  const AggregateParameters p = paper_aggregates();
  Random random(1);
  const std::vector<Stone<2>> stones = draw_stones<2>(p, 1.0, random);
  EXPECT_TRUE(std::ranges::is_sorted(stones, std::greater<>(), &Stone<2>::diameter));
  EXPECT_LE(stones.front().diameter, p.d_max);
  EXPECT_GE(stones.back().diameter, p.d_min);
}

TEST(Gradation, AtEverySieveTheCurveIsMetToOneAggregate) {
  const AggregateParameters p = paper_aggregates();
  Random random(3);
  const double specimen_area = 0.15 * 0.3;
  const std::vector<Stone<2>> aggregates = (draw_stones<2>(p, specimen_area, random));
  for (const GradationPoint& point : gradation(p, aggregates, p.sieves)) {
    // An interval hands on less than its smallest aggregate; the total is off by half the smallest of all.
    const double slack = (circle_area(point.size) + circle_area(p.d_min)) / (p.fraction * specimen_area);
    EXPECT_NEAR(point.passing_realised, point.passing_asked, 100 * slack) << "at " << point.size << " m";
  }
}

TEST(Gradation, FollowsTheCurveWithinTheIntervalsToo) {
  AggregateParameters p = paper_aggregates();
  p.sieves = {p.d_min, p.d_max};
  Random random(4);
  const std::vector<Stone<2>> aggregates = (draw_stones<2>(p, 100.0, random));
  std::vector<double> sizes;
  for (double d = p.d_min; d <= p.d_max; d += 1e-3) sizes.push_back(d);
  for (const GradationPoint& point : gradation(p, aggregates, sizes)) {
    // About 400,000 circles: the area of a share scatters by some 1/sqrt(400,000 / 10), half a percent; three
    // times this.
    EXPECT_NEAR(point.passing_realised, point.passing_asked, 1.5) << "at " << point.size << " m";
  }
}

TEST(Gradation, NoAggregatesHaveNoCurve) {
  EXPECT_TRUE(
      says(message([] { gradation(paper_aggregates(), std::vector<Stone<2>>{}, {}); }), "no aggregates"));
}

}  // namespace
}  // namespace pyroclast::specimen
