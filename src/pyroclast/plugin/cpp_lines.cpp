#include "pyroclast/plugin/cpp_lines.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace pyroclast {

namespace {

/// Tells whether a raw string begins at an R, one that no other name ends with.
bool begins_raw_string(const std::string& text, std::size_t r) {
  if (text.compare(r, 2, "R\"") != 0 || text.find('(', r) == std::string::npos) return false;
  std::size_t begin = r;
  while (begin > 0 && is_of_name(text[begin - 1])) --begin;
  const std::string prefix = text.substr(begin, r - begin);
  return prefix.empty() || prefix == "u8" || prefix == "u" || prefix == "U" || prefix == "L";
}

}  // namespace

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::vector<std::string> logical_lines(const std::string& text) {
  std::string spliced;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t end = text[i] == '\\' && text.compare(i + 1, 1, "\r") == 0 ? i + 2 : i + 1;
    if (text[i] == '\\' && text.compare(end, 1, "\n") == 0)
      i = end;
    else
      spliced += text[i];
  }
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < spliced.size();) {
    const auto take_to = [&](std::size_t end) {
      lines.back() += spliced.substr(i, end - i);
      i = std::min(end, spliced.size());
    };
    if (spliced.compare(i, 2, "//") == 0) {
      i = std::min(spliced.find('\n', i), spliced.size());
    } else if (spliced.compare(i, 2, "/*") == 0) {
      const auto end = spliced.find("*/", i + 2);
      i = end == std::string::npos ? spliced.size() : end + 2;
      lines.back() += ' ';
    } else if (begins_raw_string(spliced, i)) {
      const auto open = spliced.find('(', i);
      const auto close = spliced.find(fmt::format("){}\"", spliced.substr(i + 2, open - i - 2)), open);
      i = close == std::string::npos ? spliced.size() : close + 1 + (open - i - 2) + 1;
      lines.back() += "\"\"";
    } else if (spliced[i] == '"' || spliced[i] == '\'') {
      std::size_t end = i + 1;
      while (end < spliced.size() && spliced[end] != spliced[i] && spliced[end] != '\n')
        end += spliced[end] == '\\' ? 2 : 1;
      take_to(end + 1);
    } else if (spliced[i] == '\n') {
      lines.emplace_back();
      ++i;
    } else {
      take_to(i + 1);
    }
  }
  return lines;
}

std::string without_literals(const std::string& text) {
  std::string code;
  for (const std::string& line : logical_lines(text)) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      // a quote behind a digit separates thousands
      const bool opens = line[i] == '"' || (line[i] == '\'' && (i == 0 || !is_of_name(line[i - 1])));
      if (!opens) {
        code += line[i];
        continue;
      }
      const char quote = line[i];
      for (++i; i < line.size() && line[i] != quote; ++i) i += line[i] == '\\';
      code += ' ';
    }
    code += '\n';
  }
  return code;
}

}  // namespace pyroclast
