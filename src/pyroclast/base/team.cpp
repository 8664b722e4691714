#include "pyroclast/base/team.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Time for which a waiting thread spins: others come within it where the cores are free. With a shorter
/// time, a virtual machine that loses a core for a moment would put the other to sleep as well, at every
/// barrier.
constexpr std::chrono::microseconds kSpin{500};
/// Number of looks at the word between two looks at the clock.
constexpr int kLooksPerClock = 16;

// Values that decide when a team gives way. On free cores its threads are kept waiting for less than a tenth
// of the time, beside as many loops as cores for four fifths. Two threads may share a core for some ticks
// before the system moves one to another.
constexpr double kMostKeptWaiting = 0.5;                  ///< largest share of the time of calls
constexpr std::chrono::milliseconds kLongWaits{10};       ///< long waits of each thread before a judgement
constexpr std::chrono::milliseconds kShortestWindow{60};  ///< time of calls before a judgement
constexpr std::chrono::milliseconds kTry{100};            ///< time of calls until more threads have gone well
constexpr std::chrono::milliseconds kShortestPause{250};  ///< pause; doubled each time that it was too short
constexpr std::chrono::seconds kLongestPause{8};

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Waits until the word is no longer `old`. Returns how long that took, or 0 where it did not have to sleep.
Clock::duration wait_while(const std::atomic<std::uint32_t>& word, std::uint32_t old) {
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

bool are_crowded(int threads, std::chrono::nanoseconds waited, std::chrono::nanoseconds took) {
  return waited > kMostKeptWaiting * (threads - 1) * took;
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
  const auto count = static_cast<std::size_t>(threads);
  thrown_.resize(count);
  seats_ = std::vector<Seat>(count);
  pause_ = kShortestPause;
  begin_try();
  for (int thread = 1; thread < threads; ++thread) others_.emplace_back([=, this] { work(thread); });
}

void Team::stop() {
  ends_ = true;
  for (int thread = 1; thread < size_; ++thread) wake(thread);
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

/// Waits for jobs and does them, on another thread, until the team stops.
void Team::work(int thread) {
  const auto& jobs = seats_[static_cast<std::size_t>(thread)].jobs;
  for (std::uint32_t seen = 0;; ++seen) {
    wait_while(jobs, seen);
    if (ends_) return;
    call(thread);
    if (working_.fetch_sub(1, std::memory_order_acq_rel) == 1) working_.notify_one();
  }
}

void Team::wake(int thread) {
  auto& jobs = seats_[static_cast<std::size_t>(thread)].jobs;
  jobs.fetch_add(1, std::memory_order_release);
  jobs.notify_one();
}

void Team::run_job(const Job& job, int threads) {
  threads = std::clamp(threads, 1, size_);
  job_ = job;
  in_run_ = threads;
  if (threads == 1) {
    job.call(job.function, 0);
    return;
  }
  crowded_ = false;
  const auto began = window_began_ = Clock::now();
  working_.store(static_cast<std::uint32_t>(threads - 1), std::memory_order_relaxed);
  for (int thread = 1; thread < threads; ++thread) wake(thread);
  call(0);
  for (auto left = working_.load(std::memory_order_acquire); left != 0;
       left = working_.load(std::memory_order_acquire))
    add_wait(wait_while(working_, left));
  judge();
  const auto now = Clock::now();
  in_window_ += now - window_began_;
  if (tries_ && (in_try_ += now - began) > kTry) {
    tries_ = false;
    pause_ = kShortestPause;
  }
  in_run_ = 1;
  std::exception_ptr first;
  for (auto& thrown : thrown_) {
    if (!first) first = thrown;
    thrown = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

int Team::offered() {
  if (offered_ < size_ && !tries_ && Clock::now() - lowered_at_ > pause_) {
    offered_ = std::min(2 * offered_, size_);
    begin_try();
  }
  return offered_;
}

void Team::begin_try() {
  tries_ = true;
  in_try_ = in_window_ = {};
  waited_.store(0, std::memory_order_relaxed);
}

/// Adds a wait that just ended, as far as it lies in the window.
void Team::add_wait(Clock::duration time) {
  if (time == Clock::duration{}) return;
  time = std::min(time, Clock::now() - window_began_);
  waited_.fetch_add(time.count(), std::memory_order_relaxed);
}

/// Offers fewer threads where long waits, if there were enough of them, took much of the threads' time. It
/// asks the clock only then, and so costs nothing on free cores.
void Team::judge() {
  const Clock::duration waited(waited_.load(std::memory_order_relaxed));
  if (crowded_ || when_crowded_ == WhenCrowded::stay || waited < in_run_ * Clock::duration(kLongWaits))
    return;
  const auto now = Clock::now();
  const auto took = in_window_ + (now - window_began_);
  if (took < kShortestWindow) return;
  waited_.store(0, std::memory_order_relaxed);
  in_window_ = {};
  window_began_ = now;
  if (!are_crowded(in_run_, waited, took)) return;
  crowded_ = true;
  if (tries_) pause_ = std::min<Clock::duration>(2 * pause_, kLongestPause);
  tries_ = false;
  offered_ = in_run_ / 2;
  lowered_at_ = now;
}

void Team::wait_for_others() {
  const auto passed = passed_.load(std::memory_order_acquire);
  if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == static_cast<std::uint32_t>(in_run_)) {
    judge();
    waiting_.store(0, std::memory_order_relaxed);
    passed_.fetch_add(1, std::memory_order_release);
    passed_.notify_all();
  } else {
    add_wait(wait_while(passed_, passed));
  }
}

}  // namespace pyroclast
