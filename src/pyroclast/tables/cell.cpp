#include "pyroclast/tables/cell.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/tables/moment.hpp"

namespace pyroclast {
namespace {

constexpr std::string_view kMinus = "\xE2\x88\x92";  // U+2212
constexpr std::string_view kDigits = "0123456789";

bool are_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == text.npos;
}

std::vector<std::string_view> parts_between(std::string_view text, std::string_view sign) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(sign);
    parts.push_back(text.substr(0, end));
    if (end == text.npos) return parts;
    text.remove_prefix(end + sign.size());
  }
}

/// Returns the sign between thousands of a whole number: a blank, narrow or not, an apostrophe, or the given
/// sign.
std::string_view sign_of_thousands(std::string_view text, std::string_view other) {
  constexpr std::array<std::string_view, 8> kSigns{" ",      "\u00A0", "\u202F", "\u2009",
                                                   "\u2007", "'",      "\u2019", "\u02BC"};
  const auto found =
      std::ranges::find_if(kSigns, [&](std::string_view sign) { return text.find(sign) != text.npos; });
  return found == kSigns.end() ? other : *found;
}

/// Returns digits, also of groups of three with one sign between them; empty where the text is something
/// else.
std::optional<std::string> whole_part(std::string_view text, std::string_view other) {
  const auto groups = parts_between(text, sign_of_thousands(text, other));
  if (!std::ranges::all_of(groups, are_digits)) return std::nullopt;
  if (groups.size() == 1) return std::string(text);
  if (groups[0].size() > 3 || groups[0][0] == '0') return std::nullopt;
  std::string digits(groups[0]);
  for (std::size_t i = 1; i < groups.size(); ++i) {
    if (groups[i].size() != 3) return std::nullopt;
    digits += groups[i];
  }
  return digits;
}

/// Returns the place of the letter before a power of ten, `npos` without one: e, or d as Fortran writes it
/// behind a decimal sign or before a sign.
std::size_t place_of_power(std::string_view number) {
  const std::size_t e = number.find_first_of("eE");
  if (e != number.npos) return e;
  const std::size_t d = number.find_first_of("dD");
  if (d == number.npos) return d;
  const std::string_view behind = number.substr(d + 1);
  const bool is_power = number.find_first_of(".,") < d || behind.starts_with('+') || behind.starts_with('-');
  return is_power ? d : number.npos;
}

}  // namespace

std::optional<std::string> plain_number(std::string_view cell, DecimalSign sign) {
  std::string number;
  if (cell.starts_with('-') || cell.starts_with(kMinus)) number += '-';
  if (cell.starts_with('-') || cell.starts_with('+'))
    cell.remove_prefix(1);
  else if (cell.starts_with(kMinus))
    cell.remove_prefix(kMinus.size());

  std::string_view power;
  const std::size_t e = place_of_power(cell);
  if (e != cell.npos) {
    power = cell.substr(e + 1);
    cell = cell.substr(0, e);
    const bool has_sign = power.starts_with('-') || power.starts_with('+');
    if (!are_digits(power.substr(has_sign ? 1 : 0))) return std::nullopt;
  }

  const bool is_point = sign == DecimalSign::point;
  const std::size_t decimal = cell.find(is_point ? '.' : ',');
  const std::string_view before = cell.substr(0, decimal);
  const std::string_view behind = decimal == cell.npos ? "" : cell.substr(decimal + 1);
  if (before.empty() || (decimal != cell.npos && behind.empty())) {
    if (!is_point || before.size() + behind.size() == 0) return std::nullopt;  // only ".5" and "20." pass
  }
  if (!behind.empty() && !are_digits(behind)) return std::nullopt;
  if (before.empty()) {
    number += '0';
  } else if (power.empty()) {
    const auto whole = whole_part(before, is_point ? "," : ".");
    if (!whole) return std::nullopt;
    number += *whole;
  } else {
    if (!are_digits(before)) return std::nullopt;  // nobody groups digits and writes a power of ten
    number += before;
  }
  if (!behind.empty()) number += fmt::format(".{}", behind);
  return power.empty() ? number : fmt::format("{}e{}", number, power);
}

SignEvidence sign_evidence(std::string_view number) {
  const bool has_point = number.find('.') != number.npos, has_comma = number.find(',') != number.npos;
  const bool by_point = plain_number(number, DecimalSign::point).has_value();
  const bool by_comma = plain_number(number, DecimalSign::comma).has_value();
  if (!has_point && !has_comma) return SignEvidence::none;
  if (by_point && by_comma) return has_point ? SignEvidence::point_or_comma : SignEvidence::comma_or_point;
  if (by_point) return has_comma ? SignEvidence::point_thousands : SignEvidence::point;
  return has_point ? SignEvidence::comma_thousands : SignEvidence::comma;
}

CellKind kind_of_cell(std::string_view cell) {
  if (cell.empty()) return CellKind::empty;
  if (plain_number(cell, DecimalSign::point) || plain_number(cell, DecimalSign::comma))
    return CellKind::number;
  if (const auto moment = moment_of(cell)) return moment->has_date() ? CellKind::stamp : CellKind::clock;
  return begins_with_date(cell) ? CellKind::date : CellKind::text;
}

}  // namespace pyroclast
