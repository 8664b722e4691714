#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pyroclast {

/// T0, °C: temperature at which properties without a curve hold, and from which thermal strain counts.
inline constexpr double kReferenceTemperature = 20.0;

inline constexpr double absolute_zero = -273.15;  ///< °C

/// Closed interval on which a curve is defined. The default is the whole real line.
struct Interval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();

  bool contains(double x) const { return lower <= x && x <= upper; }
  /// Tells whether the interval contains x but for rounding, see `same`: relative to the largest magnitude
  /// among x and the ends.
  /// \param zero  value from which magnitudes count
  bool holds(double x, double zero = 0.0) const;
  bool holds(const Interval& other, double zero = 0.0) const {
    return holds(other.lower, zero) && holds(other.upper, zero);
  }
  bool operator==(const Interval&) const = default;
};

/// Returns an interval that contains nothing until `include` extends it.
inline constexpr Interval nothing() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {infinity, -infinity};
}
inline void include(Interval& range, double x) {
  range = {x < range.lower ? x : range.lower, x > range.upper ? x : range.upper};
}
inline void include(Interval& range, const Interval& other) {
  range = {other.lower < range.lower ? other.lower : range.lower,
           other.upper > range.upper ? other.upper : range.upper};
}

/// Variable of a curve: its symbol (also the variable of an expression) and its unit, for messages.
struct CurveAxis {
  std::string symbol;
  std::string unit;

  bool operator==(const CurveAxis&) const = default;
};

/// Returns the axis of property curves: T in degC.
inline CurveAxis temperature_axis() {
  return {"T", "degC"};
}
/// Returns the axis of curves of boundary conditions: t in s.
inline CurveAxis time_axis() {
  return {"t", "s"};
}

/// Quantity as a function of one number: a property of the temperature (degC), or a boundary value of the
/// time (s). Values are in SI (temperatures in degC); a curve does not convert.
///
/// A curve is immutable and has value semantics; a copy shares its data. Any number of threads may read the
/// same curve. A curve is never extrapolated: reading it outside its range throws. A reading that misses the
/// range by rounding (a field that should be at 20 degC; see `holds`) gets the value at the end of the range.
class Curve {
 public:
  class Function;

  /// Returns a curve with the same value everywhere.
  static Curve constant(double value);

  /// Returns a curve that is linear between the points (abscissae[i], values[i]), defined from the first to
  /// the last abscissa. Throws Error unless there are two points or more, all finite, with strictly ascending
  /// abscissae.
  static Curve table(std::vector<double> abscissae, std::vector<double> values, CurveAxis axis);

  /// Returns a function written in code, called `name` in messages, on a finite range. The function must be
  /// pure: threads call it at the same time. `breaks` are the abscissae of its kinks and jumps, for minimum
  /// and maximum.
  static Curve function(std::string name, std::function<double(double)> function, Interval range,
                        CurveAxis axis, std::vector<double> breaks = {});

  /// Returns a formula in the axis symbol such as "1 - 0.1 * ((T - 20) / 100)^2", in the syntax of Expression
  /// (pyroclast/material/expression.hpp), on a finite range that its author must state. Throws Error with the
  /// position when the formula is wrong.
  static Curve expression(const std::string& formula, Interval range, CurveAxis axis);

  /// Returns the value at x. Throws Error naming the curve, x and the range when x lies outside the range, or
  /// when the value is not finite.
  double operator()(double x) const;

  Interval range() const { return range_; }
  /// Tells whether the curve can be read at x, or throughout an interval; a miss of the range by rounding is
  /// allowed.
  bool holds(double x) const { return range_.holds(x, zero()); }
  bool holds(const Interval& needed) const { return range_.holds(needed, zero()); }

  /// Returns the greatest value on [a, b], which must lie within the range; `minimum` returns the least.
  /// Exact for constants, tables and their multiples; otherwise the extreme over a thousand even steps and
  /// the breaks of the function.
  double maximum(double a, double b) const;
  double minimum(double a, double b) const;
  /// Finds the first fall of the curve on [a, b], in the sense of minimum: two abscissae, the later with the
  /// lower value.
  std::optional<Interval> first_fall(double a, double b) const;

  /// Returns the axis of the curve; empty strings for a constant.
  const CurveAxis& axis() const;
  bool is_constant() const;

  /// Returns the same curve under a name that messages put before its description, e.g. "material mortar:
  /// modulus".
  Curve named(std::string name) const;

  /// Returns the same curve with another text for describe(), e.g. its origin.
  Curve described_as(std::string description) const;

  /// Returns the same curve moved along its axis: the new curve has at x the value of this one at x - by.
  /// Where x - by lies outside the range of this curve, the new one keeps the value at the end, so that the
  /// range grows by |by|.
  Curve shifted(double by) const;

  /// Returns kind and origin.
  const std::string& description() const;
  /// Returns one line for the manifest of a run: kind, origin and range.
  std::string describe() const;

  /// Returns the product of two curves, e.g. a relative curve times a reference value; its range is the
  /// intersection. Throws Error when the curves have different axes or no range in common.
  friend Curve operator*(const Curve& a, const Curve& b);
  friend Curve operator*(const Curve& curve, double factor) { return curve * constant(factor); }
  friend Curve operator*(double factor, const Curve& curve) { return curve * constant(factor); }

 private:
  struct Label;

  Curve(std::shared_ptr<const Function> function, Interval range, std::shared_ptr<const Label> label);

  double zero() const;
  double clamped(double x) const;
  std::string title() const;
  std::vector<double> candidates(double a, double b) const;
  [[noreturn]] void refuse(double x) const;

  std::shared_ptr<const Function> function_;
  Interval range_;
  std::shared_ptr<const Label> label_;
};

}  // namespace pyroclast
