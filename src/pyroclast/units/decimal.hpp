#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pyroclast {

/// Number as it is written: digits times ten to an exponent.
struct Decimal {
  std::int64_t digits = 0;
  int exponent = 0;

  double value() const;
};

/// Returns the decimal that a text writes, for a text that `std::from_chars` reads whole; empty where the
/// text has more digits than are kept.
std::optional<Decimal> decimal_of(std::string_view number);

/// Returns the decimal of few digits that a number equals but for rounding, for instance a product of factors
/// of units; empty where there is none.
std::optional<Decimal> nearest_decimal(double number);

/// Returns the double nearest to (number + shift) * factor / divisor; empty where the digits are too many.
std::optional<double> nearest_double(Decimal number, Decimal shift, Decimal factor, Decimal divisor);

}  // namespace pyroclast
