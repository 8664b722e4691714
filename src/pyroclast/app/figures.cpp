#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/results/folder_lock.hpp"

extern char** environ;

namespace pyroclast::app {

namespace {

/// The Python package: beside an installed program, or in the source tree of a built one.
std::filesystem::path package_folder() {
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto installed = program.parent_path().parent_path() / PYROCLAST_INSTALLED_PYTHON;
  return std::filesystem::exists(installed) ? installed : std::filesystem::path(PYROCLAST_SOURCE_PYTHON);
}

/// While a program runs, it is asked this often whether to end it.
constexpr std::chrono::milliseconds kPatience{50};

/// Waits for the end of a program, or ends it. Returns its status.
int wait_for(pid_t child, const std::function<bool()>& skip) {
  int status = -1;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (skip()) kill(child, SIGTERM);
    std::this_thread::sleep_for(kPatience);
  }
  return status;
}

/// Runs the package's command; returns its exit code, or -1 if there is no such program or it was ended.
int run_package(
    std::vector<std::string> words, Speech speech = Speech::usual,
    const std::function<bool()>& skip = [] { return false; }) {
  if (skip()) return -1;
  std::vector<std::string> arguments{PYROCLAST_PYTHON, "-m", "pyroclast.figures"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  std::vector<std::string> environment;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (!std::string(*variable).starts_with("PYTHONPATH=")) environment.emplace_back(*variable);
  environment.push_back("PYTHONPATH=" + package_folder().string());
  const auto pointers = [](std::vector<std::string>& strings) {
    std::vector<char*> list;
    for (auto& s : strings) list.push_back(s.data());
    list.push_back(nullptr);
    return list;
  };
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (speech == Speech::quiet)
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  int status = -1;
  std::fflush(stdout);
  if (posix_spawn(&child, PYROCLAST_PYTHON, &files, nullptr, pointers(arguments).data(),
                  pointers(environment).data()) == 0)
    status = wait_for(child, skip);
  posix_spawn_file_actions_destroy(&files);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

int figures(const std::vector<std::string>& words) {
  std::optional<FolderLock> lock;  // of a run whose own figures are drawn; what is only read is not locked
  if (words.size() >= 2 && words[0] == "run" && std::filesystem::is_directory(words[1]))
    lock.emplace(words[1]);
  const int code = run_package(words);
  if (code < 0) throw Error(fmt::format("{} cannot be run, which draws the figures", PYROCLAST_PYTHON));
  return code == 0 ? 0 : 1;
}

void draw_figures(const std::string& what, const std::filesystem::path& folder, Speech speech,
                  const std::function<bool()>& skip) {
  if (run_package({what, folder.string()}, speech, skip) == 0) return;
  fmt::print(stderr,
             "warning: no figures were drawn; the results are complete without them.\n"
             "To draw them later: pyroclast figures {} {}\n",
             what, folder.string());
}

}  // namespace pyroclast::app
