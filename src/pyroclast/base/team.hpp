#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

namespace pyroclast {

/// What a team does when other work takes its cores: all its threads go on, or fewer for a while.
enum class WhenCrowded { stay, give_way };

/// Threads that belong to a run. The one that calls is the first of them.
///
/// Who waits spins for some microseconds, in case the others are about to come, and then sleeps until it is
/// woken: other work on the machine gets the core. One caller at a time.
///
/// A thread whose core is taken by other work keeps all the others waiting. A team that gives way therefore
/// adds up the long waits of its threads within calls. Where that is much it halves the number of threads
/// that it offers, and tries all of them again after a while.
class Team {
 public:
  /// \param threads  at least 1, else Error
  explicit Team(int threads = 1, WhenCrowded when_crowded = WhenCrowded::stay);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }
  /// Threads that the next call does well to ask for: fewer than `size()` while the machine is crowded.
  int offered();
  /// Another number of threads from the next call on. Not from within one.
  void resize(int threads);

  /// Calls `f(thread)` on the first `threads` threads, at most `size()`, and returns when all are through.
  /// What one of them throws is thrown here, that of the first thread first; a thread that throws must not
  /// leave others at a barrier.
  template <class F>
  void run(int threads, F&& f) {
    using Function = std::remove_reference_t<F>;
    run_job({[](void* function, int thread) { (*static_cast<Function*>(function))(thread); },
             const_cast<void*>(static_cast<const void*>(&f))},
            threads);
  }

  /// Within `run`: waits for the other threads of that call.
  /// \param thread  the one that waits
  void barrier(int thread) {
    if (in_run_ > 1) wait_for_others(thread);
  }

  /// Calls `f(first, last)` for even ranges of [0, count), one a thread, where each gets `fewest` or more.
  template <class F>
  void share(std::ptrdiff_t count, std::ptrdiff_t fewest, F&& f) {
    const auto most = static_cast<std::ptrdiff_t>(offered());
    const std::ptrdiff_t wanted = fewest > 0 ? count / fewest : most;
    const std::ptrdiff_t threads = wanted < 1 ? 1 : wanted < most ? wanted : most;
    if (threads == 1) {
      f(std::ptrdiff_t{0}, count);
      return;
    }
    run(static_cast<int>(threads),
        [&](int thread) { f(count * thread / threads, count * (thread + 1) / threads); });
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Job {
    void (*call)(void* function, int thread) = nullptr;
    void* function = nullptr;
  };

  void run_job(const Job& job, int threads);
  void work(int thread, std::uint32_t seen);
  void call(int thread);
  void wait_for_others(int thread);
  void see_whether_crowded(Clock::duration took);
  void start(int threads);
  void stop();

  int size_ = 1;
  std::vector<std::thread> others_;
  Job job_;
  int in_run_ = 1;  ///< threads of the present call
  std::vector<std::exception_ptr> thrown_;
  bool ends_ = false;

  /// Time in long waits within calls since the window began; a cache line each.
  struct alignas(64) Waited {
    Clock::duration time{};
  };
  WhenCrowded when_crowded_;
  std::vector<Waited> waited_;    ///< of each thread
  Clock::duration in_window_{};   ///< all threads' time in calls since the window began
  int offered_ = 1;               ///< threads
  Clock::time_point lowered_at_;  ///< when fewer threads than all were last offered
  Clock::duration pause_{};       ///< until all are offered again

  // Words on which threads wait, each on a cache line of its own.
  alignas(64) std::atomic<std::uint32_t> jobs_{0};     ///< begun so far
  alignas(64) std::atomic<std::uint32_t> working_{0};  ///< other threads that are not through yet
  alignas(64) std::atomic<std::uint32_t> waiting_{0};  ///< at the barrier
  alignas(64) std::atomic<std::uint32_t> passed_{0};   ///< barriers passed so far
};

/// As many as the machine lets this process use.
int available_threads();

}  // namespace pyroclast
