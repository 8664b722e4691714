#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/tables/dialect.hpp"
#include "pyroclast/tables/header.hpp"

namespace pyroclast {

/// Quantity that is read from a table.
struct AskedColumn {
  std::string_view name;  ///< name in messages, such as "time"
  const Unit& unit;
};

/// Columns of a file that a deck chooses, and their units.
struct ColumnChoice {
  /// Column, given by its name, or by its number from 1 where the number is not 0.
  struct TableColumn {
    std::string name;
    std::size_t number = 0;
  };
  std::string file;                  ///< file as the deck names it
  std::vector<TableColumn> columns;  ///< column of each quantity; empty where the table has no other columns
  std::vector<std::string> units;    ///< unit of each quantity, "" where the file says it; may be empty
  std::string key = "csv";           ///< key by which the deck names the file
};

/// Column that was chosen, and the unit of its numbers.
struct ChosenColumn {
  std::size_t index;
  std::string unit;
};

/// Table of numbers as people, loggers, spreadsheets and programs write it: cells between commas, semicolons,
/// tabs or blanks, decimal points or commas, with a header or without, units in the header or in a row below
/// it, quotes, comments, times as hh:mm:ss, LF, CRLF or CR, a byte order mark. A text that can be read in
/// more than one way is refused.
///
/// All functions throw Error, which names file and line, the text that stands there and the text to write.
class MeasuredTable {
 public:
  /// Opens a file.
  /// \param least  number of columns that the table must have
  static MeasuredTable open(const std::filesystem::path& path, std::size_t least);
  /// Parses the bytes of a file; `path` names the file in messages.
  static MeasuredTable parse(std::string_view bytes, const std::filesystem::path& path, std::size_t least);

  const std::vector<ColumnHeader>& columns() const { return columns_; }
  std::size_t rows() const { return grid_.rows.size(); }
  /// Returns the line number in the file, from 1, of a row, from 0.
  int line(std::size_t row) const { return grid_.rows[row].line; }
  /// Returns the line that names the columns, or the first row where none does.
  int header_line() const { return header_line_; }
  const std::filesystem::path& path() const { return path_; }

  /// Returns the columns of the quantities, in the order of the quantities. Without a choice the table must
  /// have no other columns, apart from an index before them.
  std::vector<ChosenColumn> choose(const ColumnChoice& choice, std::span<const AskedColumn> asked) const;
  /// Returns the unit of a column from which a quantity is read; empty where the file does not say it.
  std::string unit_of(std::size_t column, const Unit& unit) const;
  /// Tells whether a column without a unit counts the rows, from 0 or 1.
  bool is_index(std::size_t column) const;
  /// Tells whether a quantity may be read from a column, judged by the column's unit or the stated one.
  bool fits(std::size_t column, const std::string& stated, const Unit& unit) const;
  /// Returns the numbers, names and units of all columns, for messages.
  std::string list_of_columns() const;
  /// Returns the values of a column in `unit.si`.
  std::vector<double> values(const ChosenColumn& column, const Unit& unit) const;
  /// Returns the name of a column for messages: its name in quotes, or its number.
  std::string column_name(std::size_t column) const;

 private:
  MeasuredTable(TableGrid grid, std::filesystem::path path);

  std::string cell_place(std::size_t row, std::size_t column) const;
  void read_header();
  bool holds_clock(std::size_t column) const;
  ClockForm clock_form_of(const ChosenColumn& column) const;
  std::function<double(std::string_view)> reader(const ChosenColumn& column, std::string_view given,
                                                 const Unit& unit) const;
  std::size_t find(const ColumnChoice::TableColumn& column) const;
  std::vector<std::size_t> chosen(const ColumnChoice& choice, std::span<const AskedColumn> asked) const;
  std::string chosen_unit(std::size_t column, const std::string& stated, const AskedColumn& asked) const;
  /// Returns the table of the deck that would name the columns, and the units where the file does not say
  /// them.
  std::string line_to_write(const ColumnChoice& choice, const std::vector<std::size_t>& columns,
                            std::span<const AskedColumn> asked) const;
  std::vector<std::size_t> likely_columns(std::span<const AskedColumn> asked) const;

  std::filesystem::path path_;
  TableGrid grid_;
  std::vector<ColumnHeader> columns_;
  int header_line_ = 0;
};

/// Throws Error that names the lines unless the values ascend strictly.
/// \param name  name of the quantity, such as "time"
void require_ascending(const MeasuredTable& table, const ChosenColumn& column, std::span<const double> values,
                       std::string_view name);

}  // namespace pyroclast
