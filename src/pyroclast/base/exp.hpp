#pragma once

#include "pyroclast/base/lanes.hpp"

/// The exponential function of a number and of lanes, with the same bits on every processor, in every
/// instruction set and in every lane. The function of a C library does not promise this.
namespace pyroclast {

namespace exp_parts {

/// Computes e^x by the argument reduction of Cody and Waite (Software Manual for the Elementary Functions,
/// 1980, ch. 6): e^x = 2^n e^r with r = x - n ln 2, |r| <= (ln 2) / 2. ln 2 is the sum of two numbers; the
/// first has so few bits that its product with n is exact.
template <class Real>
Real exp(const Real& given) {
  constexpr double kRound = 0x1.8p52;  // when added and taken away again, rounds to the nearest whole number
  constexpr double kOverLn2 = 0x1.71547652b82fep0;
  constexpr double kLn2 = 0x1.62e42feep-1, kLn2Rest = 0x1.a39ef35793c76p-33;
  // Beyond these bounds the result is 0 or infinite. This order of arguments keeps NaN as NaN.
  const Real x = larger(smaller(given, Real(710.0)), Real(-746.0));
  const Real n = (x * kOverLn2 + kRound) - kRound;
  const Real above = x - n * kLn2;
  const Real rest = n * kLn2Rest;
  const Real r = above - rest;
  const Real rounded_off = (above - r) - rest;

  // The series is 1/2! + r/3! + ... + r^11/13!; the terms left out are below 0.04 ulp of e^r.
  constexpr double kSeries[] = {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0,
                                1.0 / 40320.0,     1.0 / 5040.0,     1.0 / 720.0,     1.0 / 120.0,
                                1.0 / 24.0,        1.0 / 6.0,        1.0 / 2.0};
  Real series = 1.0 / 6227020800.0;
  for (const double term : kSeries) series = series * r + term;
  const Real power = 1.0 + (r + (r * r * series + rounded_off));

  // 2^n is taken in two factors, each a normal number, so that only the last product is rounded.
  const Real half = (n * 0.5 + kRound) - kRound;
  return power * power_of_two(half) * power_of_two(n - half);
}

}  // namespace exp_parts

/// Returns e^x with an error below 1 ulp, denormal results included. The result is infinite above 709.78 and
/// zero below -745.13; NaN stays NaN.
inline double exp(double x) {
  return exp_parts::exp(x);
}
template <class Set>
Lanes<Set> exp(const Lanes<Set>& x) {
  return exp_parts::exp(x);
}

}  // namespace pyroclast
