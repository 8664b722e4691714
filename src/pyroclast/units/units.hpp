#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// Error of a text that is not a quantity of the kind asked for. `what()` is the text in quotes and the
/// reason.
class QuantityError : public Error {
 public:
  enum class Kind { no_number, not_finite, no_unit, unknown_unit, wrong_dimension };

  QuantityError(Kind kind, std::string_view text, const std::string& reason);

  Kind kind() const { return kind_; }
  /// Says what is wrong and what is allowed, without the text itself.
  const std::string& reason() const { return reason_; }

 private:
  Kind kind_;
  std::string reason_;
};

/// Returns the value of a quantity such as "18400 GPa/m", "20 degC" or "25 W/m²/K", in `unit.si`.
///
/// The number is written with a decimal point, whatever the locale. The unit is a product of powers of names
/// that UDUNITS-2 knows, or "deg" for an angle. It has at most 100 characters, and exponents of at most two
/// digits. A dimensionless quantity needs no unit; "‰", "microstrain", "Vol.-%" and the like are units of it.
/// "/" divides by the one unit that follows, and by a unit that stands directly behind the exponent of that
/// unit: "W/m2/K", "W/(m2 K)" and "W/m²K" are a heat transfer coefficient, "W/m2 K" is not. Some texts are
/// refused although UDUNITS-2 would take them, because nobody means them: numbers inside a unit ("18 400
/// GPa/m"), dates and logarithms ("s since 2000", "lg(re 1 mW)"), a unit for its reciprocal ("4 s" for a
/// frequency), radians for a plain number. The function may be called from several threads.
///
/// The value is the double nearest to the written quantity wherever the factor of the unit is a decimal or
/// the reciprocal of one: "10 us" is 1e-5, "68 degF" 20 °C.
///
/// @throws QuantityError if the text has no number, a number that is not finite, no unit, a unit that is not
///         known, or a unit of another dimension.
/// @throws Error if the unit database cannot be read.
double parse_quantity(std::string_view text, const Unit& unit);

/// Returns a function that reads numbers that are all in one unit, "1" for none, as parse_quantity reads them
/// with that unit. The returned function throws QuantityError for a text that is no number, and for a number
/// that is not finite.
///
/// @throws QuantityError if the unit is not known or of another dimension.
std::function<double(std::string_view number)> quantity_reader(std::string_view given, const Unit& unit);

/// Returns the value of a quantity of any kind that decks hold, in the unit of its kind.
///
/// @throws QuantityError as parse_quantity does; wrong_dimension if the quantity is of no such kind.
double parse_any_quantity(std::string_view text);

/// Conversion of a value from one unit to another: (x + shift) * factor / divisor. The three numbers are
/// exact decimals where the units are decimals of each other, such as 60 s to a minute or 5/9 K to a degree
/// Fahrenheit.
struct UnitFactors {
  double shift = 0.0, factor = 1.0, divisor = 1.0;

  bool is_none() const { return shift == 0.0 && factor == divisor; }
  double operator()(double x) const { return (x + shift) * factor / divisor; }
};

/// Returns the conversion from a given unit, "1" for none, to the unit of a kind.
/// @throws QuantityError as parse_quantity does.
UnitFactors unit_factors(std::string_view given, const Unit& unit);

/// Tells whether a text is a unit that a quantity of some kind may have.
bool is_unit(std::string_view text);

/// Returns the unit that measured tables mean by a text where a quantity of this kind is read: "C" and "°C"
/// of a temperature mean "degC". In a deck, which is written by hand, they are an error that names the right
/// unit.
std::string_view meant_unit(std::string_view given, const Unit& unit);

/// Returns the unit of a quantity as written behind the number; "1" where there is none.
std::string unit_of_quantity(std::string_view text);

/// Describes how a quantity of this kind must be written, for messages: 'a unit of length (m) is needed, e.g.
/// "150 mm"'.
std::string requirement(const Unit& unit);

}  // namespace pyroclast
