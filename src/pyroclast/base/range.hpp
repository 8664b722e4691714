#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace pyroclast {

/// Range of the values that a key may have, in the unit in which the key is read.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_inclusive = true;
  bool upper_inclusive = true;
  /// Lower end of the usual values; both ends are included. A value beyond them is allowed, but most likely a
  /// slip.
  double usual_lower = -std::numeric_limits<double>::infinity();
  double usual_upper = std::numeric_limits<double>::infinity();

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return above(0.0); }
  static constexpr Range non_negative() { return at_least(0.0); }
  static constexpr Range above(double bound) { return {.lower = bound, .lower_inclusive = false}; }
  static constexpr Range at_least(double bound) { return {.lower = bound}; }
  static constexpr Range below(double bound) { return {.upper = bound, .upper_inclusive = false}; }
  static constexpr Range at_most(double bound) { return {.upper = bound}; }
  /// Returns the range from low to high, both included.
  static constexpr Range between(double low, double high) { return {.lower = low, .upper = high}; }
  /// Returns the range from low to high, both excluded.
  static constexpr Range inside(double low, double high) { return {low, high, false, false}; }
  /// Returns the range from 0 to 1, both included.
  static constexpr Range fraction() { return between(0.0, 1.0); }

  /// Returns this range with other usual values.
  constexpr Range usually(double low, double high) const {
    Range range = *this;
    range.usual_lower = low;
    range.usual_upper = high;
    return range;
  }

  /// Tells whether the value is in the range; false for NaN.
  bool contains(double value) const;
  /// Returns the value; where it lies beyond an end by rounding alone, returns that end.
  double but_for_rounding(double value) const;
  bool is_usual(double value) const { return value >= usual_lower && value <= usual_upper; }
  /// Returns some value of the range, a whole number where there is one. It stands in for a value that could
  /// not be read.
  double any_value() const;
  /// Describes the range in words, such as "greater than 0 m" or "between 0 and 1"; empty if everything is
  /// allowed.
  std::string describe(std::string_view unit = {}) const;
  /// Describes the usual values in the same way.
  std::string describe_usual(std::string_view unit = {}) const;
  /// Describes both, the usual values behind the allowed ones.
  std::string describe_all(std::string_view unit = {}) const;

  bool operator==(const Range&) const = default;
};

}  // namespace pyroclast
