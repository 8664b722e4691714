#include "pyroclast/deck/toml_characters.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "pyroclast/base/utf8.hpp"

namespace pyroclast {
namespace {

constexpr int kMostDepth = 256;  // as toml++ allows for brackets; parts of keys take its stack unchecked

/// Scanner that follows a text into its strings and comments and out of them, as far as it is TOML: toml++
/// goes no further either. A quote opens a string where a key or a value begins, and nowhere else.
class Scanner {
 public:
  /// Tells whether the next character may be outside of ASCII.
  bool may_be_foreign() const { return (in_comment_ || quote_ != '\0') && !behind_backslash_; }

  /// Goes behind the next character, or behind the next quotes where several belong together.
  /// \param length  length of the next character, bytes
  /// \return bytes passed
  std::size_t pass(std::string_view rest, std::size_t length) {
    const char c = rest.front();
    if (in_comment_ && c != '\n') return length;
    in_comment_ = false;
    return quote_ != '\0' ? pass_in_string(rest, length) : pass_outside(rest, length);
  }

  /// Returns the number of levels at which the next character lies.
  int depth() const {
    return std::accumulate(parts_above_.begin(), parts_above_.end(),
                           header_parts_ + parts_ + static_cast<int>(open_.size()));
  }

 private:
  static std::size_t quotes(std::string_view rest) {
    return std::min(rest.find_first_not_of(rest.front()), rest.size());
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::size_t pass_in_string(std::string_view rest, std::size_t length) {
    const char c = rest.front();
    const bool was_escaped = escaped_;
    escaped_ = false;
    behind_backslash_ = behind_backslash_ && is_blank(c);
    if (was_escaped) return length;
    if (quote_ == '"' && c == '\\') escaped_ = behind_backslash_ = true;
    if (c == '\n' && !has_lines_) quote_ = '\0';  // an error that toml++ finds
    if (c != quote_) return length;
    // Three quotes end a string of several lines; up to two more before them are part of it.
    const std::size_t count = quotes(rest);
    if (has_lines_ && count < 3) return count;
    quote_ = '\0';
    return has_lines_ ? std::min<std::size_t>(count, 5) : 1;
  }

  std::size_t pass_outside(std::string_view rest, std::size_t length) {
    const char c = rest.front();
    in_comment_ = c == '#';
    if ((c == '"' || c == '\'') && !has_begun_) {
      quote_ = c;
      has_lines_ = is_value() && quotes(rest) >= 3;
      has_begun_ = true;
      return has_lines_ ? 3 : 1;
    }
    follow_structure(c);
    return length;
  }

  bool is_value() const { return behind_equals_ || open_.ends_with('['); }

  void follow_structure(char c) {
    const bool value = is_value();
    if (!value && c == '.') ++parts_;
    if (c == '\n' && open_.empty()) {
      if (is_header_) header_parts_ = parts_;
      behind_equals_ = has_begun_ = is_header_ = false;
      parts_ = 0;
    } else if (c == ',' || (!value && (c == '=' || c == '.'))) {
      behind_equals_ = c == '=';
      has_begun_ = false;
      if (c == ',') parts_ = 0;
    } else if ((c == '[' || c == '{') && !(value && has_begun_)) {
      if (value) {
        open_ += c;
        parts_above_.push_back(parts_);
        parts_ = 0;
      } else {
        is_header_ = true;
        header_parts_ = 0;
      }
      behind_equals_ = has_begun_ = false;
    } else if (c == ']' || c == '}') {
      if (!open_.empty()) {
        open_.pop_back();
        parts_ = parts_above_.back();
        parts_above_.pop_back();
      }
      behind_equals_ = has_begun_ = true;
    } else if (!is_blank(c)) {
      has_begun_ = true;
    }
  }

  bool in_comment_ = false;
  char quote_ = '\0';              ///< quote of the string at hand; '\0' outside of strings
  bool has_lines_ = false;         ///< true where that string may have several lines
  bool escaped_ = false;           ///< true where the next character follows a backslash ...
  bool behind_backslash_ = false;  ///< true where it follows a backslash, or blanks behind one
  std::string open_;               ///< open brackets of arrays and inline tables
  std::vector<int> parts_above_;   ///< parts of the key before each of these, without its first
  int parts_ = 0;                  ///< parts of the key at hand, without its first
  int header_parts_ = 0;           ///< parts of the name of the table at hand, without its first
  bool is_header_ = false;         ///< true where this line names a table
  bool behind_equals_ = false;
  bool has_begun_ = false;  ///< true where the key, a part of it, or the value has begun
};

}  // namespace

std::optional<CharacterFault> character_fault(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  SourcePosition at{1, 1};
  Scanner scanner;
  for (std::size_t i = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    const std::size_t length = utf8_length(rest);
    if (length == 0) return CharacterFault{at, "the text is not UTF-8 here; save the file as UTF-8"};
    if (rest.starts_with(byte_order_mark))
      return CharacterFault{at,
                            "a byte-order mark stands here; only at the beginning of a file is it allowed"};
    if (length > 1 && !scanner.may_be_foreign())
      return CharacterFault{at, "a character outside of ASCII stands here; it needs quotes around it"};
    const std::size_t passed = scanner.pass(rest, length);
    if (rest.front() == '.' && scanner.depth() > kMostDepth)
      return CharacterFault{at, "keys and tables lie deeper in one another here than 256 levels"};
    const int characters = length > 1 ? 1 : static_cast<int>(passed);
    at = rest.front() == '\n' ? SourcePosition{at.line + 1, 1}
                              : SourcePosition{at.line, at.column + characters};
    i += passed;
  }
  return std::nullopt;
}

}  // namespace pyroclast
