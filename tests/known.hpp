#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

/// Comparisons with what is known beforehand. Suites that hold them have "Verification" in their names. With
/// the environment variable PYROCLAST_VERIFICATION each comparison adds a line to the file that it names,
/// from which validation/verification makes docs/understand/verification.md.
namespace pyroclast {

/// What is known: a closed form, a published benchmark or table, an independent solution.
struct Known {
  std::string what;    ///< the quantity and where it is taken, as the page shall say it
  std::string source;  ///< a citation, or how the value comes about
  std::string unit;
};

namespace known {

inline void write_down(const Known& known, const std::string& exact, const std::string& computed,
                       double deviation, double allowed) {
  const char* file = std::getenv("PYROCLAST_VERIFICATION");
  if (file == nullptr) return;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::ofstream line(file, std::ios::app);
  line.precision(17);
  for (const auto& text : {known.what, known.source, known.unit, exact, computed}) line << text << '\t';
  line << deviation << '\t' << allowed << '\t' << test.test_suite_name() << '.' << test.name() << '\t'
       << test.file() << '\n';
  EXPECT_TRUE(line.good()) << file;
}

inline std::string in_full(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

}  // namespace known

/// Expects a value within so much of the exact one, both in the unit.
inline void expect_known(const Known& known, double computed, double exact, double allowed) {
  EXPECT_NEAR(computed, exact, allowed) << known.what;
  const double scale = exact == 0.0 ? 1.0 : std::abs(exact);
  known::write_down(known, known::in_full(exact), known::in_full(computed),
                    std::abs(computed - exact) / scale, allowed / scale);
}

/// Expects the largest deviation of a field from the exact one within so much; `scale` is the field's own
/// range.
inline void expect_known_field(const Known& known, double largest_deviation, double scale, double allowed) {
  EXPECT_LE(largest_deviation, allowed) << known.what;
  known::write_down(known, "a field of " + known::in_full(scale), "", largest_deviation / scale,
                    allowed / scale);
}

}  // namespace pyroclast
