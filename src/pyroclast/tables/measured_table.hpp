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

/// A quantity that is read from a table.
struct AskedColumn {
  std::string_view name;  ///< in messages, such as "time"
  const Unit& unit;
};

/// Which columns of a file are meant, and in which units, as a deck says it.
struct ColumnChoice {
  /// A column by its name, or by its number from 1 where that is not 0.
  struct TableColumn {
    std::string name;
    std::size_t number = 0;
  };
  std::string file;                  ///< as the deck names it
  std::vector<TableColumn> columns;  ///< of each quantity; empty where the table has no others
  std::vector<std::string> units;    ///< of each quantity, "" where the file says it; may be empty
  std::string key = "csv";           ///< by which the deck names the file
};

/// A column that was chosen, and the unit of its numbers.
struct ChosenColumn {
  std::size_t index;
  std::string unit;
};

/// A table of numbers as people, loggers, spreadsheets and programs write them: cells between commas,
/// semicolons, tabs or blanks, decimal points or commas, with a header or without, units in the header or in
/// a row below it, quotes, comments, times as hh:mm:ss, LF, CRLF or CR, a byte order mark. Where a text has
/// more than one reading it is refused.
///
/// All functions throw Error, which names file and line, what stands there and what to write.
class MeasuredTable {
 public:
  /// \param least  number of columns that the table must have
  static MeasuredTable open(const std::filesystem::path& path, std::size_t least);
  /// The same from the bytes of a file; `path` names it in messages.
  static MeasuredTable parse(std::string_view bytes, const std::filesystem::path& path, std::size_t least);

  const std::vector<ColumnHeader>& columns() const { return columns_; }
  std::size_t rows() const { return grid_.rows.size(); }
  /// Of a row, from 0, in the file, from 1.
  int line(std::size_t row) const { return grid_.rows[row].line; }
  /// Where the columns are named, or the first row where none are.
  int header_line() const { return header_line_; }
  const std::filesystem::path& path() const { return path_; }

  /// The columns of the quantities, in their order. Without a choice the table has no other columns, but for
  /// an index before them.
  std::vector<ChosenColumn> choose(const ColumnChoice& choice, std::span<const AskedColumn> asked) const;
  /// The unit that a column has where a quantity is read from it; empty where the file does not say it.
  std::string unit_of(std::size_t column, const Unit& unit) const;
  /// Whether a column without a unit counts the rows, from 0 or 1.
  bool is_index(std::size_t column) const;
  /// Whether a quantity may be read from a column by its unit, or the stated one.
  bool fits(std::size_t column, const std::string& stated, const Unit& unit) const;
  /// The numbers, names and units of all columns, for messages.
  std::string list_of_columns() const;
  /// In `unit.si`.
  std::vector<double> values(const ChosenColumn& column, const Unit& unit) const;
  /// A column in messages: its name in quotes, or its number.
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
  /// The table of the deck that names columns, and units where the file does not say them.
  std::string line_to_write(const ColumnChoice& choice, const std::vector<std::size_t>& columns,
                            std::span<const AskedColumn> asked) const;
  std::vector<std::size_t> likely_columns(std::span<const AskedColumn> asked) const;

  std::filesystem::path path_;
  TableGrid grid_;
  std::vector<ColumnHeader> columns_;
  int header_line_ = 0;
};

/// Throws Error that names the lines unless the values ascend strictly.
/// \param name  of the quantity, such as "time"
void require_ascending(const MeasuredTable& table, const ChosenColumn& column, std::span<const double> values,
                       std::string_view name);

}  // namespace pyroclast
