#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast::app {

namespace {

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

}  // namespace

Command add_new(CLI::App& cli) {
  struct Options {
    std::string name, from = "starter";
  };
  const auto options = std::make_shared<Options>();
  auto* starter = cli.add_subcommand("new", "Write a commented deck to begin with");
  starter->add_option("NAME", options->name, "Name of the new deck: NAME.toml")->required();
  starter->add_option("--from", options->from, "Case to copy, see `pyroclast list cases`")
      ->capture_default_str();
  return {starter, [options](const auto&) { return make_deck(options->name, options->from); }};
}

}  // namespace pyroclast::app
