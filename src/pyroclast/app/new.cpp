#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/app/written_decks.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/shell_words.hpp"

namespace pyroclast::app {

namespace {

int make_deck(const std::string& name, const std::string& from, bool overwrite) {
  const auto found = std::ranges::find(kCases, from, &CaseDeck::name);
  if (found == std::end(kCases)) {
    std::vector<std::string> names;
    for (const CaseDeck& deck : kCases) names.emplace_back(deck.name);
    throw Error(fmt::format("--from {}: there is no such case{}; cases: {}", from,
                            did_you_mean(from, names, "; "), quoted_list(names)));
  }
  std::filesystem::path file = name;
  if (file.extension() != ".toml") file += ".toml";
  write_decks({{file, fmt::format("{}{}", kSchemaLine, found->text)}}, overwrite);
  say(fmt::format("Next:\n  pyroclast check {0}\n  pyroclast run {0}\n", shell_path(file)));
  return 0;
}

}  // namespace

Command add_new(CLI::App& cli) {
  struct Options {
    std::string name, from = "starter";
    bool overwrite = false;
  };
  const auto options = std::make_shared<Options>();
  auto* starter = cli.add_subcommand("new", "Write a commented deck to begin with");
  starter->add_option("NAME", options->name, "Name of the new deck: NAME.toml")->required();
  starter->add_option("--from", options->from, "Case to copy, see `pyroclast list cases`")
      ->capture_default_str();
  starter->add_flag("--overwrite", options->overwrite, kOverwriteDecks);
  return {starter,
          [options](const auto&) { return make_deck(options->name, options->from, options->overwrite); }};
}

}  // namespace pyroclast::app
