#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pyroclast {

enum class DecimalSign { point, comma };

/// Kind of a cell. A number counts as a number whatever its decimal sign; a stamp is a date with a clock
/// time.
enum class CellKind { empty, text, number, clock, stamp, date };
CellKind kind_of_cell(std::string_view cell);

/// Returns a number with a decimal point and without other signs, as `std::from_chars` reads it; empty where
/// the cell is no number with the given decimal sign. The other sign, blanks or apostrophes may stand between
/// thousands. Fortran's 1.0D+02 is a number.
std::optional<std::string> plain_number(std::string_view cell, DecimalSign sign);

/// Evidence that a number gives of the decimal sign of its file.
enum class SignEvidence {
  none,             ///< "12"
  point,            ///< "12.5", "1e3"
  comma,            ///< "12,5"
  point_thousands,  ///< "1,234.5": a decimal point, and commas between thousands
  comma_thousands,  ///< "1.234,5"
  point_or_comma,   ///< "1.234"
  comma_or_point    ///< "1,234"
};
SignEvidence sign_evidence(std::string_view number);

}  // namespace pyroclast
