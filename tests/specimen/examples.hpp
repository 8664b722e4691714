#pragma once

#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/specimen/outline.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

constexpr double millimetre = 1e-3;

/// The aggregates of the paper's specimen (its section 3).
inline AggregateParameters paper_aggregates() {
  AggregateParameters p;
  p.fraction = 0.34;
  p.d_min = 4.75 * millimetre;
  p.d_max = 32 * millimetre;
  p.fuller_exponent = 0.45;
  p.sieves = {4.75e-3, 8e-3, 12.5e-3, 16e-3, 20e-3, 25e-3, 32e-3};
  p.minimum_gap = 0.5 * millimetre;
  p.attempts = 10000;
  return p;
}

inline SpecimenParameters paper_specimen(std::uint64_t seed) {
  SpecimenParameters p;
  p.outline = Region::rectangle(150 * millimetre, 300 * millimetre);
  p.seed = seed;
  p.aggregates = paper_aggregates();
  p.blocks.count = 5000;
  p.blocks.shortest_edge = 0.2;
  return p;
}

/// A stone with an outline, from its corners where they lie, m.
inline Stone<2> stone_of(std::vector<Vec<2>> corners) {
  const auto [outline, centre] = outline_around(std::move(corners));
  return {centre, outline->width(), 0, 0, outline};
}

/// Succeeds when the message has a part that matches the regular expression.
inline testing::AssertionResult says(const std::string& message, const std::string& pattern) {
  if (std::regex_search(message, std::regex(pattern))) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << message << "' does not say '" << pattern << "'";
}

}  // namespace pyroclast::specimen
