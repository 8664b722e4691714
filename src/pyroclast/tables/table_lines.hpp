#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// Line of a table that is neither blank nor a comment.
struct TableLine {
  int number;  ///< line number in the file, from 1
  std::string_view text;
};

/// Lines of a table without blank lines and comments (#, %, !, //).
struct TableLines {
  std::vector<TableLine> lines;
  std::optional<char> delimiter;           ///< delimiter that a first line "sep=;" states
  std::optional<TableLine> above;          ///< comment right above the first line, without its sign
  bool above_may_begin_with_unit = false;  ///< true where that sign is "%"
};

/// Splits a table into lines, which end with LF, CRLF or CR. Throws Error, naming the file, for bytes that
/// are not UTF-8.
/// \param bytes  bytes of the file; must outlive the lines
TableLines table_lines(std::string_view bytes, const std::filesystem::path& path);

/// Returns a text without blanks at both ends, also without blanks that do not break a line.
std::string_view without_blanks(std::string_view text);

/// Returns a text of a file for a message: in quotes, on one line, not long.
std::string as_written(std::string_view text);

/// Throws Error that names the file and the line, 0 for the file as a whole.
[[noreturn]] void refuse(const std::filesystem::path& path, int line, const std::string& what);

}  // namespace pyroclast
