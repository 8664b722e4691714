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

/// What a team does when other work takes its cores: it goes on with fewer threads for a while, or with all
/// of them, which is for tests and for measurements.
enum class WhenCrowded { give_way, stay };

/// Whether threads are a crowd's: kept waiting for so long that half as many would be faster. A thread
/// without a core keeps all others waiting; where that is more than half of the time, the half of them need
/// not wait for it.
///
/// \param waited  by all of them together, in waits long enough to sleep
/// \param took    time in which they did
bool are_crowded(int threads, std::chrono::nanoseconds waited, std::chrono::nanoseconds took);

/// Threads that belong to a run. The one that calls is the first of them.
///
/// Who waits spins for some microseconds, in case the others are about to come, and then sleeps until it is
/// woken: other work on the machine gets the core. One caller at a time.
///
/// A thread whose core is taken by other work keeps all the others waiting. A team that gives way therefore
/// adds up the waits of its threads within calls that were long enough to sleep. Where that is more than
/// half of the time, it is crowded: it offers half as many threads, also in the middle of a call, and after a
/// pause it tries twice as many again. A try that ends crowded doubles the pause.
class Team {
 public:
  /// \param threads  at least 1, else Error
  explicit Team(int threads = 1, WhenCrowded when_crowded = WhenCrowded::give_way);
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

  /// Within `run`: waits for the other threads of that call. True where the team has become crowded: the call
  /// does well to end here, and to go on in another one with as many threads as are offered then. All threads
  /// of the call get the same answer, and keep getting it.
  bool barrier() {
    if (in_run_ == 1) return false;
    wait_for_others();
    return crowded_;
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
  /// Jobs that were given to a thread so far; it sleeps on that word, on a cache line of its own.
  struct alignas(64) Seat {
    std::atomic<std::uint32_t> jobs{0};
  };

  void run_job(const Job& job, int threads);
  void work(int thread);
  void wake(int thread);
  void call(int thread);
  void wait_for_others();
  void begin_try();
  void add_wait(Clock::duration time);
  void judge();
  void start(int threads);
  void stop();

  int size_ = 1;
  std::vector<std::thread> others_;
  std::vector<Seat> seats_;  ///< of all threads; the first has no need of its own
  Job job_;
  int in_run_ = 1;  ///< threads of the present call
  std::vector<std::exception_ptr> thrown_;
  bool ends_ = false;

  // The last thread to come to a barrier writes these while all others wait there; between calls, who calls.
  WhenCrowded when_crowded_;
  bool crowded_ = false;            ///< the present call became crowded
  Clock::time_point window_began_;  ///< or the present call, where that was later
  Clock::duration in_window_{};     ///< time of earlier calls since the window began
  int offered_ = 1;                 ///< threads
  bool tries_ = true;               ///< so many threads have yet to go well for a while
  Clock::duration in_try_{};        ///< time of calls since the try began
  Clock::time_point lowered_at_;    ///< when fewer threads than before were offered
  Clock::duration pause_{};         ///< until more are tried

  // Words that several threads write, each on a cache line of its own.
  alignas(64) std::atomic<std::uint32_t> working_{0};  ///< other threads that are not through yet
  alignas(64) std::atomic<std::uint32_t> waiting_{0};  ///< at the barrier
  alignas(64) std::atomic<std::uint32_t> passed_{0};   ///< barriers passed so far
  alignas(64) std::atomic<Clock::rep> waited_{0};      ///< in long waits since the window began
};

}  // namespace pyroclast
