#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace pyroclast {

/// Relative difference below which two values count as the same, as a share of the larger magnitude: some
/// thousand roundings. All ends of ranges, times and counts are compared with this tolerance.
inline constexpr double kSameWithin = 1e-12;

/// Tells whether two numbers are the same but for rounding.
/// \param zero  the value from which magnitudes count, such as absolute zero for temperatures in °C
inline bool same(double a, double b, double zero = 0.0) {
  if (a == b) return true;
  const double difference = std::abs(a - b);
  return std::isfinite(difference) &&
         difference <= kSameWithin * std::max(std::abs(a - zero), std::abs(b - zero));
}

/// Tells whether a is at most b or the same.
inline bool at_most(double a, double b, double zero = 0.0) {
  return a <= b || same(a, b, zero);
}

/// Returns the largest whole number of at most `units`, 0 or more, but for rounding.
inline double whole_below(double units) {
  const double nearest = std::round(units);
  return same(units, nearest) ? nearest : std::floor(units);
}

/// Returns the smallest whole number of at least `units`, 0 or more, but for rounding.
inline double whole_above(double units) {
  const double nearest = std::round(units);
  return same(units, nearest) ? nearest : std::ceil(units);
}

/// Returns the earliest of the times. Among times that are the same as the earliest but for rounding it takes
/// the latest, so that no sliver of time is left.
inline double earliest(std::initializer_list<double> times) {
  const double first = std::min(times);
  double result = first;
  for (const double time : times)
    if (same(time, first)) result = std::max(result, time);
  return result;
}

}  // namespace pyroclast
