#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// A line of a table that says something.
struct TableLine {
  int number;  ///< in the file, from 1
  std::string_view text;
};

/// The lines of a table but for blank ones and comments (#, %, !, //).
struct TableLines {
  std::vector<TableLine> lines;
  std::optional<char> delimiter;  ///< of a first line "sep=;"
};

/// Lines end with LF, CRLF or CR. Throws Error, naming the file, for bytes that are not UTF-8.
/// \param bytes  of the file; must outlive the lines
TableLines table_lines(std::string_view bytes, const std::filesystem::path& path);

/// Without blanks at both ends, among them those that do not break a line.
std::string_view without_blanks(std::string_view text);

/// What stands in a file, for a message: in quotes, on one line, not long.
std::string as_written(std::string_view text);

/// Throws Error that names the file and the line, 0 for the file as a whole.
[[noreturn]] void refuse(const std::filesystem::path& path, int line, const std::string& what);

}  // namespace pyroclast
