#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pyroclast::app {

/// Describes the fault of a command line, with the nearest word where a word was not known.
/// \param words  as typed, without the program's name
std::string what_is_wrong(const CLI::App& cli, const CLI::ParseError& error,
                          const std::vector<std::string>& words);

/// Prints the manual page in roff, made from the commands and options of the program.
int print_manual(const CLI::App& cli);

/// Prints a completion for bash, made from the commands and options of the program.
int print_completion(const CLI::App& cli);

}  // namespace pyroclast::app
