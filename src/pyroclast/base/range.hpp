#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace pyroclast {

/// The values a key may have, in the unit it is read in.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_inclusive = true;
  bool upper_inclusive = true;
  /// What values usually are, both ends included; another one is allowed, but most likely a slip.
  double usual_lower = -std::numeric_limits<double>::infinity();
  double usual_upper = std::numeric_limits<double>::infinity();

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return above(0.0); }
  static constexpr Range non_negative() { return at_least(0.0); }
  static constexpr Range above(double bound) { return {.lower = bound, .lower_inclusive = false}; }
  static constexpr Range at_least(double bound) { return {.lower = bound}; }
  static constexpr Range below(double bound) { return {.upper = bound, .upper_inclusive = false}; }
  static constexpr Range at_most(double bound) { return {.upper = bound}; }
  /// Both ends allowed.
  static constexpr Range between(double low, double high) { return {.lower = low, .upper = high}; }
  /// Both ends excluded.
  static constexpr Range inside(double low, double high) { return {low, high, false, false}; }
  /// From 0 to 1, both allowed.
  static constexpr Range fraction() { return between(0.0, 1.0); }

  /// The same range with what is usual in it.
  constexpr Range usually(double low, double high) const {
    Range range = *this;
    range.usual_lower = low;
    range.usual_upper = high;
    return range;
  }

  /// False for NaN.
  bool contains(double value) const;
  /// The value; of one that lies beyond an end by rounding alone, that end.
  double but_for_rounding(double value) const;
  bool is_usual(double value) const { return value >= usual_lower && value <= usual_upper; }
  /// Some value of the range, a whole number where there is one; the stand-in for a value that could not be
  /// read.
  double any_value() const;
  /// In words, such as "greater than 0 m" or "between 0 and 1"; empty if everything is allowed.
  std::string describe(std::string_view unit = {}) const;
  /// The same of what is usual.
  std::string describe_usual(std::string_view unit = {}) const;
};

}  // namespace pyroclast
