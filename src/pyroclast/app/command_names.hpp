#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pyroclast::app {

/// Describes the fault of a command line, with the nearest word where a word was not known.
/// \param words  as typed, without the program's name
std::string what_is_wrong(const CLI::App& cli, const CLI::ParseError& error,
                          const std::vector<std::string>& words);

/// Prints as JSON all that may stand on the command line: commands, options, keys of decks, cases; and the
/// exit codes. The package for Python writes the manual page and the completions from it, and adds its own
/// commands.
int print_commands(const CLI::App& cli);

/// Prints the manual page in roff.
[[noreturn]] int manual();
/// Prints the completion of a shell, bash or zsh.
int completion(const std::string& shell);

}  // namespace pyroclast::app
