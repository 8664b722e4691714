#include "pyroclast/app/command_names.hpp"

#include <algorithm>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "pyroclast/app/cases.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/python_package.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

struct ExitCode {
  int code;
  const char* meaning;
};

constexpr ExitCode kExitCodes[] = {
    {0, "The command succeeded. A specimen that fails is a result, too."},
    {1,
     "The command failed, because of the command line, the deck, a file or the disk. One line gives the "
     "reason."},
    {2,
     "The run ended and missed its aim: the body did not come to rest or to the stated stress, a number was "
     "not finite, or the energy ledger does not close. summary.json says so. Of law --verify: a law fails."},
    {3,
     "The deck or the study names code that was not allowed (--allow-code); of check: all keys but that "
     "law's were checked."},
    {kInterrupted, "Ended by Ctrl-C or another signal; results so far and a checkpoint are kept."},
};

/// Returns the commands that users see.
std::vector<const CLI::App*> commands(const CLI::App& cli) {
  return cli.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Returns the long and short names of options, "--out" and "-o".
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

nlohmann::ordered_json described(const CLI::Option& option) {
  nlohmann::ordered_json names = nlohmann::json::array();
  for (const auto& name : option.get_snames()) names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) names.push_back("--" + name);
  const bool has_value = option.get_positional() || option.get_items_expected_max() > 0;
  return {{"names", names},
          {"meaning", option.get_description()},
          {"value", !has_value                ? ""
                    : option.get_positional() ? option.get_name(true)
                                              : "VALUE"}};
}

nlohmann::ordered_json described(const CLI::App& command) {
  nlohmann::ordered_json options = nlohmann::json::array();
  for (const CLI::Option* option : command.get_options())
    if (option != command.get_help_ptr()) options.push_back(described(*option));
  return {{"name", command.get_name()}, {"meaning", command.get_description()}, {"options", options}};
}

/// Prints as JSON all that may stand on the command line: commands, options, keys of decks, cases; and the
/// exit codes. The package for Python writes the manual page and the completions from it, and adds its own
/// commands.
int print_commands(const CLI::App& cli) {
  const std::string description = cli.get_description();
  nlohmann::ordered_json exit_codes, listed = nlohmann::json::array(), cases = listed;
  for (const auto& [code, meaning] : kExitCodes) exit_codes[std::to_string(code)] = meaning;
  for (const CLI::App* command : commands(cli)) listed.push_back(described(*command));
  for (const CaseDeck& deck : kCases) cases.push_back(deck.name);
  const nlohmann::ordered_json all = {{"version", kVersion},
                                      {"meaning", description.substr(description.find(": ") + 2)},
                                      {"commands", listed},
                                      {"exit_codes", exit_codes},
                                      {"deck_keys", key_paths(true)},
                                      {"lists", names_of_lists()},
                                      {"cases", cases}};
  fmt::print("{}\n", all.dump(1));
  return 0;
}

}  // namespace

std::string what_is_wrong(const CLI::App& cli, const CLI::ParseError& error,
                          const std::vector<std::string>& words) {
  std::vector<std::string> names;
  const CLI::App* command = nullptr;
  for (const CLI::App* each : commands(cli)) names.push_back(each->get_name());
  std::vector<std::string> known = option_names(cli);
  for (const std::string& word : words) {
    if (command == nullptr && !word.starts_with('-')) {
      const auto found = std::ranges::find(names, word);
      if (found == names.end())
        return fmt::format("\"{}\" is no command{}; commands: {}", word, did_you_mean(word, names, "; "),
                           fmt::join(names, ", "));
      command = commands(cli)[found - names.begin()];
      known = option_names(*command);
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    if (name.starts_with("--") && std::ranges::find(known, name) == known.end())
      return fmt::format("\"{}\" is no option{}{}", name,
                         command ? " of " + command->get_name() : std::string(),
                         did_you_mean(name, known, "; "));
  }
  if (command == nullptr) return fmt::format("a command is needed: {}", fmt::join(names, ", "));
  return fmt::format("{}: {}; pyroclast {} --help tells more", command->get_name(), error.what(),
                     command->get_name());
}

Command add_manual(CLI::App& cli) {
  auto* command = cli.add_subcommand("manual", "Print the manual page, for man");
  return {command, [](const auto&) -> int { become_package("pyroclast.manual", {own_program(), "manual"}); }};
}

Command add_completion(CLI::App& cli) {
  const auto shell = std::make_shared<std::string>("bash");
  auto* completion = cli.add_subcommand("completion", "Print the completion of a shell for this program");
  completion->add_option("SHELL", *shell, "bash or zsh")->capture_default_str();
  return {completion, [shell](const auto&) -> int {
            if (*shell != "bash" && *shell != "zsh")
              throw Error(fmt::format("completion {}: shells: bash, zsh", *shell));
            become_package("pyroclast.manual", {own_program(), *shell});
          }};
}

Command add_commands(CLI::App& cli) {
  auto* command = cli.add_subcommand("commands", "Print all commands as JSON")->group("");
  return {command, [&cli](const auto&) { return print_commands(cli); }};
}

}  // namespace pyroclast::app
