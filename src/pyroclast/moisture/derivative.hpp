#pragma once

#include <cmath>

#include "pyroclast/base/exp.hpp"
#include "pyroclast/base/log.hpp"

namespace pyroclast {

/// Number together with its derivative by one variable. A formula that is a template of its number type
/// computes with these its own exact derivative (forward differentiation).
struct WithSlope {
  double value = 0.0, slope = 0.0;

  WithSlope() = default;
  WithSlope(double constant) : value(constant) {}
  WithSlope(double its_value, double its_slope) : value(its_value), slope(its_slope) {}

  friend WithSlope operator+(const WithSlope& a, const WithSlope& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend WithSlope operator-(const WithSlope& a, const WithSlope& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend WithSlope operator*(const WithSlope& a, const WithSlope& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend WithSlope operator/(const WithSlope& a, const WithSlope& b) {
    const double ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
};

inline double value_of(double x) {
  return x;
}
inline double value_of(const WithSlope& x) {
  return x.value;
}
inline WithSlope log(const WithSlope& x) {
  return {log(x.value), x.slope / x.value};
}
inline WithSlope power(const WithSlope& x, double y) {
  const double value = power(x.value, y);
  return {value, x.value == 0.0 ? 0.0 : y * value / x.value * x.slope};
}

inline WithSlope sqrt(const WithSlope& x) {
  const double value = std::sqrt(x.value);
  return {value, value == 0.0 ? 0.0 : 0.5 / value * x.slope};
}

}  // namespace pyroclast
