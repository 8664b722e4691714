#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pyroclast::app {

/// Describes the fault of a command line, with the nearest word where a word was not known.
/// \param words  as typed, without the program's name
std::string what_is_wrong(const CLI::App& cli, const CLI::ParseError& error,
                          const std::vector<std::string>& words);

}  // namespace pyroclast::app
