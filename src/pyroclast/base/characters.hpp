#pragma once

#include <string>
#include <string_view>

namespace pyroclast {

/// Tells whether a character is a digit from 0 to 9, whatever the locale.
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the small letter of a letter from A to Z, whatever the locale; another character stays.
constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = lower_case(c);
  return small;
}

}  // namespace pyroclast
