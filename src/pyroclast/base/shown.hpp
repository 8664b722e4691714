#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pyroclast {

/// Number of characters of a value that messages show.
inline constexpr std::size_t kMostShown = 120;

/// Returns a text from elsewhere in a form that is safe on a terminal: control characters, marks that turn
/// the direction of writing, and bytes that are no UTF-8 are written out ("\\n", "\\x1b", "\\u202e").
/// \param keep_lines  true keeps line breaks and tabs
std::string shown(std::string_view text, bool keep_lines = false);

/// Returns the text as `shown` does. A text longer than `most` characters is cut, and its length is added.
std::string shown_in_short(std::string_view text, std::size_t most = kMostShown);

}  // namespace pyroclast
