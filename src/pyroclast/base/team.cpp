#include "pyroclast/base/team.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <sched.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Others come within this time where the cores are free. Shorter, and a virtual machine that loses a core for a
/// moment puts the other to sleep as well, at every barrier.
constexpr std::chrono::microseconds kSpin{500};
/// Looks at the word between two looks at the clock.
constexpr int kLooksPerClock = 16;

// When a team gives way. On free cores long waits take less than a twentieth of the threads' time in calls; beside
// as many loops as cores, two fifths.
constexpr double kMostKeptWaiting = 0.2;                       ///< share of the threads' time in calls
constexpr std::chrono::milliseconds kWindow{20};          ///< of each thread's calls, between two judgements
constexpr std::chrono::milliseconds kShortestPause{250};  ///< doubled each time that it was too short
constexpr std::chrono::seconds kLongestPause{8};

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Returns when the word is no longer `old`: how long that took, or 0 where it did not have to sleep.
std::chrono::steady_clock::duration wait_while(const std::atomic<std::uint32_t>& word, std::uint32_t old) {
  using Clock = std::chrono::steady_clock;
  const auto changed = [&] { return word.load(std::memory_order_acquire) != old; };
  if (changed()) return {};
  const auto begin = Clock::now();
  do {
    for (int i = 0; i < kLooksPerClock; ++i) {
      relax();
      if (changed()) return {};
    }
  } while (Clock::now() - begin < kSpin);
  while (!changed()) word.wait(old, std::memory_order_acquire);
  return Clock::now() - begin;
}

}  // namespace

int available_threads() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Team::Team(int threads, WhenCrowded when_crowded) : when_crowded_(when_crowded) {
  start(threads);
}

Team::~Team() {
  stop();
}

void Team::start(int threads) {
  if (threads < 1)
    throw Error(fmt::format("the number of threads is {}, but it must be at least 1", threads));
  size_ = offered_ = threads;
  thrown_.resize(static_cast<std::size_t>(threads));
  waited_.assign(static_cast<std::size_t>(threads), {});
  in_window_ = {};
  pause_ = kShortestPause;
  const std::uint32_t seen = jobs_.load();
  for (int thread = 1; thread < threads; ++thread) others_.emplace_back([=, this] { work(thread, seen); });
}

void Team::stop() {
  ends_ = true;
  jobs_.fetch_add(1, std::memory_order_release);
  jobs_.notify_all();
  for (auto& thread : others_) thread.join();
  others_.clear();
  ends_ = false;
}

void Team::resize(int threads) {
  if (threads == size_) return;
  stop();
  start(threads);
}

void Team::call(int thread) {
  try {
    job_.call(job_.function, thread);
  } catch (...) {
    thrown_[static_cast<std::size_t>(thread)] = std::current_exception();
  }
}

/// What another thread does all its life.
void Team::work(int thread, std::uint32_t seen) {
  for (;;) {
    wait_while(jobs_, seen);
    ++seen;
    if (ends_) return;
    if (thread < in_run_) call(thread);
    if (working_.fetch_sub(1, std::memory_order_acq_rel) == 1) working_.notify_all();
  }
}

void Team::run_job(const Job& job, int threads) {
  threads = std::clamp(threads, 1, size_);
  job_ = job;
  in_run_ = threads;
  if (threads == 1) {
    job.call(job.function, 0);
    return;
  }
  const auto begin = Clock::now();
  working_.store(static_cast<std::uint32_t>(size_ - 1), std::memory_order_relaxed);
  jobs_.fetch_add(1, std::memory_order_release);
  jobs_.notify_all();
  call(0);
  for (auto left = working_.load(std::memory_order_acquire); left != 0;
       left = working_.load(std::memory_order_acquire))
    waited_[0].time += wait_while(working_, left);
  if (when_crowded_ == WhenCrowded::give_way) see_whether_crowded(Clock::now() - begin);
  in_run_ = 1;
  std::exception_ptr first;
  for (auto& thrown : thrown_) {
    if (!first) first = thrown;
    thrown = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

int Team::offered() {
  if (offered_ < size_ && Clock::now() - lowered_at_ > pause_) offered_ = size_;
  return offered_;
}

/// \param took  the time of the present call
void Team::see_whether_crowded(Clock::duration took) {
  in_window_ += in_run_ * took;
  if (in_window_ < in_run_ * Clock::duration(kWindow)) return;
  Clock::duration waited{};
  for (auto& thread : waited_) waited += std::exchange(thread.time, {});
  const bool is_crowded = waited > kMostKeptWaiting * std::exchange(in_window_, {});
  if (is_crowded) {
    if (offered_ == size_) pause_ = std::min<Clock::duration>(2 * pause_, kLongestPause);
    offered_ = in_run_ / 2;
    lowered_at_ = Clock::now();
  } else if (offered_ == size_) {
    pause_ = kShortestPause;
  }
}

void Team::wait_for_others(int thread) {
  const auto passed = passed_.load(std::memory_order_acquire);
  if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == static_cast<std::uint32_t>(in_run_)) {
    waiting_.store(0, std::memory_order_relaxed);
    passed_.fetch_add(1, std::memory_order_release);
    passed_.notify_all();
  } else {
    waited_[static_cast<std::size_t>(thread)].time += wait_while(passed_, passed);
  }
}

}  // namespace pyroclast
