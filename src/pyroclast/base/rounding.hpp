#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace pyroclast {

/// Stated values and what follows from them are the same where they differ by less than this share of the
/// larger magnitude: some thousand roundings. All ends of ranges, times and counts are compared here.
inline constexpr double kSameWithin = 1e-12;

/// \param zero  from where magnitudes count, as absolute zero for temperatures in °C
inline bool same(double a, double b, double zero = 0.0) {
  if (a == b) return true;
  const double difference = std::abs(a - b);
  return std::isfinite(difference) &&
         difference <= kSameWithin * std::max(std::abs(a - zero), std::abs(b - zero));
}

/// Whether a is at most b or the same.
inline bool at_most(double a, double b, double zero = 0.0) {
  return a <= b || same(a, b, zero);
}

/// Whole units in a number of them, 0 or more.
inline double whole_below(double units) {
  const double nearest = std::round(units);
  return same(units, nearest) ? nearest : std::floor(units);
}

/// Whole units that hold a number of them, 0 or more.
inline double whole_above(double units) {
  const double nearest = std::round(units);
  return same(units, nearest) ? nearest : std::ceil(units);
}

/// The earliest of times; the latest of those that are the same as it, so that no sliver of time is left.
inline double earliest(std::initializer_list<double> times) {
  const double first = std::min(times);
  double result = first;
  for (const double time : times)
    if (same(time, first)) result = std::max(result, time);
  return result;
}

}  // namespace pyroclast
