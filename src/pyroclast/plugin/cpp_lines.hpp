#pragma once

#include <string>

namespace pyroclast {

/// Tells whether a character may stand in a name of C++.
bool is_of_name(char c);

/// Returns a preprocessed C++ text, which has no comments, with each literal as a blank.
std::string without_literals(const std::string& text);

}  // namespace pyroclast
