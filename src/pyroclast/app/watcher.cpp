#include "pyroclast/app/watcher.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pyroclast/app/progress.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/shell_words.hpp"

namespace pyroclast::app {

namespace {

constexpr const char* kModule = "pyroclast.watch";
/// Longest wait for the last picture, s.
constexpr double kLongestFarewell = 60.0;

}  // namespace

Watcher::Watcher(std::filesystem::path folder, RunLog& log) : folder_(std::move(folder)), log_(log) {
  // where every look is told on the terminal, curves can only follow one another
  const bool has_terminal = isatty(STDOUT_FILENO) != 0 && log_.speech() == Speech::usual;
  const char* on = log_.speech() == Speech::quiet ? "nothing" : has_terminal ? "terminal" : "lines";
  process_ = start_package(kModule, {folder_.string(), "--on", on},
                           {.hears_ctrl_c = false, .prints = log_.speech() != Speech::quiet});
  if (!process_)
    say_aside(fmt::format("warning: nobody watches, and the run goes on: {}\n", no_python()));
  else if (has_terminal)
    log_.keep_progress_off_screen(true);
}

Watcher::~Watcher() {
  if (process_) wait_for(*process_, [] { return true; });
}

void Watcher::look_after() {
  int status = 0;
  if (process_ && waitpid(*process_, &status, WNOHANG) != 0) tell_end(status);
}

void Watcher::see_out(const std::function<bool()>& skip) {
  if (!process_) return;
  const auto begun = Clock::now();
  bool was_long = false;
  const int status = wait_for(
      *process_, [&] { return was_long = was_long || skip() || seconds_since(begun) > kLongestFarewell; });
  tell_end(was_long ? 0 : status);
}

void Watcher::tell_end(int status) {
  process_.reset();
  log_.keep_progress_off_screen(false);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  say_aside(fmt::format(
      "warning: the watcher ended ({}); the run does not. To watch it again: pyroclast watch {}\n",
      WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                        : fmt::format("signal {}", WTERMSIG(status)),
      shell_path(folder_)));
}

Command add_watch(CLI::App& cli) {
  auto* command =
      add_passed_on(cli, "watch", "Show a run while another process computes it: watch RUN [--once]");
  return {command, [=](const auto&) -> int { become_package(kModule, command->remaining()); }};
}

}  // namespace pyroclast::app
