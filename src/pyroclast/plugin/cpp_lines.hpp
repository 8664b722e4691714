#pragma once

#include <string>
#include <vector>

namespace pyroclast {

/// Tells whether a character may stand in a name of C++.
bool is_of_name(char c);

/// Returns the lines of a C++ text as the preprocessor sees them: spliced, without comments, and raw strings
/// as empty ones.
std::vector<std::string> logical_lines(const std::string& text);

/// Returns a C++ text without comments, and with each literal as a blank.
std::string without_literals(const std::string& text);

}  // namespace pyroclast
