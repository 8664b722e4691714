#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pyroclast {

enum class DecimalSign { point, comma };

/// Kind of a cell. A number counts as a number whatever its decimal sign.
enum class CellKind { empty, text, number, clock, date };
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

/// Meaning of the two parts of a time such as 01:30; three parts are hours, minutes and seconds.
enum class ClockForm { unknown, minutes_seconds, hours_minutes };
/// Returns the form that a unit such as "hh:mm:ss" or "mm:ss" means; empty where it is no form of a time.
std::optional<ClockForm> clock_form(std::string_view unit);
/// Returns the number of parts of a time.
int clock_parts(std::string_view clock);
/// Returns the seconds of a time as a plain number.
std::string clock_seconds(std::string_view clock, ClockForm form);

}  // namespace pyroclast
