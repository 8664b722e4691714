#include "pyroclast/base/chunked_sum.hpp"

#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/base/kept_sums.hpp"
#include "ranks_in_threads.hpp"

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

/// Ten items in chunks of two, of which a rank holds those of its number.
ChunkList chunks_of(Ranks& ranks) {
  std::vector<bool> is_foreign;
  for (int chunk = 0; chunk < 5; ++chunk) is_foreign.push_back((chunk < 2 ? 0 : 1) != ranks.me());
  return ChunkList({0, 2, 4, 6, 8, 10}, is_foreign, ranks);
}
double third(int item) {
  return 1.0 / (3 + item);
}

// Promise: collectives that travel together give what each gives alone, in one message.
TEST(CollectivesTogether, GiveWhatEachGivesAlone) {
  RanksInThreads::run(2, [](const auto& ranks) {
    const ChunkList chunks = chunks_of(*ranks);
    KeptSums kept;
    kept.keep(chunks, third);
    kept.keep(chunks, [](int item) { return item; });
    const auto all = [&] {
      const double me = ranks->me();
      return std::tuple(chunked_sum(chunks, third), ranks->largest(me), ranks->least(me),
                        ranks->any(me == 1.0), ranks->of(1, me), kept.totals(*ranks),
                        ranks->collect(std::vector<int>(ranks->me(), 7)),
                        ranks->together([&] { return ranks->sum(3); }));
    };
    const auto alone = all();
    const std::string before = ranks->events();
    EXPECT_EQ(ranks->together(all), alone);
    EXPECT_EQ(ranks->events(), before + "c");
    EXPECT_EQ(alone, std::tuple(chunked_sum(ChunkList({0, 2, 4, 6, 8, 10}), third), 1.0, 0.0, true, 1.0,
                                std::vector{std::get<0>(alone), 45.0}, std::vector{7}, std::int64_t{6}));
  });
}

// Promise: a change between sums is made once, though its function is called twice; the sums before it and
// those after it travel in one message.
TEST(CollectivesTogether, MayStandOnBothSidesOfAChange) {
  const auto act = [](Ranks& ranks) {
    std::int64_t own = 1, booked = 0;
    ranks.together([&] {
      const std::int64_t before = ranks.sum(own);
      if (ranks.gives()) own += 10;
      const std::int64_t after = ranks.sum(own);
      if (ranks.has_all()) booked += after - before;
    });
    return std::pair(own, booked);
  };
  EXPECT_EQ(act(one_rank()), std::pair(std::int64_t{11}, std::int64_t{10}));
  RanksInThreads::run(2, [&](const auto& ranks) {
    EXPECT_EQ(act(*ranks), std::pair(std::int64_t{11}, std::int64_t{20}));
    EXPECT_EQ(ranks->events(), "c");
  });
}

// Promise: where it depends on a result which collectives are called, the call fails rather than to mix them
// up, and the next one works.
TEST(CollectivesTogether, MustNotDependOnEachOther) {
  RanksInThreads::run(2, [](const auto& ranks) {
    const double me = ranks->me();
    EXPECT_THROW(ranks->together([&] { return ranks->largest(me) > 0.5 ? ranks->largest(1.0) : 0.0; }),
                 std::logic_error);
  });
  RanksInThreads::run(2, [](const auto& ranks) {
    EXPECT_THROW(ranks->together([]() -> int { throw std::runtime_error("own"); }), std::runtime_error);
    EXPECT_EQ(ranks->together([&] { return ranks->sum(1); }), 2);
  });
}

}  // namespace
}  // namespace pyroclast
