#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// Name and unit of a column as the lines above the numbers give them.
struct ColumnHeader {
  std::string name;
  std::string unit;         ///< unit, "1" for none; empty where the table does not say it
  std::string likely_unit;  ///< unit that a name such as stress_MPa may mean
};

/// Reads a cell "name [unit]", "name (unit)", "name / unit" or "name".
ColumnHeader column_header(std::string_view cell);

/// Returns the unit in a cell of a row of units, such as "degC", "[degC]" or "-"; empty where it is no unit.
std::optional<std::string> unit_cell(std::string_view cell);

/// Splits a line that has no delimiter but blanks into its cells. Units in brackets and names of several
/// words hold blanks too, so the number of cells must be known. Empty where the cells cannot be told apart.
std::vector<std::string> cells_between_blanks(std::string_view line, std::size_t count);

}  // namespace pyroclast
