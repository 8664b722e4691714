#include <algorithm>
#include <initializer_list>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/own_program.hpp"

namespace pyroclast::app {

namespace {

/// Goes on as the program of studies, see the Python package.
/// \param words  as typed
[[noreturn]] void study(const std::vector<std::string>& words) {
  std::vector<std::string> all{"--program", own_program()};
  all.insert(all.end(), words.begin(), words.end());
  become_package("pyroclast.study", all);
}

}  // namespace

void scatter(const RunOptions& o) {
  if (o.watch || o.overwrite || o.checkpoint || !o.instructions.empty() || !o.laws.folders.empty() ||
      std::ranges::find(o.changes, "output.fields=false") != o.changes.end())
    throw Error(
        "--seeds: --watch, --overwrite, --checkpoint, --instructions, --law-path and --no-fields have no "
        "meaning "
        "beside it: specimens that are done are kept, and each leaves its history");
  std::vector<std::string> words{"scatter", o.deck.string(), "--seeds", std::to_string(o.seeds)};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (o.seed) add({"--seed", std::to_string(*o.seed)});
  for (const std::string& change : o.changes) add({"--set", change});
  if (!o.out.empty()) add({"--out", o.out.string()});
  if (o.threads > 0) add({"--jobs", std::to_string(o.threads)});
  if (o.dry_run) add({"--dry-run"});
  if (!o.figures) add({"--no-figures"});
  if (o.speech == Speech::quiet) add({"--quiet"});
  if (o.laws.allow_code) add({"--allow-code"});
  study(words);
}

Command add_study(CLI::App& cli) {
  auto* command = add_passed_on(
      cli, "study",
      "Many runs: scatter, sensitivity, calibration: study run|check|status|table|report STUDY");
  return {command, [=](const auto&) -> int { study(command->remaining()); }};
}

Command add_converge(CLI::App& cli) {
  auto* command = add_passed_on(cli, "converge",
                                "Tell how far results move with half the rate, half the exchange step, "
                                "and half and double the block size: converge DECK");
  return {command, [=](const auto&) -> int {
            std::vector<std::string> words = command->remaining();
            words.insert(words.begin(), "converge");
            study(words);
          }};
}

}  // namespace pyroclast::app
