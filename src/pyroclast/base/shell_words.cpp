#include "pyroclast/base/shell_words.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/characters.hpp"

namespace pyroclast {

namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) ||
         std::string_view("@%+=:,./_-").find(c) != std::string_view::npos;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

}  // namespace

std::string shell_word(std::string_view word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return std::string(word);
  const bool has_control = std::ranges::any_of(word, is_control);
  std::string quoted = has_control ? "$'" : "'";
  for (const char c : word) {
    if (has_control && (is_control(c) || c == '\'' || c == '\\'))
      quoted += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    else if (c == '\'')
      quoted += "'\"'\"'";
    else
      quoted += c;
  }
  return quoted + "'";
}

std::string shell_path(const std::filesystem::path& path) {
  const std::string text = path.string();
  return shell_word(text.starts_with('-') ? "./" + text : text);
}

std::string shell_command(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  std::ranges::transform(words, std::back_inserter(quoted),
                         [](const auto& word) { return shell_word(word); });
  return fmt::format("{}", fmt::join(quoted, " "));
}

}  // namespace pyroclast
