#include "pyroclast/base/child_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

constexpr int kPollTime = 10;  // ms

/// Pipe whose two ends are not inherited by programs that are started.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw Error(fmt::format("a pipe cannot be made: {}", std::strerror(errno)));
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_writing() { close_end(1); }

 private:
  void close_end(std::size_t i) {
    if (ends_[i] >= 0) close(std::exchange(ends_[i], -1));
  }
  std::array<int, 2> ends_{-1, -1};
};

// Between fork and exec only functions that are safe in signal handlers may be called: other threads of the
// process may have held any lock.

void take_default_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGCHLD, SIGXFSZ})
    std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Reports why the program could not be started, and ends the process.
[[noreturn]] void give_up(int failure) {
  const int error = errno;
  [[maybe_unused]] const auto written = write(failure, &error, sizeof error);
  _exit(127);
}

/// Replaces this process by the program.
[[noreturn]] void become(char* const* arguments, const char* output, int failure) {
  const int nothing = open("/dev/null", O_RDONLY);
  const int file = open(output, O_CREAT | O_WRONLY | O_TRUNC, S_IRUSR | S_IWUSR);
  if (nothing >= 0 && file >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(file, STDOUT_FILENO) >= 0 &&
      dup2(file, STDERR_FILENO) >= 0)
    execvp(arguments[0], arguments);
  give_up(failure);
}

/// Starts the program, ends as it ends, and kills the whole group when the process at the other end of
/// `alive` is gone.
[[noreturn]] void supervise(char* const* arguments, const char* output, int alive, int failure) {
  if (setpgid(0, 0) != 0) give_up(failure);  // else the signal below would reach others
  take_default_signals();
  const pid_t program = fork();
  if (program == 0) become(arguments, output, failure);
  if (program < 0) give_up(failure);
  close(failure);
  for (;;) {
    int status = 0;
    if (waitpid(program, &status, WNOHANG) == program)
      _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    pollfd other{alive, POLLIN, 0};
    if (poll(&other, 1, kPollTime) > 0) kill(0, SIGKILL);
  }
}

}  // namespace

bool run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                 const std::function<void()>& poll) {
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe alive, failure;
  const pid_t supervisor = fork();
  if (supervisor < 0) throw Error(fmt::format("{}: cannot be run: {}", words.front(), std::strerror(errno)));
  if (supervisor == 0) {
    alive.close_writing();
    supervise(arguments.data(), output.c_str(), alive.read_end(), failure.write_end());
  }
  setpgid(supervisor, supervisor);  // the child does this too; whoever is first
  failure.close_writing();
  int status = -1;
  try {
    for (pid_t ended = 0; ended == 0;) {
      ::poll(nullptr, 0, kPollTime);
      ended = waitpid(supervisor, &status, WNOHANG);
      if (ended == 0) poll();
      if (ended < 0 && errno == EINTR) ended = 0;
    }
  } catch (...) {
    kill(-supervisor, SIGKILL);
    while (waitpid(supervisor, &status, 0) < 0 && errno == EINTR) continue;
    throw;
  }
  if (!WIFEXITED(status) && !WIFSIGNALED(status))
    throw Error(fmt::format("{}: how it ended cannot be told: this process ignores SIGCHLD", words.front()));
  int error = 0;
  if (read(failure.read_end(), &error, sizeof error) == sizeof error)
    throw Error(fmt::format("{}: cannot be run: {}", words.front(), std::strerror(error)));
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace pyroclast
