#include "pyroclast/units/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <locale.h>
#include <udunits2.h>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/units/decimal.hpp"
#include "pyroclast/units/spellings.hpp"

namespace pyroclast {
namespace {

struct UnitFree {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using UnitHandle = std::unique_ptr<ut_unit, UnitFree>;

struct SystemFree {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
using SystemHandle = std::unique_ptr<ut_system, SystemFree>;

struct ConverterFree {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using ConverterHandle = std::unique_ptr<cv_converter, ConverterFree>;

/// Holder of the "C" locale for this thread while it lives: UDUNITS-2 reads its numbers with `strtod`.
class ClassicLocale {
 public:
  ClassicLocale() : classic_(newlocale(LC_ALL_MASK, "C", nullptr)), previous_(uselocale(classic_)) {}
  ~ClassicLocale() {
    uselocale(previous_);
    freelocale(classic_);
  }
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  locale_t classic_;
  locale_t previous_;
};

/// Structure of a unit in UDUNITS-2: a product of base units, perhaps scaled and shifted.
struct Structure {
  bool linear = true;       ///< true unless it is a date or a logarithm
  bool has_offset = false;  ///< true for a temperature scale
  int base_units = 0;       ///< number of base units with a non-zero power; the radian counts as one
};

Structure structure_of(const ut_unit* unit) {
  ut_visitor visitor{};
  visitor.visit_basic = [](const ut_unit*, void* result) {
    static_cast<Structure*>(result)->base_units = 1;
    return UT_SUCCESS;
  };
  visitor.visit_product = [](const ut_unit*, int count, const ut_unit* const*, const int*, void* result) {
    static_cast<Structure*>(result)->base_units = count;
    return UT_SUCCESS;
  };
  visitor.visit_galilean = [](const ut_unit*, double, const ut_unit* underlying, double offset,
                              void* result) {
    auto& structure = *static_cast<Structure*>(result);
    structure = structure_of(underlying);
    structure.has_offset = structure.has_offset || offset != 0.0;
    return UT_SUCCESS;
  };
  visitor.visit_timestamp = [](const ut_unit*, const ut_unit*, double, void* result) {
    static_cast<Structure*>(result)->linear = false;
    return UT_SUCCESS;
  };
  visitor.visit_logarithmic = [](const ut_unit*, double, const ut_unit*, void* result) {
    static_cast<Structure*>(result)->linear = false;
    return UT_SUCCESS;
  };
  Structure structure;
  ut_accept_visitor(unit, &visitor, &structure);
  return structure;
}

/// Tells whether two units have the same dimension. UDUNITS-2 also converts between reciprocals (s and Hz)
/// and between rad and 1; neither is meant in a deck.
bool same_dimension(const ut_unit* a, const ut_unit* b) {
  if (!structure_of(a).linear || !structure_of(b).linear) return false;
  const UnitHandle quotient(ut_divide(a, b));
  return quotient && structure_of(quotient.get()).base_units == 0;
}

bool is_space(char c) {
  return c == ' ' || c == '\t';
}
/// Returns the number of bytes of the letter with which a unit's name goes on; 0 if there is none.
std::size_t letter_length(std::string_view text) {
  const char c = text.front();
  if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') return 1;
  // letters outside of ASCII in the names and prefixes of UDUNITS-2, each in all its code points
  static constexpr std::array<std::string_view, 11> others{
      "µ", "μ", "°", "Ω", "\u2126", "Å", "\u212B", "\u2103", "\u2109", "\u2032", "\u2033"};
  const auto found = std::find_if(others.begin(), others.end(),
                                  [&](std::string_view letter) { return text.starts_with(letter); });
  return found == others.end() ? 0 : found->size();
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Writes superscripts and products in ASCII. UDUNITS-2 takes some of them itself, but not "⁻".
std::string in_ascii(std::string_view unit) {
  using Replacement = std::pair<std::string_view, char>;
  // clang-format off
  static constexpr std::array<Replacement, 14> replacements{{
      {"⁰", '0'}, {"¹", '1'}, {"²", '2'}, {"³", '3'}, {"⁴", '4'}, {"⁵", '5'}, {"⁶", '6'},
      {"⁷", '7'}, {"⁸", '8'}, {"⁹", '9'}, {"⁻", '-'}, {"−", '-'}, {"·", '.'}, {"⋅", '.'}}};
  // clang-format on
  std::string result;
  while (!unit.empty()) {
    const auto found = std::find_if(replacements.begin(), replacements.end(),
                                    [&](const Replacement& r) { return unit.starts_with(r.first); });
    const bool replace = found != replacements.end();
    result += replace ? found->second : unit.front();
    unit.remove_prefix(replace ? found->first.size() : 1);
  }
  return result;
}

/// Text of a unit, taken apart and written anew in the one form that UDUNITS-2 is given: names, ".", "/", "^"
/// and parentheses. UDUNITS-2 takes more than anybody means, such as "400 GPa/m" (from "18 400 GPa/m") or "s
/// since 2000", and loses memory at each text that it cannot read.
class UnitText {
 public:
  explicit UnitText(std::string_view unit) : text_(in_ascii(unit)), rest_(text_) {}
  UnitText(const UnitText&) = delete;
  UnitText& operator=(const UnitText&) = delete;

  /// Returns the unit written anew; none if the text does not have the form of a unit.
  std::optional<std::string> rewritten() {
    if (rest_.size() > kMostCharacters) return std::nullopt;
    if (rest_.starts_with('/')) {
      written_ = "1";
    } else if (rest_ == "1" || rest_.starts_with("1/")) {
      written_ += take(1);
    } else if (!read_power()) {
      return std::nullopt;
    }
    if (!read_factors() || !rest_.empty()) return std::nullopt;
    return written_;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  static constexpr std::size_t kMostCharacters = 100;
  static constexpr std::size_t kMostDigits = 2;  ///< digits of an exponent

  std::string_view take(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  bool take(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  bool take_blanks() {
    const std::size_t before = rest_.size();
    while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
    return rest_.size() != before;
  }

  /// Reads a product up to the end or a closing parenthesis. Returns false where there is none.
  bool read_product() {
    take_blanks();
    return read_power() && read_factors();
  }

  bool read_factors() {
    char before = '.';
    for (;;) {
      const bool behind_exponent = is_digit(written_.back()) && written_ != "1";
      const bool apart = take_blanks();
      if (rest_.empty() || rest_.front() == ')') return true;
      char sign = '.';
      if (take("/")) {
        sign = '/';
      } else if (!take(".") && !take("*") && !take("-") && !apart && behind_exponent && name_length() > 0) {
        sign = before;  // a name right behind "m2", as in "W/m2K", belongs to it
      }
      take_blanks();
      written_ += sign;
      if (!read_power()) return false;
      before = sign;
    }
  }

  bool read_power() {
    if (take("(")) {
      written_ += '(';
      if (!read_product() || !take(")")) return false;
      written_ += ')';
    } else {
      const std::size_t length = name_length();
      if (length == 0) return false;
      names_.emplace_back(take(length));
      written_ += names_.back();
    }
    return read_exponent();
  }

  /// Reads an exponent. Returns true also if there is none, and false for one that is not sound.
  bool read_exponent() {
    const bool marked = take("**") || take("^");
    const bool has_sign = rest_.starts_with('-') || rest_.starts_with('+');
    const std::size_t first = has_sign ? 1 : 0;
    std::size_t end = first;
    while (end < rest_.size() && is_digit(rest_[end])) ++end;
    if (end == first) return !marked;
    if (end - first > kMostDigits) return false;
    written_ += '^';
    written_ += take(end);
    return true;
  }

  /// Returns the length of the name that the rest begins with; 0 if there is none.
  std::size_t name_length() const {
    if (rest_.starts_with('%') || rest_.starts_with('\'') || rest_.starts_with('"')) return 1;
    std::size_t length = 0;
    while (length < rest_.size()) {
      const std::size_t more = letter_length(rest_.substr(length));
      if (more == 0) break;
      length += more;
    }
    return length;
  }

  std::string text_;
  std::string_view rest_;
  std::string written_;
  std::vector<std::string> names_;
};

/// Unit database. UDUNITS-2 keeps its parser and its status in globals, so one lock guards every call.
class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }

  std::mutex& mutex() { return mutex_; }

  /// Returns a unit; null if the text is not one.
  UnitHandle parse(std::string_view unit) const {
    const ClassicLocale locale;
    const std::string_view share = share_unit(unit);
    UnitText text(share.empty() ? unit : share);
    const auto rewritten = text.rewritten();
    const auto& names = text.names();
    if (!rewritten || !std::all_of(names.begin(), names.end(), [&](const auto& n) { return is_known(n); }))
      return nullptr;
    return UnitHandle(ut_parse(system_.get(), rewritten->c_str(), UT_UTF8));
  }

 private:
  UnitSystem() {
    const ClassicLocale locale;
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_) {
      ut_status status = UT_SUCCESS;
      throw Error(
          fmt::format("the unit database {} of UDUNITS-2 cannot be read; install it (Debian package "
                      "libudunits2-data) or set UDUNITS2_XML_PATH",
                      ut_get_path_xml(nullptr, &status)));
    }
    const UnitHandle degree(ut_get_unit_by_name(system_.get(), "degree"));
    ut_map_symbol_to_unit("deg", UT_ASCII, degree.get());
  }

  /// Tells whether a name alone is a unit that products may hold: neither a date nor a logarithm.
  bool is_known(const std::string& name) const {
    const UnitHandle unit(ut_parse(system_.get(), name.c_str(), UT_UTF8));
    return unit && structure_of(unit.get()).linear;
  }

  std::mutex mutex_;
  SystemHandle system_;
};

struct NumberAndUnit {
  double number;
  std::string_view written;  ///< number as it is written
  std::string_view unit;
};

/// Tells whether the text behind a number goes on with it, as in "18,400", "1_000" or "18 400".
bool continues_number(std::string_view rest) {
  if (rest.empty()) return false;
  const bool separator = rest[0] == ',' || rest[0] == '_' || rest[0] == '\'';
  rest = separator ? rest.substr(1) : trimmed(rest);
  return !rest.empty() && is_digit(rest[0]) && !rest.starts_with("1/");
}

NumberAndUnit split(std::string_view text, const Unit& unit) {
  using Kind = QuantityError::Kind;
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  double number = 0.0;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (status == std::errc::invalid_argument) {
    throw QuantityError(Kind::no_number, text, "no number; " + requirement(unit));
  }
  if (status == std::errc::result_out_of_range || !std::isfinite(number)) {
    throw QuantityError(Kind::not_finite, text, "the number is not finite or out of the range of doubles");
  }
  const std::string_view written = rest.substr(0, static_cast<std::size_t>(end - rest.data()));
  rest.remove_prefix(written.size());
  if (continues_number(rest)) {
    throw QuantityError(
        Kind::no_number, text,
        "not one number; write numbers with a decimal point and without separators; " + requirement(unit));
  }
  rest = trimmed(rest);
  if (rest.starts_with('[') && rest.ends_with(']')) rest = trimmed(rest.substr(1, rest.size() - 2));
  if (unit == unit::dimensionless && rest == "-") rest = "";
  return {number, written, rest};
}

/// Returns the temperature scale that people mean by a letter, which here stands for coulomb or farad; empty
/// for another text.
std::string_view meant_temperature(std::string_view given) {
  if (given == "C" || given == "°C" || given == "deg C") return "degC";
  if (given == "F" || given == "°F" || given == "deg F") return "degF";
  return "";
}

/// Says which unit is needed, and which unit is most likely meant.
std::string remedy(std::string_view given, const Unit& unit) {
  const std::string_view meant = meant_spelling(given, unit);
  if (meant.empty() || meant == given) return requirement(unit);
  return fmt::format("{}; did you mean \"{}\"?", requirement(unit), meant);
}

[[noreturn]] void throw_wrong_dimension(std::string_view text, std::string_view given, const Unit& unit) {
  throw QuantityError(QuantityError::Kind::wrong_dimension, text,
                      fmt::format("unit \"{}\" has the wrong dimension; {}", given, remedy(given, unit)));
}

/// Conversion whose factors are decimals; empty where they are not.
struct DecimalConversion {
  std::optional<Decimal> shift, factor, divisor;
};

/// Finds the factors of a converter, from doubles that it converts.
UnitFactors measured(const cv_converter* converter) {
  constexpr double kFar = 1e6;  // so that the shift is lost in the slope
  const double start = cv_convert_double(converter, 0.0);
  if (start == 0.0) return {.factor = cv_convert_double(converter, 1.0)};
  const double slope = (cv_convert_double(converter, kFar) - start) / kFar;
  return {.shift = start / slope, .factor = slope};
}

DecimalConversion decimals_of(const UnitFactors& of) {
  constexpr Decimal kOne{1, 0};
  const auto shift = of.shift == 0.0 ? Decimal{} : nearest_decimal(of.shift);
  if (const auto factor = nearest_decimal(of.factor)) return {shift, factor, kOne};
  return {shift, kOne, nearest_decimal(1.0 / of.factor)};
}

/// Converter of a unit to that of a kind.
/// \param text  text that messages quote
class Converter {
 public:
  Converter(std::string_view text, std::string_view given, const Unit& unit) {
    UnitSystem& system = UnitSystem::instance();
    const std::scoped_lock lock(system.mutex());
    const UnitHandle from = system.parse(given);
    if (!from) {
      throw QuantityError(QuantityError::Kind::unknown_unit, text,
                          fmt::format("unknown unit \"{}\"; {}", given, remedy(given, unit)));
    }
    const UnitHandle to = system.parse(unit.si);
    if (!to)
      throw Error(fmt::format("\"{}\", the unit of {}, is not known to UDUNITS-2", unit.si, unit.name));
    if (!same_dimension(from.get(), to.get())) throw_wrong_dimension(text, given, unit);
    if (structure_of(from.get()).has_offset && !structure_of(to.get()).has_offset) {
      throw QuantityError(
          QuantityError::Kind::wrong_dimension, text,
          fmt::format("\"{}\" is a temperature, not a difference; {}", given, remedy(given, unit)));
    }
    converter_.reset(ut_get_converter(from.get(), to.get()));
    if (!converter_) throw_wrong_dimension(text, given, unit);
    by_doubles_ = measured(converter_.get());
    by_decimals_ = decimals_of(by_doubles_);
  }

  /// Returns the double nearest to the value of a number as it is written, where that can be told; else
  /// converts the double.
  double operator()(double number, std::string_view written) const {
    if (const auto decimal = decimal_of(written); decimal && is_exact())
      if (const auto value =
              nearest_double(*decimal, *by_decimals_.shift, *by_decimals_.factor, *by_decimals_.divisor))
        return *value;
    return cv_convert_double(converter_.get(), number);
  }

  UnitFactors conversion() const {
    if (!is_exact()) return by_doubles_;
    const auto [digits, exponent] = *by_decimals_.factor;
    const Decimal factor{digits, std::max(exponent, 0)}, tens{1, std::max(-exponent, 0)};
    return {by_decimals_.shift->value(), factor.value(), by_decimals_.divisor->value() * tens.value()};
  }

 private:
  bool is_exact() const { return by_decimals_.shift && by_decimals_.factor && by_decimals_.divisor; }

  ConverterHandle converter_;
  UnitFactors by_doubles_;
  DecimalConversion by_decimals_;
};

double finite(double value, std::string_view text, const Unit& unit) {
  if (std::isfinite(value)) return value;
  throw QuantityError(QuantityError::Kind::not_finite, text, fmt::format("too large in {}", unit.si));
}

}  // namespace

QuantityError::QuantityError(Kind kind, std::string_view text, const std::string& reason)
    : Error(fmt::format("\"{}\": {}", text, reason)), kind_(kind), reason_(reason) {}

double parse_quantity(std::string_view text, const Unit& unit) {
  const auto [number, written, given] = split(text, unit);
  if (!given.empty()) return finite(Converter(text, given, unit)(number, written), text, unit);
  if (unit == unit::dimensionless) return number;
  throw QuantityError(QuantityError::Kind::no_unit, text, "no unit; " + requirement(unit));
}

std::function<double(std::string_view)> quantity_reader(std::string_view given, const Unit& unit) {
  if (given == "1" && unit == unit::dimensionless)
    return [unit](std::string_view text) { return parse_quantity(text, unit); };
  const auto converter = std::make_shared<const Converter>(given, given, unit);
  return [converter, unit](std::string_view text) {
    const auto [number, written, rest] = split(text, unit);
    if (!rest.empty()) throw QuantityError(QuantityError::Kind::no_number, text, "not a number alone");
    return finite((*converter)(number, written), text, unit);
  };
}

UnitFactors unit_factors(std::string_view given, const Unit& unit) {
  return given == "1" && unit == unit::dimensionless ? UnitFactors()
                                                     : Converter(given, given, unit).conversion();
}

double parse_any_quantity(std::string_view text) {
  for (const Unit* kind : unit::all) {
    try {
      return parse_quantity(text, *kind);
    } catch (const QuantityError& error) {
      if (error.kind() != QuantityError::Kind::wrong_dimension &&
          error.kind() != QuantityError::Kind::no_unit)
        throw;
    }
  }
  throw QuantityError(QuantityError::Kind::wrong_dimension, text,
                      "its unit is of none of the kinds that decks hold (`pyroclast list units`)");
}

bool is_unit(std::string_view text) {
  UnitSystem& system = UnitSystem::instance();
  const std::scoped_lock lock(system.mutex());
  return system.parse(text) != nullptr;
}

std::string_view meant_unit(std::string_view given, const Unit& unit) {
  const std::string_view meant = unit == unit::temperature ? meant_temperature(given) : "";
  return meant.empty() ? given : meant;
}

std::string unit_of_quantity(std::string_view text) {
  const std::string_view given = split(text, unit::dimensionless).unit;
  return given.empty() ? "1" : std::string(given);
}

std::string requirement(const Unit& unit) {
  if (unit == unit::dimensionless)
    return fmt::format("a number without unit is needed, or e.g. \"{}\"", unit.example);
  return fmt::format("a unit of {} ({}) is needed, e.g. \"{}\"", unit.name, unit.si, unit.example);
}

}  // namespace pyroclast
