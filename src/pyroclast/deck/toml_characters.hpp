#pragma once

#include <optional>
#include <string_view>

#include "pyroclast/deck/source_text.hpp"

namespace pyroclast {

/// Character that must not stand where it does.
struct CharacterFault {
  SourcePosition at;
  const char* what = nullptr;
};

/// Finds the first character of a TOML text that is not UTF-8, is a byte-order mark behind the beginning, or
/// is outside of ASCII in neither a string nor a comment. toml++ 3.3 must not be given such a text: it stops
/// the process at the first two and reaches undefined behaviour at the third. A character outside of ASCII
/// that follows a backslash, with or without blanks between them, also causes undefined behaviour; it is a
/// fault here too.
std::optional<CharacterFault> character_fault(std::string_view text);

}  // namespace pyroclast
