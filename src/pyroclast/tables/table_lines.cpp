#include "pyroclast/tables/table_lines.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/base/utf8.hpp"

namespace pyroclast {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kUnbreakableBlank = "\xC2\xA0";
constexpr std::size_t kMostOfALine = 60;  ///< most characters of a line in a message

std::string way_to_utf8(const std::filesystem::path& path, std::string_view encoding) {
  const std::string name = path.filename().string();
  return fmt::format("write `iconv -f {} -t UTF-8 {} > {}` and name that file", encoding, shell_path(name),
                     shell_word("utf8_" + name));
}

int line_of(std::string_view bytes, std::size_t place) {
  int line = 1;
  for (std::size_t i = 0; i < place; ++i)
    if (bytes[i] == '\n' || (bytes[i] == '\r' && bytes[i + 1] != '\n')) ++line;
  return line;
}

void require_utf8(std::string_view bytes, const std::filesystem::path& path) {
  const std::size_t zero = bytes.find('\0');
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    refuse(path, 0, fmt::format("is UTF-16, not UTF-8; {}", way_to_utf8(path, "UTF-16")));
  if (zero == 0 || zero == 1)  // in UTF-16 every other byte of Latin letters is 0
    refuse(path, 0,
           fmt::format("is UTF-16 without a mark, not UTF-8; {}",
                       way_to_utf8(path, zero == 0 ? "UTF-16BE" : "UTF-16LE")));
  if (zero != bytes.npos) refuse(path, line_of(bytes, zero), "holds a byte 0; it is not a text");
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = utf8_length(bytes.substr(i));
    if (length == 0)
      refuse(path, line_of(bytes, i),
             fmt::format("byte 0x{:02X} is not UTF-8, but of Latin-1 or Windows; {}",
                         static_cast<unsigned char>(bytes[i]), way_to_utf8(path, "WINDOWS-1252")));
    i += length;
  }
}

/// Tells whether a line is a comment. A cell that is "%" alone is a unit, not the begin of a comment.
bool is_comment(std::string_view line) {
  if (line.starts_with('%')) return line.size() == 1 || std::string_view(";,\t").find(line[1]) == line.npos;
  return line.starts_with('#') || line.starts_with('!') || line.starts_with("//");
}

/// Returns the delimiter of "sep=;", as spreadsheets write and read it.
std::optional<char> stated_delimiter(std::string_view line) {
  if (line.starts_with('"') && line.ends_with('"') && line.size() > 1) line = line.substr(1, line.size() - 2);
  return lower_case(line.substr(0, 4)) == "sep=" && line.size() == 5 ? std::optional(line[4]) : std::nullopt;
}

}  // namespace

void refuse(const std::filesystem::path& path, int line, const std::string& what) {
  throw Error(line == 0 ? fmt::format("{}: {}", path.string(), what)
                        : fmt::format("{}:{}: {}", path.string(), line, what));
}

std::string as_written(std::string_view text) {
  return fmt::format("\"{}\"", shown_in_short(text, kMostOfALine));
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::array<std::string_view, 3> kBlanks{" ", "\t", kUnbreakableBlank};
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const std::string_view blank : kBlanks) {
      if (text.starts_with(blank)) text.remove_prefix(blank.size()), goes_on = true;
      if (text.ends_with(blank)) text.remove_suffix(blank.size()), goes_on = true;
    }
  }
  return text;
}

TableLines table_lines(std::string_view bytes, const std::filesystem::path& path) {
  require_utf8(bytes, path);
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  TableLines result;
  for (int number = 1; !bytes.empty(); ++number) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const std::string_view line = bytes.substr(0, end), written = without_blanks(line);
    bytes.remove_prefix(end);
    bytes.remove_prefix(bytes.starts_with("\r\n") ? 2 : bytes.empty() ? 0 : 1);
    if (number == 1 && (result.delimiter = stated_delimiter(line))) continue;
    if (written.empty()) continue;
    if (!is_comment(written)) {
      result.lines.push_back({number, line});
    } else if (result.lines.empty()) {
      result.above = {number, written.substr(std::min(written.find_first_not_of("#%!/"), written.size()))};
      result.above_may_begin_with_unit = written.starts_with('%');
    }
  }
  return result;
}

}  // namespace pyroclast
