#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <sys/types.h>

#include "pyroclast/app/run_log.hpp"

namespace pyroclast::app {

/// Process that shows a run while it is computed, from the run's folder. Whatever becomes of this process,
/// the run goes on.
///
/// The process draws a curve in the terminal; the run's lines of progress then go to `run.log` alone, as long
/// as the process lives.
class Watcher {
 public:
  /// \param log  log of the run, kept by reference
  Watcher(std::filesystem::path folder, RunLog& log);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Notices that the process has ended, and reports an end that was not intended.
  void look_after();
  /// Waits until the process has shown the run that is over.
  /// \param skip  asked during the wait; true ends the process
  void see_out(const std::function<bool()>& skip);

 private:
  void tell_end(int status);

  std::filesystem::path folder_;
  RunLog& log_;
  std::optional<pid_t> process_;  ///< id of the process as long as it lives
};

}  // namespace pyroclast::app
