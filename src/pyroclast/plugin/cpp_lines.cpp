#include "pyroclast/plugin/cpp_lines.hpp"

#include <cctype>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Returns the name, or the number, that ends before a place.
std::string name_before(const std::string& text, std::size_t end) {
  std::size_t begin = end;
  while (begin > 0 && is_of_name(text[begin - 1])) --begin;
  return text.substr(begin, end - begin);
}

/// Tells whether the name before a quote makes a raw string of it.
bool is_raw(const std::string& name) {
  return name == "R" || name == "u8R" || name == "uR" || name == "UR" || name == "LR";
}

}  // namespace

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string without_literals(const std::string& text) {
  std::string code;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const std::string name = c == '"' || c == '\'' ? name_before(text, i) : "";
    const bool separates =
        c == '\'' && !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) != 0;
    if ((c != '"' && c != '\'') || separates) {  // 1'000 is a number
      code += c;
      continue;
    }
    const auto open = text.find('(', i);
    if (c == '"' && is_raw(name) && open != std::string::npos) {
      const std::string ending = fmt::format("){}\"", text.substr(i + 1, open - i - 1));
      const auto close = text.find(ending, open);
      i = close == std::string::npos ? text.size() : close + ending.size() - 1;
    } else {
      for (++i; i < text.size() && text[i] != c && text[i] != '\n'; ++i) i += text[i] == '\\';
    }
    code += ' ';
  }
  return code;
}

}  // namespace pyroclast
