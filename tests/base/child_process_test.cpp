#include "pyroclast/base/child_process.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "messages.hpp"
#include "pyroclast/base/read_file.hpp"

namespace pyroclast {
namespace {

namespace fs = std::filesystem;

class ChildProcess : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("pyroclast_child_{}", getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path output() const { return folder_ / "output.txt"; }

  /// A shell whose child writes its own number and would sleep for long.
  std::vector<std::string> shell_with_a_child() const {
    return {"sh", "-c",
            fmt::format("sh -c 'echo $$ > {0}/aside; mv {0}/aside {0}/number; exec sleep 1000' & wait",
                        folder_.string())};
  }
  /// The number of that child, once it runs.
  pid_t child() const {
    while (!fs::exists(folder_ / "number")) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return std::stoi(read_file(folder_ / "number"));
  }
  /// Whether a process ends within a minute. One that ended and that nobody waits for counts as gone.
  static bool goes(pid_t process) {
    for (int i = 0; i < 12000; ++i) {
      if (kill(process, 0) != 0 && errno == ESRCH) return true;
      const std::string stat = fs::exists(fmt::format("/proc/{}/stat", process))
                                   ? read_file(fmt::format("/proc/{}/stat", process))
                                   : std::string();
      if (stat.empty() || stat.find(") Z ") != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  fs::path folder_;
};

TEST_F(ChildProcess, BothStreamsGoToTheFileAndTheCodeTellsHowItEnded) {
  EXPECT_TRUE(run_program({"sh", "-c", "echo out; echo err >&2"}, output()));
  EXPECT_EQ(read_file(output()), "out\nerr\n");
  EXPECT_FALSE(run_program({"sh", "-c", "exit 3"}, output()));
  EXPECT_FALSE(run_program({"sh", "-c", "kill -9 $$"}, output()));
  EXPECT_TRUE(run_program({"sh", "-c", "test -z \"$(cat)\""}, output())) << "it reads nothing";
}

TEST_F(ChildProcess, AProgramThatIsNotThereIsNamed) {
  const std::string said = message([&] { run_program({"no-such-program"}, output()); });
  EXPECT_NE(said.find("no-such-program: cannot be run: No such file"), std::string::npos) << said;
}

TEST_F(ChildProcess, WhatPollThrowsEndsTheProgramAndItsChildren) {
  pid_t sleeper = 0;
  EXPECT_THROW(run_program(shell_with_a_child(), output(),
                           [&] {
                             sleeper = child();
                             throw std::runtime_error("enough");
                           }),
               std::runtime_error);
  EXPECT_TRUE(goes(sleeper));
}

TEST_F(ChildProcess, NothingOutlivesAProcessThatIsKilled) {
  const pid_t killed = fork();
  if (killed == 0) {
    run_program(shell_with_a_child(), output());
    _exit(0);
  }
  const pid_t sleeper = child();
  EXPECT_EQ(kill(sleeper, 0), 0);
  kill(killed, SIGKILL);
  waitpid(killed, nullptr, 0);
  EXPECT_TRUE(goes(sleeper));
}

}  // namespace
}  // namespace pyroclast
