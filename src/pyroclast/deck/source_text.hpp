#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// A place in a text: line and column from 1, the column in Unicode characters.
struct SourcePosition {
  int line = 0;
  int column = 0;
};

/// A text by lines.
class SourceText {
 public:
  explicit SourceText(std::string text);

  const std::string& text() const { return text_; }
  int line_count() const { return static_cast<int>(line_starts_.size()); }
  /// The line without its end; empty outside the text.
  std::string_view line(int number) const;
  /// The text from `begin` up to `end`; of several lines only the first, with "..." behind it.
  std::string excerpt(SourcePosition begin, SourcePosition end) const;
  /// The whole text with another one from `begin` up to `end`.
  std::string replaced(SourcePosition begin, SourcePosition end, std::string_view replacement) const;

 private:
  std::size_t offset(SourcePosition position) const;

  std::string text_;
  std::vector<std::size_t> line_starts_;
};

}  // namespace pyroclast
