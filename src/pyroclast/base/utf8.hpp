#pragma once

#include <cstddef>
#include <string_view>

namespace pyroclast {

/// Returns the number of bytes of the character with which a text begins; 0 if it is not UTF-8 (Unicode 15.0,
/// table 3-7).
std::size_t utf8_length(std::string_view text);

}  // namespace pyroclast
