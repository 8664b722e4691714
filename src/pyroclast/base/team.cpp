#include "pyroclast/base/team.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <sched.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Others that come at all come within this time where the cores are free, and a thread that sleeps takes
/// about as long to wake.
constexpr std::chrono::microseconds kSpin{100};
/// Looks at the word between two looks at the clock.
constexpr int kLooksPerClock = 16;

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Returns when the word is no longer `old`.
void wait_while(const std::atomic<std::uint32_t>& word, std::uint32_t old) {
  const auto changed = [&] { return word.load(std::memory_order_acquire) != old; };
  if (changed()) return;
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int i = 0; i < kLooksPerClock; ++i) {
      relax();
      if (changed()) return;
    }
  } while (std::chrono::steady_clock::now() < end);
  while (!changed()) word.wait(old, std::memory_order_acquire);
}

}  // namespace

int available_threads() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Team::Team(int threads) {
  start(threads);
}

Team::~Team() {
  stop();
}

void Team::start(int threads) {
  if (threads < 1)
    throw Error(fmt::format("the number of threads is {}, but it must be at least 1", threads));
  size_ = threads;
  thrown_.resize(static_cast<std::size_t>(threads));
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
  working_.store(static_cast<std::uint32_t>(size_ - 1), std::memory_order_relaxed);
  jobs_.fetch_add(1, std::memory_order_release);
  jobs_.notify_all();
  call(0);
  for (auto left = working_.load(std::memory_order_acquire); left != 0;
       left = working_.load(std::memory_order_acquire))
    wait_while(working_, left);
  in_run_ = 1;
  std::exception_ptr first;
  for (auto& thrown : thrown_) {
    if (!first) first = thrown;
    thrown = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

void Team::wait_for_others() {
  const auto passed = passed_.load(std::memory_order_acquire);
  if (waiting_.fetch_add(1, std::memory_order_acq_rel) + 1 == static_cast<std::uint32_t>(in_run_)) {
    waiting_.store(0, std::memory_order_relaxed);
    passed_.fetch_add(1, std::memory_order_release);
    passed_.notify_all();
  } else {
    wait_while(passed_, passed);
  }
}

}  // namespace pyroclast
