#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pyroclast::app {

/// What is wrong with a command line, with the nearest word where one was not known.
/// \param words  as typed, without the program's name
std::string what_is_wrong(const CLI::App& cli, const CLI::ParseError& error,
                          const std::vector<std::string>& words);

/// The manual page in roff, made of the commands and options of the program.
int print_manual(const CLI::App& cli);

/// A completion for bash, likewise.
int print_completion(const CLI::App& cli);

}  // namespace pyroclast::app
