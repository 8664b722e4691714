#include <algorithm>
#include <initializer_list>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/own_program.hpp"

namespace pyroclast::app {

void study(const std::vector<std::string>& words) {
  std::vector<std::string> all{"--program", own_program()};
  all.insert(all.end(), words.begin(), words.end());
  become_package("pyroclast.study", all);
}

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

}  // namespace pyroclast::app
