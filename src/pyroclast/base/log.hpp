#pragma once

#include <cmath>
#include <limits>

#include "pyroclast/base/exp.hpp"

namespace pyroclast {

/// Returns the natural logarithm with an error below 1 ulp, with the same bits on every processor; the
/// function of a C library does not promise this. Minus infinity for 0, NaN below 0.
///
/// x = 2^k m with m between sqrt(1/2) and sqrt(2); with f = m - 1 and s = f / (2 + f), ln(1 + f) is
/// 2 artanh s = f - s (f - 2 (s^2/3 + s^4/5 + ...)) (Abramowitz and Stegun 4.1.27).
inline double log(double x) {
  if (!(x > 0.0))
    return x == 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(x)) return x;
  constexpr double kSqrtHalf = 0x1.6a09e667f3bcdp-1;
  constexpr double kLn2 = 0x1.62e42feep-1, kLn2Rest = 0x1.a39ef35793c76p-33;  // as exp has them
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < kSqrtHalf) {
    m *= 2.0;
    --exponent;
  }
  const double f = m - 1.0, s = f / (2.0 + f), z = s * s;
  // 2/3 + 2/5 z + ... + 2/23 z^10; the terms left out are below 0.01 ulp.
  double series = 2.0 / 23.0;
  for (int term = 21; term >= 3; term -= 2) series = series * z + 2.0 / term;
  const double k = exponent;
  return k * kLn2 + (f - (s * (f - z * series) - k * kLn2Rest));
}

/// Returns x^y for x >= 0, with an error of some |y ln x| ulp, with the same bits on every processor.
inline double power(double x, double y) {
  if (x == 0.0) return y > 0.0 ? 0.0 : y == 0.0 ? 1.0 : std::numeric_limits<double>::infinity();
  return exp(y * log(x));
}

}  // namespace pyroclast
