#include "pyroclast/base/chunked_sum.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

// Each chunk is summed by itself: small numbers are not lost in the sum of the chunks before.
TEST(ChunkedSum, AddsWithinAChunkFirstAndThenOverChunks) {
  const std::vector<double> value{1.0, 1e-16, 1e-16, 1e-16, 1e-16};
  const auto at = [&](int i) { return value[static_cast<std::size_t>(i)]; };
  const ChunkList one({0, 5}), two({0, 1, 5});
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
  const auto both = chunked_sum<Both>(ChunkList({0, 2, 2, 7}), [](int i, Both& s) {
    s.sum += i;
    ++s.count;
  });
  EXPECT_EQ(both.sum, 21.0);
  EXPECT_EQ(both.count, 7);
}

TEST(ChunkedSum, OfNothingIsZero) {
  const auto one = [](int) { return 1.0; };
  EXPECT_EQ(chunked_sum(ChunkList(), one), 0.0);
  EXPECT_EQ(chunked_sum(ChunkList({0}), one), 0.0);
  EXPECT_EQ(chunked_sum(ChunkList({0, 0}), one), 0.0);
}

// Of a part of a body the own chunks count, each with the sum that it has in the whole.
TEST(ChunkedSum, LeavesForeignChunksOut) {
  const auto place = [](int i) { return 1.0 + i; };
  const std::vector<int> begins{0, 2, 3, 6};
  EXPECT_EQ(chunked_sum(ChunkList(begins, {true, false, true}), place), 3.0);
  EXPECT_EQ(chunked_sum(ChunkList(begins, {true, false, false}), place), 3.0 + (4.0 + 5.0 + 6.0));
  EXPECT_EQ(chunked_sum(ChunkList(begins, {true, true, true}), place), 0.0);
}

TEST(ChunkList, CutsAListOfSomeItemsWhereThatOfAllIsCut) {
  const ChunkList all({0, 10, 20, 30, 40}, {false, true, false, false});
  const ChunkList some = all.of_some({3, 9, 10, 35});
  EXPECT_EQ(some.begins(), (std::vector<int>{0, 2, 3, 3, 4}));
  EXPECT_TRUE(some.is_foreign(1));
  EXPECT_FALSE(some.is_foreign(2));
  EXPECT_EQ(all.of_some({}).begins(), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(all.of_some({39}).count(), 4);
}

}  // namespace
}  // namespace pyroclast
