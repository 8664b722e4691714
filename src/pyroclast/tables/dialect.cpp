#include "pyroclast/tables/dialect.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/tables/header.hpp"

namespace pyroclast {
namespace {

/// Delimiters beside signs: blanks, or nothing where a line is one cell.
constexpr char kBlanks = ' ', kNothing = '\0';

constexpr std::size_t kMostHeaderRows = 2;  ///< most rows of a header: names and units

using Cells = std::vector<std::string>;

std::string in_words(char delimiter) {
  if (delimiter == kBlanks) return "blanks";
  if (delimiter == kNothing) return "none";
  return delimiter == '\t' ? "tabs" : fmt::format("\"{}\"", delimiter);
}

bool is_value(std::string_view cell) {
  const CellKind kind = kind_of_cell(cell);
  return kind != CellKind::empty && kind != CellKind::text;
}

/// Returns the text in the quotes with which a cell begins, where "" stands for one quote, and takes it off
/// the line. Empty where the quotes do not close.
std::optional<std::string> take_quoted(std::string_view& line) {
  std::string text;
  line.remove_prefix(1);
  while (!line.empty()) {
    const bool is_quote = line[0] == '"', is_double = line.starts_with("\"\"");
    if (is_quote && !is_double) {
      line.remove_prefix(1);
      return text;
    }
    text += line[0];
    line.remove_prefix(is_double ? 2 : 1);
  }
  return std::nullopt;
}

/// Cuts a line into cells; empty where quotes do not close, or text follows them.
std::optional<Cells> cut(std::string_view line, char delimiter) {
  if (delimiter == kNothing) delimiter = '\n';  // a sign that no line holds
  Cells cells;
  while (true) {
    // a tab that separates is no blank
    while (!line.empty() && line[0] != delimiter && without_blanks(line.substr(0, 1)).empty())
      line.remove_prefix(1);
    if (line.starts_with('"')) {
      const auto text = take_quoted(line);
      const std::size_t end = std::min(line.find(delimiter), line.size());
      if (!text || !without_blanks(line.substr(0, end)).empty()) return std::nullopt;
      cells.emplace_back(without_blanks(*text));
      line.remove_prefix(end);
    } else {
      const std::size_t end = std::min(line.find(delimiter), line.size());
      cells.emplace_back(without_blanks(line.substr(0, end)));
      line.remove_prefix(end);
    }
    if (line.empty()) return cells;
    line.remove_prefix(1);
  }
}

/// Returns the cells between blanks, any number of which separates them; empty as from `cut`.
std::optional<Cells> cut_at_blanks(std::string_view line) {
  Cells cells;
  for (line = without_blanks(line); !line.empty(); line = without_blanks(line)) {
    if (line[0] == '"') {
      const auto text = take_quoted(line);
      if (!text || (!line.empty() && without_blanks(line).size() == line.size())) return std::nullopt;
      cells.emplace_back(without_blanks(*text));
      continue;
    }
    std::size_t end = 0;
    while (end < line.size() && without_blanks(line.substr(end)).size() == line.size() - end) ++end;
    cells.emplace_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return cells;
}

std::optional<Cells> cells_of(std::string_view line, char delimiter) {
  return delimiter == kBlanks ? cut_at_blanks(line) : cut(line, delimiter);
}

/// Fit of a delimiter to a line: the cells into which it cuts it, those up to the last that is not empty, and
/// those that are values.
struct Fit {
  std::size_t cells = 0, used = 0, values = 0;
};

Fit fit(std::string_view line, char delimiter) {
  const auto cells = cells_of(line, delimiter);
  if (!cells) return {};
  Fit result{cells->size(), cells->size(), 0};
  while (result.used > 1 && (*cells)[result.used - 1].empty()) --result.used;
  // "10 200,5" is rather two cells between blanks than a number with a blank between thousands
  const bool takes_blanks = delimiter == ';' || delimiter == '\t';
  result.values = static_cast<std::size_t>(std::ranges::count_if(*cells, [&](const std::string& cell) {
    return is_value(cell) &&
           (takes_blanks || cell.find(' ') == cell.npos || kind_of_cell(cell) == CellKind::stamp);
  }));
  return result;
}

/// Fit of a delimiter to all lines that hold values.
class FitToLines {
 public:
  void add(const Fit& line) {
    if (lines_ == 0) first_ = line;
    has_equal_cells_ = has_equal_cells_ && line.cells == first_.cells;
    has_equal_used_ = has_equal_used_ && line.used == first_.used;
    cells_ += line.cells;
    values_ += line.values;
    ++lines_;
  }
  bool separates() const { return cells_ > lines_; }

  /// Tells whether the delimiter cuts all lines alike and the other does not; else whether it gives more
  /// cells that are values, or as many and fewer others.
  bool is_better_than(const FitToLines& other) const {
    if (is_even() != other.is_even()) return is_even();
    return values_ != other.values_ ? values_ > other.values_ : cells_ < other.cells_;
  }

 private:
  bool is_even() const { return has_equal_cells_ || has_equal_used_; }

  Fit first_;
  bool has_equal_cells_ = true, has_equal_used_ = true;
  std::size_t lines_ = 0, cells_ = 0, values_ = 0;
};

bool is_all_values(std::string_view line, char delimiter) {
  const Fit found = fit(line, delimiter);
  return found.cells > 0 && found.values == found.cells;
}

/// Tells whether cells may be a number that blanks between thousands have cut.
bool has_thousands(const Cells& cells) {
  constexpr std::size_t kThousands = 3;
  const auto is_whole = [](const std::string& cell) {
    return cell.find_first_not_of("0123456789") == cell.npos;
  };
  for (std::size_t i = 1; i < cells.size(); ++i)
    if (is_whole(cells[i - 1]) && cells[i - 1].size() <= kThousands && is_whole(cells[i]) &&
        cells[i].size() == kThousands)
      return true;
  return false;
}

class GridReader {
 public:
  GridReader(const TableLines& lines, std::size_t least, const std::filesystem::path& path)
      : table_(lines), lines_(lines.lines), least_(least), path_(path) {
    if (lines_.empty()) refuse(path_, 0, "is empty; rows of numbers under a header are needed");
    delimiter_ = lines.delimiter ? *lines.delimiter : find_delimiter();
  }

  TableGrid read() {
    cut_rows();
    drop_empty_ends();
    std::size_t header = header_rows();
    const bool is_comment = header == 0 && take_comment();
    if (is_comment) header = 1;
    require_equal_rows(header);
    const auto begin = std::make_move_iterator(rows_.begin()), end = std::make_move_iterator(rows_.end());
    const auto first = begin + static_cast<std::ptrdiff_t>(header);
    TableGrid grid{{begin, first}, {first, end}, DecimalSign::point, in_words(delimiter_)};
    grid.decimal_sign = decimal_sign(grid.rows);
    grid.may_begin_with_unit = is_comment && table_.above_may_begin_with_unit;
    return grid;
  }

 private:
  /// Finds the delimiter. The last line holds numbers, and nobody writes a semicolon in one.
  char find_delimiter() const {
    const std::string_view last = lines_.back().text;
    if (fit(last, ';').cells > 1) return ';';
    if (fit(last, ',').cells > 1 && is_all_values(last, ',') && is_all_values(last, kNothing))
      return comma_or_nothing();
    char best = kNothing;
    FitToLines best_fit;
    for (const char delimiter : {'\t', ',', kBlanks}) {
      FitToLines whole;
      for (const TableLine& line : lines_)  // but for a header, where names may be missing
        if (const Fit found = fit(line.text, delimiter); found.values > 0) whole.add(found);
      if (!whole.separates()) continue;
      if (best == kNothing || whole.is_better_than(best_fit)) best = delimiter, best_fit = whole;
    }
    return best;
  }

  /// Chooses the delimiter of lines such as "1,234", each of which is one number or two.
  char comma_or_nothing() const {
    if (least_ > 1) return ',';
    const std::string_view first = lines_.front().text, last = lines_.back().text;
    if (is_all_values(first, kNothing))
      refuse(
          path_, lines_.back().number,
          fmt::format("{} may be one number with a decimal comma or two numbers with a comma between them; "
                      "write {} or {}",
                      as_written(last), as_written(replaced(last, ".")), as_written(replaced(last, "; "))));
    return fit(first, ',').cells > 1 ? ',' : kNothing;
  }

  static std::string replaced(std::string_view text, std::string_view comma) {
    std::string result(text);
    for (std::size_t at = 0; (at = result.find(',', at)) != result.npos; at += comma.size())
      result.replace(at, 1, comma);
    return result;
  }

  void cut_rows() {
    for (const TableLine& line : lines_) {
      auto cells = cells_of(line.text, delimiter_);
      if (!cells)
        refuse(path_, line.number, fmt::format("{}: a quote does not close", as_written(line.text)));
      if (std::ranges::all_of(*cells, &std::string::empty)) continue;  // delimiters alone
      rows_.push_back({line.number, std::move(*cells)});
      texts_.push_back(line.text);
    }
    if (rows_.empty()) refuse(path_, lines_.front().number, "has no cell that holds something");
    if (delimiter_ == kBlanks) {
      const std::size_t columns = rows_.back().cells.size();
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (rows_[i].cells.size() == columns) continue;
        Cells named = cells_between_blanks(texts_[i], columns);
        if (!named.empty() && std::ranges::none_of(named, is_value)) rows_[i].cells = std::move(named);
      }
    }
  }

  /// Drops empty columns at the end, which are delimiters at the end of lines.
  void drop_empty_ends() {
    std::size_t used = 0;
    for (const TableRow& row : rows_)
      for (std::size_t i = used; i < row.cells.size(); ++i)
        if (!row.cells[i].empty()) used = i + 1;
    for (TableRow& row : rows_)
      if (row.cells.size() > used) row.cells.resize(used);
  }

  /// Counts the rows at the top that have words where the last row has numbers.
  std::size_t header_rows() const {
    const TableRow& numbers = rows_.back();
    if (std::ranges::none_of(numbers.cells, is_value))
      refuse(path_, numbers.line,
             rows_.size() > 1 && std::ranges::any_of(rows_[rows_.size() - 2].cells, is_value)
                 ? fmt::format("{} holds no number (delimiter: {}); delete the line or write # before it",
                               as_written(texts_.back()), in_words(delimiter_))
                 : fmt::format("{} holds no number; rows of numbers must follow the header",
                               as_written(texts_.back())));
    std::size_t count = 0;
    while (count < rows_.size() && is_header(rows_[count])) ++count;
    if (count > kMostHeaderRows)
      refuse(
          path_, rows_[0].line,
          fmt::format("{} lines without numbers stand above the first row of numbers, beginning with {}; one "
                      "with names and one with units may. Write # before the others",
                      count, as_written(texts_[0])));
    return count;
  }

  /// Takes the comment above a table without a header for its header, where it has a name for each of its
  /// columns, as NumPy writes it: "# x y r".
  bool take_comment() {
    const std::optional<TableLine>& above = table_.above;
    if (!above) return false;
    const std::size_t columns = rows_[0].cells.size();
    auto cells = cells_of(above->text, delimiter_);
    if (cells && delimiter_ == kBlanks && cells->size() != columns)
      cells = cells_between_blanks(above->text, columns);
    while (cells && cells->size() > columns && cells->back().empty()) cells->pop_back();
    const auto is_name = [](const std::string& cell) {
      const ColumnHeader header = column_header(cell);
      return kind_of_cell(cell) == CellKind::text && header.unknown_unit.empty() &&
             (header.unit.empty() || unit_cell(header.unit));
    };
    if (!cells || columns < 2 || cells->size() != columns || !std::ranges::all_of(*cells, is_name))
      return false;
    if (std::ranges::all_of(*cells, [](const std::string& cell) { return unit_cell(cell).has_value(); }))
      return false;
    rows_.insert(rows_.begin(), {above->number, std::move(*cells)});
    texts_.insert(texts_.begin(), above->text);
    return true;
  }

  bool is_header(const TableRow& row) const {
    const Cells& numbers = rows_.back().cells;
    bool has_words = false;
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const bool is_number_below = i >= numbers.size() || is_value(numbers[i]);
      has_words = has_words || (is_number_below && kind_of_cell(row.cells[i]) == CellKind::text);
    }
    return has_words;
  }

  void require_equal_rows(std::size_t header) const {
    const TableRow& first = rows_[0];
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      const TableRow& row = rows_[i];
      if (row.cells.size() == first.cells.size()) continue;
      const bool is_both = delimiter_ == ',' && row.cells.size() > first.cells.size() && i == header;
      const bool may_cut_numbers =
          delimiter_ == kBlanks &&
          std::ranges::any_of(rows_, [](const TableRow& one) { return has_thousands(one.cells); });
      refuse(
          path_, row.line,
          fmt::format("{} has {} cell{}, line {} has {} (delimiter: {}){}", as_written(texts_[i]),
                      row.cells.size(), row.cells.size() == 1 ? "" : "s", first.line, first.cells.size(),
                      in_words(delimiter_),
                      is_both ? "; a comma cannot be the delimiter and the decimal sign: write \";\" between "
                                "cells, or numbers in quotes"
                      : may_cut_numbers
                          ? "; write as many in each line, 1200 for 1 200, as blanks stand between columns"
                          : "; write as many in each line"));
    }
  }

  /// First number that shows a decimal sign, and its line.
  struct Seen {
    std::string number;
    int line = 0;
    explicit operator bool() const { return line > 0; }
  };

  DecimalSign decimal_sign(const std::vector<TableRow>& rows) const {
    Seen seen[static_cast<std::size_t>(SignEvidence::comma_or_point) + 1];
    for (const TableRow& row : rows) {
      for (const std::string& cell : row.cells) {
        if (kind_of_cell(cell) != CellKind::number) continue;
        Seen& of_kind = seen[static_cast<std::size_t>(sign_evidence(cell))];
        if (!of_kind) of_kind = {cell, row.line};
      }
    }
    const auto of = [&](SignEvidence kind) { return seen[static_cast<std::size_t>(kind)]; };
    using enum SignEvidence;
    const Seen by_point = of(point_thousands) ? of(point_thousands) : of(point);
    const Seen by_comma = of(comma_thousands) ? of(comma_thousands) : of(comma);
    if (by_point && by_comma) refuse_both(by_point, by_comma);
    if (by_comma && of(point_or_comma) && !of(comma_thousands)) refuse_both(of(point_or_comma), by_comma);
    if (by_point && of(comma_or_point) && !of(point_thousands)) refuse_both(by_point, of(comma_or_point));
    if (by_comma) return DecimalSign::comma;
    if (!by_point && of(comma_or_point)) refuse_thousands(of(comma_or_point));
    return DecimalSign::point;
  }

  [[noreturn]] void refuse_both(const Seen& with_point, const Seen& with_comma) const {
    refuse(
        path_, std::max(with_point.line, with_comma.line),
        fmt::format(
            "\"{}\" in line {} has a point and \"{}\" in line {} a comma, each of which may be the decimal "
            "sign; write all numbers with a decimal point and nothing between thousands",
            with_point.number, with_point.line, with_comma.number, with_comma.line));
  }

  /// Commas between columns would become points by a command that turns those within numbers.
  [[noreturn]] void refuse_thousands(const Seen& number) const {
    const std::string name = path_.filename().string();
    refuse(
        path_, number.line,
        fmt::format(
            "\"{}\" may be {} (decimal comma) or {} (comma between thousands), and no other number tells; "
            "write one of them{}",
            number.number, *plain_number(number.number, DecimalSign::comma),
            *plain_number(number.number, DecimalSign::point),
            delimiter_ == ','
                ? ""
                : fmt::format(", such as by `sed 's/\\([0-9]\\),\\([0-9]\\)/\\1.\\2/g' {} > {}` for "
                              "decimal commas",
                              shell_path(name), shell_word("points_" + name))));
  }

  const TableLines& table_;
  const std::vector<TableLine>& lines_;
  std::size_t least_;
  const std::filesystem::path& path_;
  char delimiter_ = kNothing;
  std::vector<TableRow> rows_;
  std::vector<std::string_view> texts_;  ///< texts of the rows
};

}  // namespace

TableGrid table_grid(const TableLines& lines, std::size_t least, const std::filesystem::path& path) {
  return GridReader(lines, least, path).read();
}

}  // namespace pyroclast
