#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/tables/cell.hpp"
#include "pyroclast/tables/table_lines.hpp"

namespace pyroclast {

/// A line of a table cut into its cells, each without quotes and blanks around it.
struct TableRow {
  int line;  ///< in the file, from 1
  std::vector<std::string> cells;
};

/// A table cut into cells: all rows have as many.
struct TableGrid {
  std::vector<TableRow> header;  ///< none, one or two rows without numbers
  std::vector<TableRow> rows;    ///< at least one
  DecimalSign decimal_sign = DecimalSign::point;
  std::string delimiter;  ///< in words
};

/// Finds the delimiter, the decimal sign and the lines of the header. Throws Error naming file and line where
/// there is none of them, or more than one reading.
/// \param least  number of columns that the table must have
TableGrid table_grid(const TableLines& lines, std::size_t least, const std::filesystem::path& path);

}  // namespace pyroclast
