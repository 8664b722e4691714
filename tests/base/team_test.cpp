#include "pyroclast/base/team.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

TEST(Team, CallsEveryThreadOnce) {
  Team team(3);
  std::vector<int> calls(3);
  for (int i = 0; i < 1000; ++i) team.run(3, [&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
  EXPECT_EQ(calls, (std::vector<int>{1000, 1000, 1000}));
}

TEST(Team, CallsFewerThreadsWhereFewerAreAskedForAndNoMoreThanItHas) {
  Team team(3);
  std::vector<int> calls(3);
  team.run(2, [&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
  team.run(1, [&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
  team.run(8, [&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
  EXPECT_EQ(calls, (std::vector<int>{3, 2, 1}));
}

// What was written before a barrier is seen behind it, on any number of threads, again and again.
TEST(Team, NobodyPassesABarrierBeforeAllAreThere) {
  for (const int threads : {1, 2, 3, 5}) {
    Team team(threads);
    std::vector<int> place(static_cast<std::size_t>(threads));
    std::atomic<int> wrong{0};
    team.run(threads, [&](int thread) {
      for (int round = 1; round <= 100; ++round) {
        place[static_cast<std::size_t>(thread)] = round;
        team.barrier();
        for (const int other : place)
          if (other != round) ++wrong;
        team.barrier();
      }
    });
    EXPECT_EQ(wrong, 0) << threads;
  }
}

TEST(Team, MayChangeInNumberBetweenCalls) {
  Team team;
  for (const int threads : {1, 4, 2, 1, 3}) {
    team.resize(threads);
    EXPECT_EQ(team.size(), threads);
    std::atomic<int> calls{0};
    team.run(threads, [&](int) { ++calls; });
    EXPECT_EQ(calls, threads);
  }
  EXPECT_THROW(team.resize(0), Error);
  EXPECT_THROW(Team(-1), Error);
}

TEST(Team, WhatAThreadThrowsIsThrownHereAndTheTeamGoesOn) {
  Team team(2);
  for (const int thrower : {0, 1})
    EXPECT_THROW(team.run(2,
                          [&](int thread) {
                            if (thread == thrower) throw std::runtime_error("no");
                          }),
                 std::runtime_error);
  std::atomic<int> calls{0};
  team.run(2, [&](int) { ++calls; });
  EXPECT_EQ(calls, 2);
}

TEST(Team, SharesARangeWithoutGapOrOverlap) {
  Team team(3);
  for (const int count : {0, 1, 2, 7, 1000})
    for (const int fewest : {0, 1, 400, 5000}) {
      std::vector<int> taken(static_cast<std::size_t>(count));
      std::atomic<int> ranges{0};
      team.share(count, fewest, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        ++ranges;
        for (auto i = first; i < last; ++i) ++taken[static_cast<std::size_t>(i)];
      });
      EXPECT_EQ(taken, std::vector<int>(static_cast<std::size_t>(count), 1));
      EXPECT_LE(ranges, fewest > 0 ? std::max(1, count / fewest) : 3);
    }
}

// A thread that waits for long sleeps: of 200 ms at a barrier it burns at most a tenth, as every thread of
// the team between two calls.
TEST(Team, WaitsWithoutBurningTheMachine) {
  Team team(3);
  const auto nap = [] { std::this_thread::sleep_for(std::chrono::milliseconds(200)); };
  team.run(3, [](int) {});
  const std::clock_t begin = std::clock();
  nap();
  team.run(3, [&](int thread) {
    if (thread == 0) nap();
    team.barrier();
  });
  const double burnt = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(burnt, 0.04);
}

// What a thread that naps within calls stands for: one whose core is taken.
void nap(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// A call in which all wait for one that naps.
void run_crowded(Team& team, int threads) {
  team.run(threads, [&](int thread) {
    if (thread == 1) nap(100);
    team.barrier();
  });
}

TEST(Team, GivesWayWhileItsThreadsWaitForLongAndComesBack) {
  Team stays(2, WhenCrowded::stay), gives_way(2);
  for (Team* team : {&stays, &gives_way}) {
    EXPECT_EQ(team->offered(), 2);
    run_crowded(*team, 2);
  }
  EXPECT_EQ(stays.offered(), 2);
  EXPECT_EQ(gives_way.offered(), 1);
  int ranges = 0;
  gives_way.share(1000, 0, [&](std::ptrdiff_t, std::ptrdiff_t) { ++ranges; });
  EXPECT_EQ(ranges, 1);
  while (gives_way.offered() == 1) nap(50);
  EXPECT_EQ(gives_way.offered(), 2);
}

// It halves its threads while they keep waiting, and doubles them again, each number only when the one before
// has gone well: threads that nap for as long as each other do not wait.
TEST(Team, HalvesAndDoublesItsThreads) {
  Team team(4);
  run_crowded(team, 4);
  EXPECT_EQ(team.offered(), 2);
  run_crowded(team, 2);
  EXPECT_EQ(team.offered(), 1);
  while (team.offered() == 1) nap(50);
  EXPECT_EQ(team.offered(), 2);
  run_crowded(team, 2);
  EXPECT_EQ(team.offered(), 1);
  while (team.offered() == 1) nap(50);
  for (const int threads : {2, 4}) {
    EXPECT_EQ(team.offered(), threads);
    team.run(threads, [](int) { nap(200); });
  }
  EXPECT_EQ(team.offered(), 4);
}

// All threads of a call hear at the same barrier that it is crowded, long before its last round.
TEST(Team, ACrowdedCallMayEndAtABarrier) {
  constexpr int kRounds = 200;
  for (const auto when_crowded : {WhenCrowded::stay, WhenCrowded::give_way}) {
    Team team(3, when_crowded);
    std::vector<int> rounds(3);
    team.run(3, [&](int thread) {
      int& round = rounds[static_cast<std::size_t>(thread)];
      for (bool is_crowded = false; round < kRounds && !is_crowded; ++round) {
        if (thread == 2) nap(2);
        is_crowded = team.barrier();
      }
    });
    if (when_crowded == WhenCrowded::stay) {
      EXPECT_EQ(rounds, std::vector<int>(3, kRounds));
    } else {
      EXPECT_LT(rounds[0], kRounds / 2);
      EXPECT_EQ(rounds, std::vector<int>(3, rounds[0]));
      EXPECT_EQ(team.offered(), 1);
    }
  }
}

// Of 2 threads one waits while the other has no core, of 4 three do.
TEST(Team, IsCrowdedWhereItsThreadsWaitForMoreThanHalfOfTheTime) {
  using std::chrono::milliseconds;
  EXPECT_FALSE(are_crowded(2, milliseconds(0), milliseconds(100)));
  EXPECT_FALSE(are_crowded(2, milliseconds(50), milliseconds(100)));
  EXPECT_TRUE(are_crowded(2, milliseconds(51), milliseconds(100)));
  EXPECT_FALSE(are_crowded(4, milliseconds(150), milliseconds(100)));
  EXPECT_TRUE(are_crowded(4, milliseconds(151), milliseconds(100)));
}

/// How often a thread of this process went to sleep.
int sleeps(int thread) {
  std::ifstream status("/proc/self/task/" + std::to_string(thread) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("voluntary_ctxt_switches:")) return std::stoi(line.substr(line.find(':') + 1));
  return -1;
}

TEST(Team, LeavesThreadsAsleepThatACallHasNoUseFor) {
  Team team(3);
  int last = 0;
  team.run(3, [&](int thread) {
    if (thread == 2) last = gettid();
  });
  int before = -1;
  for (int now = sleeps(last); now != before || now == 0; now = sleeps(last)) {
    before = now;
    nap(50);
  }
  ASSERT_GT(before, 0);
  for (int i = 0; i < 20; ++i) {
    team.run(2, [](int) {});
    nap(1);
  }
  EXPECT_EQ(sleeps(last), before);
}

}  // namespace
}  // namespace pyroclast
