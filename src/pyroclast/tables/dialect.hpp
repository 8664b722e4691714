#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/tables/cell.hpp"
#include "pyroclast/tables/table_lines.hpp"

namespace pyroclast {

/// Line of a table cut into its cells, each without quotes and blanks around it.
struct TableRow {
  int line;  ///< line number in the file, from 1
  std::vector<std::string> cells;
};

/// Table cut into cells; all its rows have equally many.
struct TableGrid {
  std::vector<TableRow> header;  ///< header: none, one or two rows without numbers
  std::vector<TableRow> rows;    ///< rows with numbers, at least one
  DecimalSign decimal_sign = DecimalSign::point;
  std::string delimiter;  ///< name of the delimiter in words
  /// True where the header begins with "%": the sign of a comment, or the unit of the first column.
  bool may_begin_with_unit = false;
};

/// Finds the delimiter, the decimal sign and the lines of the header. Throws Error naming file and line where
/// the table cannot be read in any way, or in more than one.
/// \param least  number of columns that the table must have
TableGrid table_grid(const TableLines& lines, std::size_t least, const std::filesystem::path& path);

}  // namespace pyroclast
