#pragma once

#include <optional>
#include <string>

namespace pyroclast {

/// Returns a variable of the environment; empty where the variable is not set.
std::string environment(const char* name);

/// Returns the whole number that a variable of the environment holds; none where it holds another text.
std::optional<int> number_in_environment(const char* name);

/// Takes the current folder out of the environment, for this process and those that it starts: of variables
/// that say where programs, libraries, headers and settings lie, only absolute paths stay. An empty entry, as
/// in `CPATH=:/opt/include`, means the current folder to the compiler.
void forget_current_folder();

}  // namespace pyroclast
