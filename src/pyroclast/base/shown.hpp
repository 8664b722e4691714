#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pyroclast {

/// Characters of a value that messages show.
inline constexpr std::size_t kMostShown = 120;

/// A text from elsewhere as a terminal may show it: control characters, marks that turn the direction of
/// writing, and bytes that are no UTF-8 are written out ("\\n", "\\x1b", "\\u202e").
/// \param keep_lines  line breaks and tabs stay
std::string shown(std::string_view text, bool keep_lines = false);

/// The same, cut after so many characters, with how many there are.
std::string shown_in_short(std::string_view text, std::size_t most = kMostShown);

}  // namespace pyroclast
