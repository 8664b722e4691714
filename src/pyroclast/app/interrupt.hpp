#pragma once

#include <csignal>

namespace pyroclast::app {

/// While one is there, the first SIGINT or SIGTERM only asks for a clean end; the next one has its usual
/// effect. One at a time.
class Interrupt {
 public:
  Interrupt() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
  }
  ~Interrupt() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool asked() { return asked_ != 0; }

 private:
  static void on_signal(int signal) {
    asked_ = 1;
    std::signal(signal, SIG_DFL);
  }

  static inline volatile std::sig_atomic_t asked_ = 0;
};

}  // namespace pyroclast::app
