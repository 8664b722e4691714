#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast::app {

int make_deck(const std::string& name, const std::string& from) {
  const auto found = std::ranges::find(kCases, from, &CaseDeck::name);
  if (found == std::end(kCases)) {
    std::vector<std::string> names;
    for (const CaseDeck& deck : kCases) names.emplace_back(deck.name);
    throw Error(fmt::format("--from {}: there is no such case{}; cases: {}", from,
                            did_you_mean(from, names, "; "), quoted_list(names)));
  }
  std::filesystem::path file = name;
  if (file.extension() != ".toml") file += ".toml";
  if (std::filesystem::exists(file))
    throw Error(
        fmt::format("{}: exists already, so it is not overwritten; choose another name", file.string()));
  write_text_file(file, fmt::format("{}{}", kSchemaLine, found->text));
  say(fmt::format("{0} is written. Next:\n  pyroclast check {1}\n  pyroclast run {1}\n", file.string(),
                  shell_path(file)));
  return 0;
}

}  // namespace pyroclast::app
