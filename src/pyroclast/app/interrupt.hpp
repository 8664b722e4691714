#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace pyroclast::app {

/// Handler of interrupts while the object lives: the first SIGINT, SIGTERM or SIGHUP asks for a clean end,
/// the second one also to skip work that can be done later; the third has its usual effect. SIGUSR1, by which
/// queues say that time is short, asks for a clean end however often it comes. Only one object at a time.
class Interrupt {
 public:
  Interrupt() {
    count_ = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) before_[i] = std::signal(kSignals[i], on_signal);
    std::signal(SIGUSR1, on_stop);
  }
  ~Interrupt() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) std::signal(kSignals[i], before_[i]);
    std::signal(SIGUSR1, SIG_IGN);  // whatever has ended needs no stop, such as a rank that waits for others
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool asked() const { return count_ >= 1; }
  bool asked_twice() const { return count_ >= 2; }

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

  static void on_signal(int) {
    count_ = count_ + 1;
    if (count_ < 2) return;
    for (int signal : kSignals) std::signal(signal, SIG_DFL);
  }

  static void on_stop(int) {
    if (count_ == 0) count_ = 1;
  }

  static inline volatile std::sig_atomic_t count_ = 0;

  std::array<void (*)(int), kSignals.size()> before_{};
};

}  // namespace pyroclast::app
