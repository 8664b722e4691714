#include "pyroclast/app/python_package.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/own_program.hpp"

extern char** environ;

namespace pyroclast::app {

namespace {

/// Returns the folder of the Python package: beside an installed program, in the environment into which pip
/// put both, or in the build tree of a built program; else the source tree, without its compiled part.
std::filesystem::path package_folder() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path prefix = own_prefix();
  if (fs::exists(prefix / PYROCLAST_INSTALLED_PYTHON)) return prefix / PYROCLAST_INSTALLED_PYTHON;
  for (const auto& python : fs::directory_iterator(prefix / "lib", ignored))
    if (fs::exists(python.path() / "site-packages" / "pyroclast")) return python.path() / "site-packages";
  if (fs::exists(prefix / "python" / "pyroclast")) return prefix / "python";
  return PYROCLAST_SOURCE_PYTHON;
}

/// Texts as the system takes them.
class Strings {
 public:
  explicit Strings(std::vector<std::string> texts) : texts_(std::move(texts)) {
    for (auto& text : texts_) pointers_.push_back(text.data());
    pointers_.push_back(nullptr);
  }
  char* const* data() { return pointers_.data(); }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> pointers_;
};

/// What the package needs; ends messages.
constexpr auto kNeeded =
    "Python 3.9 or later, for studies 3.11, with NumPy, h5py and Matplotlib is needed; PYROCLAST_PYTHON in "
    "the environment names another Python";

/// Python code that runs a module as a program. `@` stands for the module, `?` for what it needs. Python
/// takes no module from the current folder. While the module loads, Ctrl-C ends it as it ends any program;
/// from then on the module may hear Ctrl-C itself.
constexpr auto kStart = R"(import sys
if sys.path[:1] == ['']:
    del sys.path[0]
needed = '?'
if sys.version_info < (3, 11 if '@' == 'pyroclast.study' else 9):
    sys.exit('error: %s is Python %d.%d: ' % ((sys.executable,) + sys.version_info[:2]) + needed)
import runpy, signal
if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
try:
    from pyroclast.libraries import hear_matplotlib
    hear_matplotlib()
    if '@' in ('pyroclast.figures', 'pyroclast.report', 'pyroclast.watch'):
        from pyroclast.programs import load_libraries
        load_libraries(True)
    runpy.run_module('@', run_name='__main__', alter_sys=True)
except ImportError as error:
    if "'_core'" in str(error) or error.name == 'pyroclast._core':
        sys.exit('error: studies and runs in Python need the compiled part of the package, which is not here for %s; '
                 'the Debian package has it, and a build' % sys.executable)
    if error.name not in ('numpy', 'h5py', 'matplotlib'):
        raise
    sys.exit('error: %s has no %s: ' % (sys.executable, error.name) + needed)
)";

Strings arguments_of(const std::string& module, const std::vector<std::string>& words) {
  std::string start = kStart;
  for (auto at = start.find('@'); at != std::string::npos; at = start.find('@')) start.replace(at, 1, module);
  start.replace(start.find('?'), 1, kNeeded);
  std::vector<std::string> arguments{python(), "-c", start};
  arguments.insert(arguments.end(), words.begin(), words.end());
  return Strings(std::move(arguments));
}

Strings environment() {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (!std::string(*variable).starts_with("PYTHONPATH=")) variables.emplace_back(*variable);
  variables.push_back("PYTHONPATH=" + package_folder().string());
  // one process tells that Matplotlib has no folder: see hear_matplotlib
  static bool is_first = true;
  if (!std::exchange(is_first, false)) variables.emplace_back("PYROCLAST_MATPLOTLIB_TOLD=1");
  return Strings(std::move(variables));
}

/// Time between two questions whether to end a program that runs.
constexpr std::chrono::milliseconds kPatience{50};

}  // namespace

std::string python() {
  const char* named = std::getenv("PYROCLAST_PYTHON");
  return named != nullptr && *named != '\0' ? named : PYROCLAST_PYTHON;
}

std::string no_python() {
  return fmt::format("there is no {}: {}", python(), kNeeded);
}

std::optional<pid_t> start_package(const std::string& module, const std::vector<std::string>& words,
                                   const Companion& companion) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (!companion.prints) posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Ctrl-C goes to the processes of the group that has the terminal
  if (!companion.hears_ctrl_c) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::fflush(stdout);
  pid_t child = 0;
  const int error = posix_spawnp(&child, python().c_str(), &files, &attributes,
                                 arguments_of(module, words).data(), environment().data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? std::optional(child) : std::nullopt;
}

void become_package(const std::string& module, const std::vector<std::string>& words) {
  std::fflush(stdout);
  execvpe(python().c_str(), arguments_of(module, words).data(), environment().data());
  throw Error(errno == ENOENT ? no_python()
                              : fmt::format("{}: cannot be run ({})", python(), std::strerror(errno)));
}

int wait_for(pid_t child, const std::function<bool()>& skip) {
  int status = -1;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (skip()) kill(child, SIGTERM);
    std::this_thread::sleep_for(kPatience);
  }
  return status;
}

}  // namespace pyroclast::app
