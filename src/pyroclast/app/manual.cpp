#include "pyroclast/app/manual.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/nearest.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

struct ExitCode {
  int code;
  const char* meaning;
};

constexpr ExitCode kExitCodes[] = {
    {0, "The command did what it was asked for. A specimen that fails is a result, too."},
    {1, "Nothing came of it: the command line, the deck, a file or the disk. One line says what."},
    {2,
     "The run ended without what it was for: it did not come to rest or to the stated stress, a number was "
     "not finite, or its energy ledger does not close. summary.json says so. Of law --verify: a law fails."},
    {3,
     "The deck or the study names code that was not allowed (--allow-code); of check: all but the keys of "
     "that law was checked."},
    {130, "Ended by Ctrl-C or another signal; results so far and a checkpoint are kept."},
};

std::vector<const CLI::App*> commands(const CLI::App& cli) {
  return cli.get_subcommands([](const CLI::App*) { return true; });
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

/// Returns a text in which roff finds no commands.
std::string roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string roff_of(const CLI::Option& option) {
  std::string head = option.get_positional() ? option.get_name(true) : "";
  for (const auto& name : option.get_snames()) head += "-" + name + ", ";
  for (const auto& name : option.get_lnames()) head += "--" + name + ", ";
  if (head.ends_with(", ")) head.resize(head.size() - 2);
  head = roff(head);
  if (!option.get_positional() && option.get_items_expected_max() > 0) head += " \\fIVALUE\\fR";
  return fmt::format(".TP\n\\fB{}\\fR\n{}.\n", head, roff(option.get_description()));
}

std::string roff_of(const CLI::App& command) {
  std::string text = fmt::format(".SS {}\n{}.\n", roff(command.get_name()), roff(command.get_description()));
  for (const CLI::Option* option : command.get_options())
    if (option != command.get_help_ptr()) text += roff_of(*option);
  return text;
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

int print_manual(const CLI::App& cli) {
  const std::string description = cli.get_description();
  std::string text = fmt::format(".TH PYROCLAST 1 \"\" \"pyroclast {}\"\n", kVersion);
  text += fmt::format(".SH NAME\npyroclast \\- {}\n", roff(description.substr(description.find(": ") + 2)));
  text += ".SH SYNOPSIS\n\\fBpyroclast\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n";
  for (const CLI::App* command : commands(cli)) text += roff_of(*command);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodes) text += fmt::format(".TP\n{}\n{}\n", code, roff(meaning));
  text +=
      ".SH ENVIRONMENT\n.TP\nPYROCLAST_LAW_PATH\nFolders with contact laws of one\\(aqs own, separated by "
      "colons.\n";
  fmt::print("{}", text);
  return 0;
}

int print_completion(const CLI::App& cli) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands(cli)) names.push_back(command->get_name());
  std::string text = "_pyroclast() {\n  local word=${COMP_WORDS[COMP_CWORD]} options=\n";
  text += "  if ((COMP_CWORD == 1)); then\n";
  text +=
      fmt::format("    COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$word\"))\n    return\n  fi\n",
                  fmt::join(names, " "));
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : commands(cli))
    text += fmt::format("    {}) options=\"{}\" ;;\n", command->get_name(),
                        fmt::join(option_names(*command), " "));
  text +=
      "  esac\n  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n  "
      "else\n";
  text +=
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n  fi\n}\ncomplete -o filenames -F _pyroclast pyroclast\n";
  fmt::print("{}", text);
  return 0;
}

}  // namespace pyroclast::app
