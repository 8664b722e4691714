#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pyroclast {

/// A number as it is written: digits times ten to an exponent.
struct Decimal {
  std::int64_t digits = 0;
  int exponent = 0;

  double value() const;
};

/// Of a text that `std::from_chars` reads whole; empty where it has more digits than are kept.
std::optional<Decimal> decimal_of(std::string_view number);

/// The decimal of few digits that a number is but for rounding, such as a product of factors of units; empty
/// where there is none.
std::optional<Decimal> nearest_decimal(double number);

/// The double nearest to (number + shift) * factor / divisor; empty where the digits are too many.
std::optional<double> nearest_double(Decimal number, Decimal shift, Decimal factor, Decimal divisor);

}  // namespace pyroclast
