#include "pyroclast/base/shown.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pyroclast/base/utf8.hpp"

namespace pyroclast {

namespace {

/// Returns the first character of a text, which has so many bytes.
char32_t code_of(std::string_view text, std::size_t bytes) {
  char32_t code = static_cast<unsigned char>(text[0]) & (bytes == 1 ? 0x7fU : 0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3fU);
  return code;
}

bool acts_on_terminals(char32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x061c || c == 0x200e || c == 0x200f ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069) || c == 0xfeff;
}

std::string escaped(char32_t c) {
  if (c == U'\n') return "\\n";
  if (c == U'\t') return "\\t";
  if (c == U'\r') return "\\r";
  return c < 0x100 ? fmt::format("\\x{:02x}", static_cast<unsigned>(c))
                   : fmt::format("\\u{:04x}", static_cast<unsigned>(c));
}

}  // namespace

std::string shown(std::string_view text, bool keep_lines) {
  std::string all;
  while (!text.empty()) {
    const std::size_t bytes = utf8_length(text);
    const char32_t c = bytes > 0 ? code_of(text, bytes) : 0;
    if (bytes == 0)
      all += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    else if (acts_on_terminals(c) && !(keep_lines && (c == U'\n' || c == U'\t')))
      all += escaped(c);
    else
      all += text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(1, bytes));
  }
  return all;
}

std::string shown_in_short(std::string_view text, std::size_t most) {
  std::size_t count = 0, cut = text.size();
  for (std::size_t end = 0; end < text.size(); end += std::max<std::size_t>(1, utf8_length(text.substr(end))))
    if (count++ == most) cut = end;
  if (count <= most) return shown(text);
  return fmt::format("{}... ({} characters)", shown(text.substr(0, cut)), count);
}

}  // namespace pyroclast
