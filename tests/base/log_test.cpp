#include "pyroclast/base/log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "pyroclast/base/random.hpp"

namespace pyroclast {
namespace {

double ulps_off(double x) {
  const long double exact = std::log(static_cast<long double>(x));
  int exponent = 0;
  std::frexp(exact, &exponent);
  return static_cast<double>(std::abs(log(x) - exact) / std::ldexp(1.0L, exponent - 53));
}

// Promise: the error stays below 1 ulp, also near 1 and for denormal numbers.
TEST(Log, IsExactToAUlp) {
  Random random(3);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    worst = std::max(worst, ulps_off(std::exp2(random.uniform(-1074.0, 1023.9))));
    worst = std::max(worst, ulps_off(random.uniform(0.5, 2.0)));
    worst = std::max(worst, ulps_off(1.0 + random.uniform(-1e-6, 1e-6)));
  }
  EXPECT_LT(worst, 1.0);
}

TEST(Log, HasTheLimitsOfTheFunction) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(log(1.0), 0.0);
  EXPECT_EQ(log(0.0), -kInfinity);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_TRUE(std::isnan(log(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Power, IsThatOfTheLibraryButForRounding) {
  Random random(4);
  for (int i = 0; i < 10000; ++i) {
    const double x = std::exp2(random.uniform(-30.0, 30.0)), y = random.uniform(-3.0, 3.0);
    EXPECT_NEAR(power(x, y) / std::pow(x, y), 1.0, 2e-14);
  }
  EXPECT_EQ(power(0.0, 0.5), 0.0);
  EXPECT_EQ(power(0.0, 0.0), 1.0);
}

}  // namespace
}  // namespace pyroclast
