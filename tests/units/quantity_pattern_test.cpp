#include "pyroclast/units/quantity_pattern.hpp"

#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

bool matches(const std::string& pattern, const std::string& text) {
  return std::regex_search(text, std::regex(pattern, std::regex::ECMAScript));
}

bool is_read(const std::string& text, const Unit& unit) {
  try {
    parse_quantity(text, unit);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

TEST(QuantityPattern, TellsKindsApartAsTheReaderDoes) {
  for (const Unit* unit : unit::all) {
    const std::regex pattern(quantity_pattern(*unit), std::regex::ECMAScript);
    for (const Unit* other : unit::all)
      for (const std::string& text :
           std::vector<std::string>{other->example, std::string("1e-3 ") + other->si})
        EXPECT_EQ(std::regex_search(text, pattern), is_read(text, *unit)) << text << " as " << unit->name;
  }
}

TEST(QuantityPattern, TakesWhateverTheReaderTakes) {
  for (const std::string& text : std::vector<std::string>{" 150mm ", "+.5 m", "-1e-3km", "1E2 furlong",
                                                          "3 m^2/m", "2. inch", "1e3um"}) {
    EXPECT_TRUE(is_read(text, unit::length)) << text;
    EXPECT_TRUE(matches(quantity_pattern(unit::length), text)) << text;
  }
  for (const std::string& text : std::vector<std::string>{"", "mm", "150", "many mm", "1,5 mm", "18 400 mm",
                                                          "1e3 kg", "150kg", "3 m2", "0.5 %"})
    EXPECT_FALSE(matches(quantity_pattern(unit::length), text)) << text;
  EXPECT_TRUE(matches(quantity_pattern(unit::frequency), "10 1/s"));
}

TEST(QuantityPattern, NumbersOutOfARangeAreToldWhereTheyCanBe) {
  struct Tried {
    const Unit& unit;
    Range range;
    std::vector<std::string> out, in;
  };
  for (const Tried& tried :
       {Tried{unit::length, Range::positive(), {"-1 mm", "0 m", "0.00mm", "-1e-9 m"}, {"0.1 mm", "1e-9 m"}},
        Tried{unit::length, Range::non_negative(), {"-0.5 mm"}, {"0 mm", "-0 mm", "3 m"}},
        Tried{unit::dimensionless, Range::fraction(), {"-1 %", "101 %", "2"}, {"100 %", "0.4", "1"}},
        Tried{unit::angle,
              {.upper = 1.57, .upper_inclusive = false},
              {"95 deg", "2 rad"},
              {"34 deg", "89.9 deg"}},
        Tried{unit::temperature,
              Range::at_least(-273.15),
              {"-300 degC", "-1 K", "-460 degF"},
              {"-273 degC", "0 K", "-40 degF"}},
        Tried{unit::temperature,
              Range::at_least(20.0),
              {"19 degC", "-5 degC", "200 K"},
              {"20 degC", "300 K", "68 degF"}}}) {
    const std::string pattern = out_of_range_pattern(tried.unit, tried.range);
    for (const std::string& text : tried.out) {
      EXPECT_FALSE(tried.range.contains(parse_quantity(text, tried.unit))) << text;
      EXPECT_TRUE(matches(pattern, text)) << text;
    }
    for (const std::string& text : tried.in) EXPECT_FALSE(matches(pattern, text)) << text;
  }
  EXPECT_EQ(out_of_range_pattern(unit::length, Range::any()), "");
}

}  // namespace
}  // namespace pyroclast
