#include "pyroclast/units/quantity_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/units/spellings.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

/// Largest whole part of a decimal that an expression tells from others.
constexpr double kLargest = 1e15;

/// Units that take prefixes, and units that take none.
constexpr std::array<std::string_view, 17> kWithPrefixes{"m",   "g", "s", "N",  "Pa",  "J", "W", "K",  "Hz",
                                                         "bar", "L", "t", "eV", "mol", "A", "V", "cal"};
constexpr std::array<std::string_view, 10> kPrefixes{"", "n", "u", "µ", "m", "c", "d", "k", "M", "G"};
constexpr std::array<std::string_view, 8> kLengths{"m", "cm", "mm", "um", "km", "in", "inch", "ft"};
constexpr std::array<std::string_view, 6> kPowers{"2", "3", "²", "³", "^2", "^3"};
constexpr std::array<std::string_view, 16> kDivided{"m", "mm", "m2", "kg", "g", "t",   "N",   "kN",
                                                    "J", "kJ", "W",  "kW", "K", "MPa", "GPa", "1"};
constexpr std::array<std::string_view, 11> kDivisors{"s",  "min", "h", "m",   "mm",  "m2",
                                                     "m3", "mm2", "K", "m/K", "kg/K"};
constexpr std::array<std::string_view, 42> kWithoutPrefixes{
    "%",      "rad",    "deg",   "degree", "min",    "minute", "h",      "hour",  "d",    "day",  "week",
    "year",   "inch",   "in",    "ft",     "foot",   "yd",     "yard",   "mile",  "psi",  "ksi",  "lb",
    "pound",  "lbf",    "kgf",   "atm",    "torr",   "BTU",    "hp",     "degC",  "degF", "degR", "celsius",
    "kelvin", "micron", "metre", "meter",  "second", "newton", "pascal", "joule", "watt"};

/// Units that are looked at: names with prefixes, their powers, and quotients that kinds of decks have.
const std::set<std::string>& candidates() {
  static const std::set<std::string> all = [] {
    std::set<std::string> found;
    for (std::string& spelling : unit_spellings()) found.insert(std::move(spelling));
    for (const Unit* kind : unit::all) {
      if (*kind != unit::dimensionless) found.insert(kind->si);
      found.insert(unit_of_quantity(kind->example));
    }
    found.insert(kWithoutPrefixes.begin(), kWithoutPrefixes.end());
    for (const std::string_view name : kWithPrefixes)
      for (const std::string_view prefix : kPrefixes) found.insert(fmt::format("{}{}", prefix, name));
    for (const std::string_view name : kLengths)
      for (const std::string_view power : kPowers) found.insert(fmt::format("{}{}", name, power));
    for (const std::string_view name : kDivided)
      for (const std::string_view by : kDivisors) found.insert(fmt::format("{}/{}", name, by));
    found.erase("1");
    return found;
  }();
  return all;
}

bool is_of(const std::string& given, const Unit& unit) {
  try {
    parse_quantity(fmt::format("1 {}", given), unit);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("\\^$.|?*+()[]{}/-\"").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string digits(std::size_t count) {
  return count == 0 ? "" : fmt::format("[0-9]{{{}}}", count);
}

/// Returns an expression of whole numbers greater, or less, than one that is not negative.
std::string whole_numbers(double than, bool greater) {
  const std::string n = fmt::format("{:.0f}", than);
  std::vector<std::string> ways;
  if (greater)
    ways.push_back(fmt::format("[1-9][0-9]{{{},}}", n.size()));
  else if (n.size() > 1)
    ways.push_back(fmt::format("[0-9]{{1,{}}}", n.size() - 1));
  for (std::size_t i = 0; i < n.size(); ++i) {
    const char least = static_cast<char>(greater ? n[i] + 1 : '0');
    const char most = static_cast<char>(greater ? '9' : n[i] - 1);
    if (least <= most)
      ways.push_back(fmt::format("{}[{}-{}]{}", n.substr(0, i), least, most, digits(n.size() - i - 1)));
  }
  return fmt::format("(?:{})", fmt::join(ways, "|"));
}

/// Returns expressions of decimals in a unit whose whole part lies beyond an end of a range in this unit.
std::vector<std::string> beyond(double lower, double upper, std::string_view unit) {
  constexpr double kRounding = 1e-9;
  constexpr auto kDecimals = "(?:\\.[0-9]*)?", kFewDecimals = "(?:\\.[0-9]{0,6})?";
  std::vector<std::string> numbers;
  const auto add = [&](std::string_view sign, double end, bool greater) {
    const double whole = std::floor(end * (1.0 + kRounding));
    if (!(whole < kLargest) || (!greater && whole < 1.0)) return;
    numbers.push_back(
        fmt::format("{}0*{}{}", sign, whole_numbers(whole, greater), greater ? kDecimals : kFewDecimals));
  };
  if (upper >= 0.0) add("\\+?", upper, true);
  if (std::abs(lower) < kRounding)
    numbers.emplace_back("-[0-9.]*[1-9][0-9.]*");
  else if (lower < 0.0)
    add("-", -lower, true);
  else if (std::isfinite(lower)) {
    add("\\+?", lower, false);
    numbers.push_back(fmt::format("-[0-9]+{}", kDecimals));
  }
  for (std::string& pattern : numbers) pattern = fmt::format("{}\\s*{}\\s*$", pattern, escaped(unit));
  return numbers;
}

}  // namespace

std::string quantity_pattern(const Unit& unit) {
  std::vector<std::string> of_others;
  for (const std::string& given : candidates())
    if (!is_of(given, unit)) of_others.push_back(escaped(given));
  // Behind a number, which must not be read in part, no digit follows but that of "1/s".
  return fmt::format(
      "^\\s*[-+]?(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][-+]?[0-9]+)?(?![0-9.]|[eE][-+]?[0-9]|[,_'][0-9])"
      "(?!\\s*[0-9](?!/)){}(?!\\s*(?:{})\\s*$)",
      unit == unit::dimensionless ? "" : "(?=\\s*\\S)", fmt::join(of_others, "|"));
}

std::string out_of_range_pattern(const Unit& unit, const Range& range) {
  std::vector<std::string> ways;
  const bool has_zero = unit != unit::temperature;  // whose units have zeros of their own
  if (has_zero && range.lower >= 0.0) ways.emplace_back("-[0-9.]*[1-9]");
  if (has_zero && !range.contains(0.0))
    ways.emplace_back("[-+]?(?:0+\\.?0*|\\.0+)(?:[eE][-+]?[0-9]+)?(?![0-9.eE])");
  std::vector<std::string_view> units = usual_units(unit);
  if (unit == unit::dimensionless) units.emplace_back("");
  for (const std::string_view given : units) {
    const UnitFactors factors = unit_factors(given.empty() ? "1" : given, unit);
    const auto in_unit = [&](double value) {
      return value * factors.divisor / factors.factor - factors.shift;
    };
    for (std::string& way : beyond(in_unit(range.lower), in_unit(range.upper), given))
      ways.push_back(std::move(way));
  }
  return ways.empty() ? "" : fmt::format("^\\s*(?:{})", fmt::join(ways, "|"));
}

}  // namespace pyroclast
