#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// What the lines above the numbers say of a column.
struct ColumnHeader {
  std::string name;
  std::string unit;         ///< "1" for none; empty where the table does not say it
  std::string likely_unit;  ///< of a name such as stress_MPa, which may mean it
};

/// Of a cell "name [unit]", "name (unit)", "name / unit" or "name".
ColumnHeader column_header(std::string_view cell);

/// The unit in a cell of a row of units, such as "degC", "[degC]" or "-"; empty where it is none.
std::optional<std::string> unit_cell(std::string_view cell);

/// The cells of a line without a delimiter but blanks: units in brackets and names of several words hold
/// blanks too, so that their number must be known. Empty where they cannot be told apart.
std::vector<std::string> cells_between_blanks(std::string_view line, std::size_t count);

}  // namespace pyroclast
