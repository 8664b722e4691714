#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/simulation/loop/stage.hpp"

/// Results of a stage by their names, for tests.
namespace pyroclast {

/// Results that stand alone or in a report.
struct ResultList {
  ResultList(const std::vector<Result>& results) : all(results) {}
  ResultList(const StageReport& report) : all(report.results) {}
  const std::vector<Result>& all;
};

/// Returns a result; none, and the test fails, where there is no such result.
inline Result::Value value_of(const ResultList& results, const std::string& name) {
  const auto found = std::ranges::find(results.all, name, &Result::name);
  if (found != results.all.end()) return found->value;
  ADD_FAILURE() << "no result " << name;
  return {};
}

inline bool is_none(const ResultList& results, const std::string& name) {
  return std::holds_alternative<std::monostate>(value_of(results, name));
}

/// Returns a number or a count; NaN for another result.
inline double number(const ResultList& results, const std::string& name) {
  const Result::Value value = value_of(results, name);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
  const auto* real = std::get_if<double>(&value);
  return real ? *real : std::nan("");
}

}  // namespace pyroclast
