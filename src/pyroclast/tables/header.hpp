#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// Name and unit of a column as the lines above the numbers give them.
struct ColumnHeader {
  std::string name;
  std::string unit;          ///< unit, "1" for none; empty where the table does not say it
  std::string likely_unit;   ///< unit that a name such as stress_MPa, "T, degC" or "Kraft in kN" may mean
  std::string unknown_unit;  ///< text in round brackets that is neither a known unit nor a remark
  std::string written;       ///< whole cell
};

/// Reads a cell "name [unit]", "name (unit)", "name / unit" or "name", also with words behind the brackets.
/// Other words in round brackets are a remark, as is_remark tells.
ColumnHeader column_header(std::string_view cell);

/// Tells whether a text in round brackets can be a remark, such as "measured", "mean of 3", "LVDT 1" or "at
/// 20 °C": words and numbers alone, units behind a number, and ratios such as "f_c/f_c20". A word has letters
/// and perhaps digits behind them. No remark are texts with "per", words that may mean a share ("mstrain",
/// "x1000"), and two letters alone that may have a prefix ("me").
bool is_remark(std::string_view text);

/// Returns the unit in a cell of a row of units, such as "degC", "[degC]" or "-"; empty where it is no unit.
std::optional<std::string> unit_cell(std::string_view cell);

/// Splits a line that has no delimiter but blanks into its cells. Units in brackets and names of several
/// words hold blanks too, so the number of cells must be known. Empty where the cells cannot be told apart.
std::vector<std::string> cells_between_blanks(std::string_view line, std::size_t count);

}  // namespace pyroclast
