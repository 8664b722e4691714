#include "pyroclast/base/range.hpp"

#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/rounding.hpp"

namespace pyroclast {

bool Range::contains(double value) const {
  const bool above_lower = lower_inclusive ? value >= lower : value > lower;
  const bool below_upper = upper_inclusive ? value <= upper : value < upper;
  return above_lower && below_upper;
}

double Range::but_for_rounding(double value) const {
  if (lower_inclusive && value < lower && same(value, lower)) return lower;
  if (upper_inclusive && value > upper && same(value, upper)) return upper;
  return value;
}

double Range::any_value() const {
  for (const double candidate : {1.0, 0.0, std::ceil(lower), std::floor(lower) + 1.0, std::floor(upper),
                                 std::ceil(upper) - 1.0, lower, upper}) {
    if (std::isfinite(candidate) && contains(candidate)) return candidate;
  }
  return 0.5 * (lower + upper);
}

std::string Range::describe(std::string_view unit) const {
  const std::string suffix = unit.empty() ? "" : fmt::format(" {}", unit);
  const bool has_lower = std::isfinite(lower);
  const bool has_upper = std::isfinite(upper);
  if (has_lower && has_upper && lower_inclusive && upper_inclusive) {
    return fmt::format("between {} and {}{}", lower, upper, suffix);
  }
  std::string words;
  if (has_lower) words = fmt::format("{} {}{}", lower_inclusive ? "at least" : "greater than", lower, suffix);
  if (has_lower && has_upper) words += " and ";
  if (has_upper) words += fmt::format("{} {}{}", upper_inclusive ? "at most" : "less than", upper, suffix);
  return words;
}

std::string Range::describe_usual(std::string_view unit) const {
  return Range{.lower = usual_lower, .upper = usual_upper}.describe(unit);
}

std::string Range::describe_all(std::string_view unit) const {
  const std::string must = describe(unit), usual = describe_usual(unit);
  if (usual.empty()) return must;
  return fmt::format("{}{}usually {}", must, must.empty() ? "" : "; ", usual);
}

}  // namespace pyroclast
