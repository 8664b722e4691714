#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace pyroclast::app {

/// Use of this program's terminal by another program: whether it receives Ctrl-C, and whether it prints.
struct Companion {
  bool hears_ctrl_c = true;
  bool prints = true;  ///< true where it prints on standard output
};

/// Returns the Python that runs the package, a path or a name that PATH has: the one that PYROCLAST_PYTHON
/// names in the environment, or else that of the build.
std::string python();

/// Returns a sentence for a Python that is not there: what is needed, and how to name another one.
std::string no_python();

/// Starts a module of the Python package as another process. Returns its id, or none where it cannot run.
std::optional<pid_t> start_package(const std::string& module, const std::vector<std::string>& words,
                                   const Companion& companion);
/// Goes on as a module of the Python package. Throws Error where the module cannot run.
[[noreturn]] void become_package(const std::string& module, const std::vector<std::string>& words);

/// Waits for the end of a process, or ends it once `skip` is true. Returns its status, see waitpid(2).
int wait_for(pid_t child, const std::function<bool()>& skip);

}  // namespace pyroclast::app
