#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

#include "pyroclast/base/clock.hpp"

namespace pyroclast {

/// Behaviour of a team when other work takes its cores: it goes on with fewer threads for a while, or it
/// stays with all of them, which is for tests and for measurements.
enum class WhenCrowded { give_way, stay };

/// Tells whether threads are crowded: so much waiting that half as many threads would be faster. A thread
/// without a core keeps all others waiting. Where that takes more than half of the time, half of the threads
/// would do as much.
///
/// \param waited  time that all threads together waited, in waits long enough to sleep
/// \param took    time over which the waits were added up
bool are_crowded(int threads, std::chrono::nanoseconds waited, std::chrono::nanoseconds took);

/// Team: the threads of a run. The thread that calls is the first of them.
///
/// A waiting thread spins for some microseconds, in case the others are about to come, and then sleeps until
/// it is woken: other work on the machine gets the core. Only one caller at a time may use a team.
///
/// A thread whose core is taken by other work keeps all the others waiting. A team that gives way therefore
/// adds up the waits of its threads within calls that were long enough to sleep. A team whose waits take more
/// than half of the time is crowded: it offers half as many threads, also in the middle of a call, and after
/// a pause it tries twice as many again. A try that ends crowded doubles the pause.
class Team {
 public:
  /// \param threads  at least 1, else throws Error
  explicit Team(int threads = 1, WhenCrowded when_crowded = WhenCrowded::give_way);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }
  /// Returns the number of threads that the next call should ask for: fewer than `size()` while the machine
  /// is crowded.
  int offered();
  /// Changes the number of threads from the next call on. Must not be called from within a call.
  void resize(int threads);

  /// Calls `f(thread)` on the first `threads` threads, at most `size()`, and returns when all have finished.
  /// Throws again an exception of a thread, that of the first thread first. A thread that throws must not
  /// leave others at a barrier.
  template <class F>
  void run(int threads, F&& f) {
    using Function = std::remove_reference_t<F>;
    run_job({[](void* function, int thread) { (*static_cast<Function*>(function))(thread); },
             const_cast<void*>(static_cast<const void*>(&f))},
            threads);
  }

  /// Waits, within `run`, for the other threads of that call. Returns true where the team has become crowded:
  /// the call should then end, and go on in another call with as many threads as are then offered. All
  /// threads of the call get the same answer, and keep getting it.
  bool barrier() {
    if (in_run_ == 1) return false;
    wait_for_others();
    return crowded_;
  }

  /// Calls `f(first, last)` for even ranges of [0, count), one range a thread, each with `fewest` items or
  /// more.
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
  struct Job {
    void (*call)(void* function, int thread) = nullptr;
    void* function = nullptr;
  };
  /// Count of the jobs that a thread was given so far. The thread sleeps on this word, which has its own
  /// cache line.
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
  std::vector<Seat> seats_;  ///< one seat for each thread; the first thread does not use its own
  Job job_;
  int in_run_ = 1;  ///< threads of the present call
  std::vector<std::exception_ptr> thrown_;
  bool ends_ = false;

  // The last thread to come to a barrier writes these members while all others wait there; between calls the
  // caller writes them.
  WhenCrowded when_crowded_;
  bool crowded_ = false;            ///< the present call became crowded
  Clock::time_point window_began_;  ///< start of the window, or of the present call where that was later
  Clock::duration in_window_{};     ///< time of earlier calls since the window began
  int offered_ = 1;                 ///< number of threads offered
  bool tries_ = true;               ///< true until this number of threads has gone well for a while
  Clock::duration in_try_{};        ///< time of calls since the try began
  Clock::time_point lowered_at_;    ///< time at which fewer threads than before were offered
  Clock::duration pause_{};         ///< pause until more threads are tried

  // Words that several threads write, each on a cache line of its own.
  alignas(64) std::atomic<std::uint32_t> working_{0};  ///< other threads that have not finished yet
  alignas(64) std::atomic<std::uint32_t> waiting_{0};  ///< threads that wait at the barrier
  alignas(64) std::atomic<std::uint32_t> passed_{0};   ///< barriers passed so far
  alignas(64) std::atomic<Clock::rep> waited_{0};      ///< time in long waits since the window began
};

}  // namespace pyroclast
