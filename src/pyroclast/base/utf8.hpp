#pragma once

#include <cstddef>
#include <string_view>

namespace pyroclast {

/// Bytes of the character that a text begins with; 0 if that is not UTF-8 (Unicode 15.0, table 3-7).
std::size_t utf8_length(std::string_view text);

}  // namespace pyroclast
