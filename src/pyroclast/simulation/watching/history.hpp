#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/simulation/watching/column.hpp"

namespace pyroclast {

/// Rows of a history, from `first` up to but without `last`.
struct RowRange {
  std::size_t first = 0, last = 0;

  bool empty() const { return first == last; }
};

/// Measurements of a run: a row for each look, in full precision. A cell is empty where the stage of its row
/// does not have the quantity.
class History {
 public:
  /// Adds a column after the present ones, unless one of its name is there already. Call it before the first
  /// row. Throws Error when a column of this name has another unit.
  void add_column(const Column& column);
  void add_row();
  /// Adds a row with all its cells, in the order of the columns.
  void add_row(std::vector<std::optional<double>> cells);
  /// Adds the rows of another history, without columns that this history does not have.
  void take_rows(const History& other);
  /// Sets a cell of the last row. Throws Error when there is no such column.
  void set(std::string_view column, double value);

  const std::vector<Column>& columns() const { return columns_; }
  bool has(std::string_view column) const;
  /// Returns the index of a column. Throws Error when there is no such column.
  std::size_t index(std::string_view column) const;
  std::size_t row_count() const { return cells_.size(); }
  /// Returns the cells of a row in the order of the columns.
  const std::vector<std::optional<double>>& row(std::size_t row) const { return cells_.at(row); }
  /// Returns a cell; empty also where there is no such column.
  std::optional<double> cell(std::size_t row, std::string_view column) const;
  /// Returns a cell of the last row; empty also where there is no such column.
  std::optional<double> last(std::string_view column) const;
  /// Returns the values of a column over some rows. Throws Error when there is no such column, or a cell is
  /// empty.
  std::vector<double> values(std::string_view column, RowRange rows) const;

  /// Shows all rows. Rows that replace them may have their columns in another order, or lack some: those
  /// cells are then empty. Throws Error when the new rows have a value in a column that is not here.
  void visit_state(StateVisitor& visitor);

 private:
  std::optional<std::size_t> find(std::string_view column) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::optional<double>>> cells_;  ///< cells by row
};

}  // namespace pyroclast
