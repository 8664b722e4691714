#pragma once

#include <map>
#include <memory>
#include <string>

namespace pyroclast {

/// Formula of one variable, given as text and evaluated by the muParser library: numbers with a decimal
/// point, + - * / ^, parentheses, comparisons, && and ||, condition ? a : b, the constants _pi and _e, and
/// the functions sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, acosh, atanh, exp, ln (also
/// log), log2, log10, sqrt, abs, sign, rint, min, max, sum, avg. -2^2 is -4 and 2^3^2 is 2^9.
///
/// Any number of threads may evaluate the same expression at the same time. muParser objects hold scratch
/// memory and cannot be shared, so every thread parses the formula for itself when it first needs it. No
/// value is tabulated; values have the full precision of the formula.
class Expression {
 public:
  /// Parses a formula in which `variable` is the only name. Throws Error with the formula, the character
  /// (from 1) and the fault.
  Expression(std::string formula, std::string variable);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// Returns the value at x; not finite where the formula has no value, e.g. 1/x at 0.
  double operator()(double x) const;

 private:
  struct Evaluators;
  std::unique_ptr<Evaluators> evaluators_;
};

/// Returns the value of a formula in the same syntax that may use several names. Throws Error as Expression
/// does.
double evaluate(const std::string& formula, const std::map<std::string, double>& values);

/// Tells whether a text can be a name in formulas: a letter first, then letters, digits and _.
bool is_name_in_formulas(const std::string& text);

}  // namespace pyroclast
