#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <sys/types.h>

#include "pyroclast/app/run_log.hpp"

namespace pyroclast::app {

/// Shows a run while it is computed, by a process that reads the run's folder. Whatever becomes of that
/// process, the run goes on.
///
/// With a display it opens a window, which may outlive the run. Without one it draws a curve in the terminal;
/// then the run's lines of progress go to `run.log` alone, as long as it lives.
class Watcher {
 public:
  /// \param log  kept by reference
  Watcher(std::filesystem::path folder, RunLog& log);
  /// Ends it unless it has a window.
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Notices that it has ended, and tells if it did not mean to.
  void look_after();
  /// Where it prints, waits until it has shown the run that is over.
  /// \param skip  asked while it is waited for; true ends it
  void see_out(const std::function<bool()>& skip);

 private:
  void tell_end(int status);

  std::filesystem::path folder_;
  RunLog& log_;
  bool has_window_;
  std::optional<pid_t> process_;  ///< as long as it lives
};

/// Goes on as the watcher of a run, see the Python package. \param words  as typed
[[noreturn]] void watch(const std::vector<std::string>& words);

}  // namespace pyroclast::app
