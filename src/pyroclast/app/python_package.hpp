#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace pyroclast::app {

/// Whether a program hears what this one's terminal sends: Ctrl-C, and what it prints.
struct Companion {
  bool hears_ctrl_c = true;
  bool prints = true;  ///< on standard output
};

/// Starts a module of the Python package, as another process. Returns its id, or none where it cannot run.
std::optional<pid_t> start_package(const std::string& module, const std::vector<std::string>& words,
                                   const Companion& companion);
/// Goes on as a module of the Python package. Throws Error where that cannot run.
[[noreturn]] void become_package(const std::string& module, const std::vector<std::string>& words);

/// Waits for the end of a process, or ends it once `skip` says so. Returns its status, see waitpid(2).
int wait_for(pid_t child, const std::function<bool()>& skip);

}  // namespace pyroclast::app
