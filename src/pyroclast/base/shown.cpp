#include "pyroclast/base/shown.hpp"

#include <array>

#include <fmt/format.h>

namespace pyroclast {

namespace {

constexpr char32_t kNone = 0xffffffff;
constexpr std::size_t kMostBytes = 4;  // of a character

/// The first character of a text and how many bytes it has; kNone and 1 where it is no UTF-8.
std::pair<char32_t, std::size_t> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t count = lead >= 0xf0 && lead < 0xf5   ? 4
                            : lead >= 0xe0 && lead < 0xf0 ? 3
                            : lead >= 0xc2 && lead < 0xe0 ? 2
                                                          : 0;
  if (count == 0 || text.size() < count) return {kNone, 1};
  char32_t code = lead & (0x7fU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {kNone, 1};
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<char32_t, kMostBytes + 1> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[count] || is_surrogate || code > 0x10ffff) return {kNone, 1};
  return {code, count};
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
    const auto [c, bytes] = first_character(text);
    if (c == kNone)
      all += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    else if (acts_on_terminals(c) && !(keep_lines && (c == U'\n' || c == U'\t')))
      all += escaped(c);
    else
      all += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return all;
}

std::string shown_in_short(std::string_view text, std::size_t most) {
  std::size_t end = 0, count = 0, cut = text.size();
  while (end < text.size()) {
    if (count++ == most) cut = end;
    end += first_character(text.substr(end)).second;
  }
  if (count <= most) return shown(text);
  return fmt::format("{}... ({} characters)", shown(text.substr(0, cut)), count);
}

}  // namespace pyroclast
