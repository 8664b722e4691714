#include "pyroclast/base/rounding.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAbsoluteZero = -273.15;

// Promise: numbers are the same within 1e-12 of the larger magnitude, temperatures by their kelvins.
TEST(Rounding, TheSameIsWithinAShareOfTheLargerMagnitude) {
  EXPECT_TRUE(same(0.3, 0.1 + 0.1 + 0.1));
  EXPECT_TRUE(same(3600.0, 3600.0 * (1.0 + 0.9e-12)));
  EXPECT_FALSE(same(3600.0, 3600.0 * (1.0 + 1.2e-12)));
  EXPECT_TRUE(same(0.0, 2e-10, kAbsoluteZero));
  EXPECT_FALSE(same(0.0, 2e-10));
  EXPECT_FALSE(same(0.0, 4e-10, kAbsoluteZero));
  EXPECT_TRUE(same(kInfinity, kInfinity));
  EXPECT_FALSE(same(kInfinity, 1.0));
  EXPECT_FALSE(same(kInfinity, -kInfinity));
  EXPECT_TRUE(at_most(0.1 + 0.2, 0.3));
  EXPECT_TRUE(at_most(1.0, 2.0));
  EXPECT_FALSE(at_most(2.0, 1.0));
}

TEST(Rounding, WholeUnitsAreNotLostToRounding) {
  EXPECT_EQ(whole_below(0.3 / 0.1), 3.0);  // 2.9999999999999996
  EXPECT_EQ(whole_below(2.9), 2.0);
  EXPECT_EQ(whole_below(0.0), 0.0);
  EXPECT_EQ(whole_above((0.1 + 0.2) / 0.1), 3.0);  // 3.0000000000000004
  EXPECT_EQ(whole_above(3.1), 4.0);
}

TEST(Rounding, TheEarliestOfTimesLeavesNoSliver) {
  EXPECT_EQ(earliest({0.1 + 0.2, 0.3, kInfinity}), 0.1 + 0.2);
  EXPECT_EQ(earliest({5.0, 4.0}), 4.0);
  EXPECT_EQ(earliest({kInfinity, kInfinity}), kInfinity);
}

}  // namespace
}  // namespace pyroclast
