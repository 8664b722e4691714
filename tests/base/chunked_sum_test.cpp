#include "pyroclast/base/chunked_sum.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

// Each chunk is summed by itself: small numbers are not lost in the sum of the chunks before.
TEST(ChunkedSum, AddsWithinAChunkFirstAndThenOverChunks) {
  const std::vector<double> value{1.0, 1e-16, 1e-16, 1e-16, 1e-16};
  const auto at = [&](int i) { return value[static_cast<std::size_t>(i)]; };
  const std::vector<int> one{0, 5}, two{0, 1, 5};
  EXPECT_EQ(chunked_sum(one, at), 1.0);
  EXPECT_EQ(chunked_sum(two, at), 1.0 + 4e-16);
}

TEST(ChunkedSum, TakesAnySum) {
  struct Both {
    double sum = 0.0;
    int count = 0;
    void operator+=(const Both& other) {
      sum += other.sum;
      count += other.count;
    }
  };
  const auto both = chunked_sum<Both>(std::vector<int>{0, 2, 2, 7}, [](int i, Both& s) {
    s.sum += i;
    ++s.count;
  });
  EXPECT_EQ(both.sum, 21.0);
  EXPECT_EQ(both.count, 7);
}

TEST(ChunkedSum, OfNothingIsZero) {
  const auto one = [](int) { return 1.0; };
  EXPECT_EQ(chunked_sum(std::vector<int>{}, one), 0.0);
  EXPECT_EQ(chunked_sum(std::vector<int>{0}, one), 0.0);
  EXPECT_EQ(chunked_sum(std::vector<int>{0, 0}, one), 0.0);
}

}  // namespace
}  // namespace pyroclast
