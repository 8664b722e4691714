#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/wait.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/interrupt.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/folder_lock.hpp"

namespace pyroclast::app {

namespace {

constexpr const char* kFigures = "pyroclast.figures";
constexpr const char* kReport = "pyroclast.report";

/// Runs a module of the package; returns its exit code, -1 if it was ended, or none where Python cannot be
/// run.
std::optional<int> draw(
    const char* module, const std::vector<std::string>& words, Speech speech = Speech::usual,
    const std::function<bool()>& skip = [] { return false; }) {
  if (skip()) return -1;
  const auto child = start_package(module, words, {.prints = speech != Speech::quiet});
  if (!child) return std::nullopt;
  const int status = wait_for(*child, skip);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int figures(const std::vector<std::string>& words) {
  std::optional<FolderLock> lock;  // for a run whose own figures are drawn; others are only read
  const auto is_out = [](const std::string& word) { return word == "--out" || word.starts_with("--out="); };
  if (words.size() >= 2 && (words[0] == "run" || words[0] == "plane") &&
      std::ranges::none_of(words, is_out) && std::filesystem::is_directory(words[1]))
    lock.emplace(words[1]);
  const Interrupt interrupt;  // Python is ended first: it removes a figure that is not whole
  const auto code = draw(kFigures, words, Speech::usual, [&] { return interrupt.asked(); });
  if (!code) throw Error(no_python());
  if (interrupt.asked()) return kInterrupted;
  return *code == 0 ? 0 : 1;
}

}  // namespace

void draw_figures(const std::string& what, const std::filesystem::path& folder, Speech speech,
                  const std::function<bool()>& skip) {
  const auto code = draw(kFigures, {what, folder.string()}, speech, skip);
  if (code == 0) return;
  say_aside(
      fmt::format("warning: no figures were drawn{}; the results are complete without them.\n"
                  "To draw them later: pyroclast figures {} {}\n",
                  code ? "" : ": " + no_python(), what, shell_path(folder)));
}

void make_page(const std::filesystem::path& folder, Speech speech, const std::function<bool()>& skip) {
  const auto code = draw(kReport, {folder.string()}, speech, skip);
  if (code == 0) return;
  say_aside(
      fmt::format("warning: no page was made{}; the results are complete without it.\n"
                  "To make it later: pyroclast report {}\n",
                  code ? "" : ": " + no_python(), shell_path(folder)));
}

Command add_figures(CLI::App& cli) {
  auto* command = add_passed_on(
      cli, "figures",
      "Draw the figures of a run again, or several runs in one figure: figures compare RUN... --out FILE");
  return {command, [=](const auto&) { return figures(command->remaining()); }};
}

Command add_report(CLI::App& cli) {
  auto* command = add_passed_on(
      cli, "report", "Make the page of a run, one HTML file for any browser: report RUN [--out FILE]");
  return {command, [=](const auto&) -> int { become_package(kReport, command->remaining()); }};
}

}  // namespace pyroclast::app
