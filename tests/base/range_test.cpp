#include "pyroclast/base/range.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

TEST(Range, KeepsOrExcludesItsEnds) {
  EXPECT_TRUE(Range::between(0.0, 1.0).contains(0.0));
  EXPECT_TRUE(Range::between(0.0, 1.0).contains(1.0));
  EXPECT_FALSE(Range::between(0.0, 1.0).contains(1.1));
  EXPECT_FALSE(Range::inside(0.0, 1.0).contains(0.0));
  EXPECT_FALSE(Range::inside(0.0, 1.0).contains(1.0));
  EXPECT_TRUE(Range::inside(0.0, 1.0).contains(0.5));
  EXPECT_FALSE(Range::positive().contains(0.0));
  EXPECT_TRUE(Range::non_negative().contains(0.0));
  EXPECT_FALSE(Range::below(2.0).contains(2.0));
  EXPECT_TRUE(Range::at_most(2.0).contains(2.0));
}

// Promise: what lies beyond an end by rounding alone is that end; what lies farther stays outside.
TEST(Range, AnEndIsMetButForRounding) {
  const Range width = Range::between(0.0, 0.05999999999999999);
  EXPECT_FALSE(width.contains(0.06));
  EXPECT_EQ(width.but_for_rounding(0.06), 0.05999999999999999);
  EXPECT_EQ(width.but_for_rounding(0.06000001), 0.06000001);
  EXPECT_EQ(Range::at_least(0.3).but_for_rounding(0.3 - 1e-16), 0.3);
  EXPECT_EQ(Range::above(0.3).but_for_rounding(0.3 - 1e-16), 0.3 - 1e-16);
  EXPECT_EQ(Range::non_negative().but_for_rounding(-1e-300), -1e-300);
}

TEST(Range, NeverContainsNan) {
  EXPECT_FALSE(Range::any().contains(std::nan("")));
}

TEST(Range, IsDescribedInWordsWithItsUnit) {
  EXPECT_EQ(Range::any().describe("m"), "");
  EXPECT_EQ(Range::positive().describe("m"), "greater than 0 m");
  EXPECT_EQ(Range::at_least(20.0).describe("degC"), "at least 20 degC");
  EXPECT_EQ(Range::below(0.5).describe(), "less than 0.5");
  EXPECT_EQ(Range::at_most(2.0).describe(), "at most 2");
  EXPECT_EQ(Range::fraction().describe(), "between 0 and 1");
  EXPECT_EQ(Range::inside(0.0, 0.5).describe(), "greater than 0 and less than 0.5");
  EXPECT_EQ((Range{.lower = 0.0, .upper = 0.5, .upper_inclusive = false}).describe(),
            "at least 0 and less than 0.5");
}

TEST(Range, StandsInWithAValueItContains) {
  const Range ranges[]{
      Range::any(),        Range::positive(),       Range::above(1.0),      Range::at_least(300.0),
      Range::below(0.0),   Range::at_most(-5.0),    Range::below(-0.25),    Range::fraction(),
      Range::inside(0, 1), Range::inside(0.1, 0.2), Range::between(20, 30), Range::inside(20, 30)};
  for (const Range& range : ranges) EXPECT_TRUE(range.contains(range.any_value())) << range.describe();
}

}  // namespace
}  // namespace pyroclast
