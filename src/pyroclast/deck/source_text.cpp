#include "pyroclast/deck/source_text.hpp"

#include <utility>

namespace pyroclast {
namespace {

/// Returns the byte at which the character of a column begins in a line of UTF-8.
std::size_t byte_of_column(std::string_view line, int column) {
  std::size_t byte = 0;
  for (int passed = 1; passed < column && byte < line.size(); ++passed) {
    ++byte;
    while (byte < line.size() && (static_cast<unsigned char>(line[byte]) & 0xC0U) == 0x80U) ++byte;
  }
  return byte;
}

}  // namespace

SourceText::SourceText(std::string text) : text_(std::move(text)), line_starts_{0} {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
}

std::string_view SourceText::line(int number) const {
  if (number < 1 || static_cast<std::size_t>(number) > line_starts_.size()) return {};
  const std::string_view rest =
      std::string_view(text_).substr(line_starts_[static_cast<std::size_t>(number) - 1]);
  const std::string_view line = rest.substr(0, rest.find('\n'));
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

std::string SourceText::excerpt(SourcePosition begin, SourcePosition end) const {
  const std::string_view first = line(begin.line);
  const std::size_t from = byte_of_column(first, begin.column);
  if (end.line != begin.line) return std::string(first.substr(from)) + " ...";
  return std::string(first.substr(from, byte_of_column(first, end.column) - from));
}

std::size_t SourceText::offset(SourcePosition position) const {
  const std::size_t start = line_starts_.at(static_cast<std::size_t>(position.line) - 1);
  return start + byte_of_column(line(position.line), position.column);
}

std::string SourceText::replaced(SourcePosition begin, SourcePosition end,
                                 std::string_view replacement) const {
  return text_.substr(0, offset(begin)) + std::string(replacement) + text_.substr(offset(end));
}

}  // namespace pyroclast
