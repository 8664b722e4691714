#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/tables/column_meaning.hpp"
#include "pyroclast/tables/dialect.hpp"
#include "pyroclast/tables/header.hpp"
#include "pyroclast/tables/moment.hpp"

namespace pyroclast {

/// Name of a column from which a quantity may be read.
struct KnownName {
  const ColumnMeaning* meaning;
  double factor = 1.0;  ///< quantity over the column's number, 2 of a diameter from a radius
};

/// Quantity that is read from a table.
struct AskedColumn {
  std::string_view name;  ///< name in messages, such as "time"
  const Unit& unit;
  std::vector<KnownName> names = {};  ///< names of its column, the likeliest first; empty where any will do
  bool is_optional = false;           ///< true where a table may lack it; such quantities come last
  bool is_known_by_size = false;      ///< true where the numbers tell shares of 1 from per cent
};

/// Word for the time of the first row, where a deck states the start of a record.
inline constexpr std::string_view kFirstRow = "first row";

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
  std::string start = {};            ///< time that counts as 0, written as in the file; may be empty
};

/// Column that was chosen.
struct ChosenColumn {
  std::size_t index;
  std::string unit;                                            ///< unit of its numbers
  double factor = 1.0;                                         ///< quantity over the column's number
  std::size_t rows = std::numeric_limits<std::size_t>::max();  ///< rows up to the end of the chosen columns
  std::string start = {};  ///< time that counts as 0, of a column of times; may be empty
};

/// Table of numbers as people, loggers, spreadsheets and programs write it: cells between commas, semicolons,
/// tabs or blanks, decimal points or commas, with a header or without, units in the header or in a row below
/// it, quotes, comments, times of a clock and a calendar, LF, CRLF or CR, a byte order mark. A text that can
/// be read in more than one way is refused.
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

  /// Returns the columns of the quantities, in the order of the quantities, without the optional ones that
  /// the table lacks. A choice of the deck goes first, then known names, then places. Without a choice the
  /// table must have no other columns than the quantities', apart from those that number the rows. A column
  /// whose name says another quantity than its place is refused.
  ///
  /// \param others  quantities that names of columns may say beside those that are asked for
  std::vector<ChosenColumn> choose(const ColumnChoice& choice, std::span<const AskedColumn> asked,
                                   const ColumnMeanings& others = {}) const;
  /// Tells whether the table has as many columns as quantities, and no name says another quantity than its
  /// place.
  bool names_suit(std::span<const AskedColumn> asked, const ColumnMeanings& others = {}) const;
  /// Tells whether the table has the quantities by its names and units, and no others.
  bool suits(std::span<const AskedColumn> asked, const ColumnMeanings& others = {}) const;
  /// Returns the unit of a column from which a quantity is read; empty where the file does not say it.
  std::string unit_of(std::size_t column, const Unit& unit) const;
  /// Tells whether a column without a unit counts the rows, from 0 or 1.
  bool is_index(std::size_t column) const;
  /// Tells whether a quantity may be read from a column, judged by the column's unit or the stated one.
  bool fits(std::size_t column, const std::string& stated, const Unit& unit) const;
  /// Returns the numbers, names and units of all columns, for messages.
  std::string list_of_columns() const;
  /// Returns the values of a column in `unit.si`. Times count from the start that the deck states. Without
  /// one, dates and times of the day count from the first row, and other times as they are written.
  std::vector<double> values(const ChosenColumn& column, const Unit& unit) const;
  /// Returns the time that counts as 0 in a column of times, as it is written; empty where none was taken
  /// off.
  std::string start_of(const ChosenColumn& column) const;
  /// Returns the name of a column for messages: its name in quotes, or its number.
  std::string column_name(std::size_t column) const;

 private:
  MeasuredTable(TableGrid grid, std::filesystem::path path);

  std::string cell_place(std::size_t row, std::size_t column) const;
  void read_header();
  bool tells_time(std::size_t column) const;
  bool tells_date(std::size_t column) const;
  ClockForm clock_form_of(const ChosenColumn& column, const std::vector<Moment>& moments) const;
  std::vector<Moment> moments_of(const ChosenColumn& column) const;
  Moment stated_start(const ChosenColumn& column, const std::vector<Moment>& moments) const;
  std::vector<std::int64_t> days_of(const ChosenColumn& column, const std::vector<Moment>& moments) const;
  double number_of_start(const ChosenColumn& column, double first, const Unit& unit) const;

  /// Times of a clock, s, and the text of the time that counts as 0.
  struct Times {
    std::vector<double> values;
    std::string start;
  };
  Times times(const ChosenColumn& column) const;
  std::function<double(std::string_view)> reader(const ChosenColumn& column, std::string_view given,
                                                 const Unit& unit) const;
  std::size_t find(const ColumnChoice::TableColumn& column) const;
  /// Returns the quantities that a column's name says, where the column's unit or the stated one lets it.
  ColumnMeanings meanings(std::size_t column, const ColumnMeanings& vocabulary,
                          const std::string& stated = "") const;
  std::vector<std::size_t> columns_of_values(std::span<const AskedColumn> asked,
                                             const ColumnMeanings& vocabulary) const;

  /// Columns of the first quantities of those asked for, and the first that its name contradicts.
  struct Match {
    std::vector<std::size_t> columns;
    std::optional<std::size_t> contradicted;
  };
  Match match(std::vector<std::size_t> columns, std::span<const AskedColumn> asked,
              const ColumnMeanings& vocabulary) const;
  bool fit(const Match& match, const ColumnChoice& choice, std::span<const AskedColumn> asked) const;
  std::optional<Match> match_all(const ColumnChoice& choice, std::span<const AskedColumn> asked,
                                 const ColumnMeanings& vocabulary) const;
  bool contradicts(std::size_t column, const AskedColumn& asked, const ColumnMeanings& vocabulary,
                   const std::string& stated) const;
  std::vector<std::size_t> stated_columns(const ColumnChoice& choice, std::span<const AskedColumn> asked,
                                          const ColumnMeanings& vocabulary) const;
  std::vector<std::size_t> found_columns(const ColumnChoice& choice, std::span<const AskedColumn> asked,
                                         const ColumnMeanings& vocabulary) const;
  [[noreturn]] void refuse_contradiction(std::size_t column, const AskedColumn& asked,
                                         const ColumnChoice& choice, std::span<const AskedColumn> all,
                                         const ColumnMeanings& vocabulary) const;
  std::string chosen_unit(std::size_t column, const std::string& stated, const AskedColumn& asked) const;
  std::size_t end_of(const std::vector<std::size_t>& columns) const;
  /// Returns the table of the deck that would name the columns, and the units where the file does not say
  /// them.
  std::string line_to_write(const ColumnChoice& choice, const std::vector<std::size_t>& columns,
                            std::span<const AskedColumn> asked) const;
  std::vector<std::size_t> likely_columns(std::span<const AskedColumn> asked,
                                          const ColumnMeanings& vocabulary) const;

  std::filesystem::path path_;
  TableGrid grid_;
  std::vector<ColumnHeader> columns_;
  int header_line_ = 0;
};

/// Throws Error that names the lines, and says what to do, unless the values ascend strictly; also for times
/// that count from a date.
/// \param name      name of the quantity, such as "time"
/// \param may_stay  true where values may be equal
void require_ascending(const MeasuredTable& table, const ChosenColumn& column, std::span<const double> values,
                       std::string_view name, const Unit& unit, bool may_stay = false);

}  // namespace pyroclast
