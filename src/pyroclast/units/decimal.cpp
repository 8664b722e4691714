#include "pyroclast/units/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/characters.hpp"

namespace pyroclast {

namespace {

__extension__ using Wide = __int128;

/// Number of digits of a factor of units, and relative distance within which a product of a few doubles is
/// such a factor.
constexpr int kFewDigits = 12;
constexpr double kNear = 1e-14;

constexpr int kMostDigits = 18;    ///< digits that 64 bits hold
constexpr int kMostExponent = 60;  ///< largest exponent; beyond it nobody writes numbers
/// Number of digits of a quotient: more than it takes to tell which double is nearest.
constexpr int kQuotientDigits = 30;

/// Multiplies a number; returns false where the product does not fit.
bool multiply(Wide& number, Wide by) {
  return !__builtin_mul_overflow(number, by, &number);
}
bool multiply_by_ten(Wide& number, int times) {
  for (; times > 0 && number != 0; --times)
    if (!multiply(number, 10)) return false;
  return true;
}

Decimal without_zeros(Decimal d) {
  if (d.digits == 0) return {};
  for (; d.digits % 10 == 0; d.digits /= 10) ++d.exponent;
  return d;
}

std::string digits_of(Wide number) {
  std::string text;
  for (; number > 0; number /= 10)
    text.insert(text.begin(), static_cast<char>('0' + static_cast<int>(number % 10)));
  return text;
}

/// Returns the double nearest to numerator / denominator * 10^exponent, of positive numbers.
double nearest_quotient(Wide numerator, Wide denominator, int exponent) {
  std::string text = digits_of(numerator / denominator);
  Wide rest = numerator % denominator;
  while (rest != 0 && text.size() < kQuotientDigits) {
    rest *= 10;
    const int digit = static_cast<int>(rest / denominator);
    if (digit != 0 || !text.empty()) text += static_cast<char>('0' + digit);
    rest %= denominator;
    --exponent;
  }
  if (rest != 0) text += '1', --exponent;  // a little more than the digits say
  text += fmt::format("e{}", exponent);
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

double Decimal::value() const {
  return nearest_double(*this, {}, {1, 0}, {1, 0}).value_or(0.0);
}

std::optional<Decimal> decimal_of(std::string_view number) {
  Decimal result;
  const bool negative = number.starts_with('-');
  if (negative) number.remove_prefix(1);
  int kept = 0;
  bool behind_point = false;
  std::size_t i = 0;
  for (; i < number.size() && (is_digit(number[i]) || number[i] == '.'); ++i) {
    if (number[i] == '.') {
      behind_point = true;
      continue;
    }
    if (kept > 0 || number[i] != '0') ++kept;
    if (kept > kMostDigits) return std::nullopt;
    result.digits = 10 * result.digits + (number[i] - '0');
    if (behind_point) --result.exponent;
  }
  if (i < number.size()) {
    std::string_view exponent = number.substr(i + 1);
    if (exponent.starts_with('+')) exponent.remove_prefix(1);
    int power = 0;
    const auto [end, status] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
    if (status != std::errc() || std::abs(power) > kMostExponent) return std::nullopt;
    result.exponent += power;
  }
  if (negative) result.digits = -result.digits;
  return without_zeros(result);
}

std::optional<Decimal> nearest_decimal(double number) {
  if (!std::isfinite(number)) return std::nullopt;
  const std::string text = fmt::format("{:.{}e}", number, kFewDigits - 1);
  const auto decimal = decimal_of(text);
  if (!decimal || std::abs(decimal->value() - number) > kNear * std::abs(number)) return std::nullopt;
  return decimal;
}

std::optional<double> nearest_double(Decimal number, Decimal shift, Decimal factor, Decimal divisor) {
  const int exponent = std::min(number.exponent, shift.digits == 0 ? number.exponent : shift.exponent);
  Wide sum = number.digits, shifted = shift.digits;
  if (!multiply_by_ten(sum, number.exponent - exponent) ||
      !multiply_by_ten(shifted, shift.digits == 0 ? 0 : shift.exponent - exponent))
    return std::nullopt;
  sum += shifted;
  if (sum == 0) return 0.0;
  const bool negative = sum < 0;
  if (negative) sum = -sum;
  if (!multiply(sum, factor.digits)) return std::nullopt;
  const double value = nearest_quotient(sum, divisor.digits, exponent + factor.exponent - divisor.exponent);
  return negative ? -value : value;
}

}  // namespace pyroclast
