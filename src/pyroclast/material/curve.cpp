#include "pyroclast/material/curve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/rounding.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/material/expression.hpp"

namespace pyroclast {
namespace {

/// Number of even steps in which the extremes of a curve that is not piecewise linear are looked for.
constexpr int extreme_steps = 1000;

std::string to_text(const Interval& range, const CurveAxis& axis) {
  return fmt::format("{} to {} {}", range.lower, range.upper, axis.unit);
}

void require_finite_interval(const std::string& name, const Interval& range, const CurveAxis& axis) {
  if (std::isfinite(range.lower) && std::isfinite(range.upper) && range.lower < range.upper) return;
  throw Error(fmt::format("{}: the range {} is not a finite interval with lower < upper", name,
                          to_text(range, axis)));
}

}  // namespace

bool Interval::holds(double x, double zero) const {
  if (contains(x) || !std::isfinite(x)) return contains(x);
  double largest = std::abs(x - zero);
  for (const double end : {lower, upper})
    if (std::isfinite(end)) largest = std::max(largest, std::abs(end - zero));
  return lower - kSameWithin * largest <= x && x <= upper + kSameWithin * largest;
}

/// Function that a curve evaluates; it knows neither range nor name.
class Curve::Function {
 public:
  /// Makes a function whose kinks and jumps lie at `breaks`, in ascending order.
  explicit Function(std::vector<double> breaks) : breaks_(std::move(breaks)) {}
  virtual ~Function() = default;

  virtual double value(double x) const = 0;
  virtual bool is_constant() const { return false; }
  /// Tells whether the extremes between two abscissae lie at them or at breaks.
  virtual bool linear_between_breaks() const { return false; }

  const std::vector<double>& breaks() const { return breaks_; }

 private:
  std::vector<double> breaks_;
};

struct Curve::Label {
  std::string name;  ///< name, may be empty
  std::string description;
  CurveAxis axis;
};

namespace {

class Constant final : public Curve::Function {
 public:
  explicit Constant(double value) : Function({}), value_(value) {}
  double value(double) const override { return value_; }
  bool is_constant() const override { return true; }
  bool linear_between_breaks() const override { return true; }

 private:
  double value_;
};

/// Function that is linear between points; the breaks are their abscissae.
class Table final : public Curve::Function {
 public:
  Table(std::vector<double> abscissae, std::vector<double> values)
      : Function(std::move(abscissae)), values_(std::move(values)) {}

  double value(double x) const override {
    const auto next = std::upper_bound(breaks().begin(), breaks().end(), x);
    if (next == breaks().end()) return values_.back();
    const auto i = static_cast<std::size_t>(next - breaks().begin());
    const double fraction = (x - breaks()[i - 1]) / (breaks()[i] - breaks()[i - 1]);
    return values_[i - 1] + fraction * (values_[i] - values_[i - 1]);
  }
  bool linear_between_breaks() const override { return true; }

 private:
  std::vector<double> values_;
};

/// Function made of any callable, e.g. a built-in or an Expression.
template <class Callable>
class Formula final : public Curve::Function {
 public:
  Formula(Callable callable, std::vector<double> breaks)
      : Function(std::move(breaks)), callable_(std::move(callable)) {}
  double value(double x) const override { return callable_(x); }

 private:
  Callable callable_;
};

class Product final : public Curve::Function {
 public:
  Product(std::shared_ptr<const Function> a, std::shared_ptr<const Function> b)
      : Function(union_of(a->breaks(), b->breaks())), a_(std::move(a)), b_(std::move(b)) {}

  double value(double x) const override { return a_->value(x) * b_->value(x); }
  bool is_constant() const override { return a_->is_constant() && b_->is_constant(); }
  bool linear_between_breaks() const override {
    return (a_->is_constant() && b_->linear_between_breaks()) ||
           (b_->is_constant() && a_->linear_between_breaks());
  }

 private:
  static std::vector<double> union_of(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> all;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
    return all;
  }

  std::shared_ptr<const Function> a_;
  std::shared_ptr<const Function> b_;
};

/// Function moved along its axis; beyond the ends of its range it keeps the values there.
class Shifted final : public Curve::Function {
 public:
  Shifted(std::shared_ptr<const Function> of, Interval range, double by)
      : Function(moved(of->breaks(), range, by)), of_(std::move(of)), range_(range), by_(by) {}

  double value(double x) const override {
    return of_->value(std::clamp(x - by_, range_.lower, range_.upper));
  }
  bool linear_between_breaks() const override { return of_->linear_between_breaks(); }

 private:
  static std::vector<double> moved(std::vector<double> breaks, const Interval& range, double by) {
    breaks.insert(breaks.end(), {range.lower, range.upper});
    sort_unique(breaks);
    for (double& x : breaks) x += by;
    return breaks;
  }

  std::shared_ptr<const Function> of_;
  Interval range_;
  double by_;
};

void require_table(const std::vector<double>& abscissae, const std::vector<double>& values,
                   const CurveAxis& axis) {
  if (abscissae.size() != values.size()) {
    throw Error(fmt::format("a table has {} abscissae {} but {} values", abscissae.size(), axis.symbol,
                            values.size()));
  }
  if (abscissae.size() < 2) {
    throw Error(fmt::format("a table needs at least 2 points, this one has {}", abscissae.size()));
  }
  for (std::size_t i = 0; i < abscissae.size(); ++i) {
    if (!std::isfinite(abscissae[i]) || !std::isfinite(values[i])) {
      throw Error(fmt::format("point {} of a table is ({}, {}); both must be finite", i + 1, abscissae[i],
                              values[i]));
    }
    if (i > 0 && !(abscissae[i - 1] < abscissae[i])) {
      throw Error(fmt::format("point {} of a table has {} = {} {} after {}; {} must ascend strictly", i + 1,
                              axis.symbol, abscissae[i], axis.unit, abscissae[i - 1], axis.symbol));
    }
  }
}

}  // namespace

Curve::Curve(std::shared_ptr<const Function> function, Interval range, std::shared_ptr<const Label> label)
    : function_(std::move(function)), range_(range), label_(std::move(label)) {}

Curve Curve::constant(double value) {
  if (!std::isfinite(value)) throw Error(fmt::format("the constant {} is not a finite number", value));
  return {std::make_shared<Constant>(value), Interval{},
          std::make_shared<Label>(Label{"", fmt::format("{}", value), {}})};
}

Curve Curve::table(std::vector<double> abscissae, std::vector<double> values, CurveAxis axis) {
  require_table(abscissae, values, axis);
  const Interval range{abscissae.front(), abscissae.back()};
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  std::string description =
      fmt::format("table of {} points, values {} to {}", values.size(), *least, *greatest);
  return {std::make_shared<Table>(std::move(abscissae), std::move(values)), range,
          std::make_shared<Label>(Label{"", std::move(description), std::move(axis)})};
}

Curve Curve::function(std::string name, std::function<double(double)> function, Interval range,
                      CurveAxis axis, std::vector<double> breaks) {
  require_finite_interval(name, range, axis);
  std::sort(breaks.begin(), breaks.end());
  return {std::make_shared<Formula<std::function<double(double)>>>(std::move(function), std::move(breaks)),
          range, std::make_shared<Label>(Label{"", std::move(name), std::move(axis)})};
}

Curve Curve::expression(const std::string& formula, Interval range, CurveAxis axis) {
  std::string description = fmt::format("formula \"{}\"", shown_in_short(formula));
  require_finite_interval(description, range, axis);
  return {std::make_shared<Formula<Expression>>(Expression(formula, axis.symbol), std::vector<double>{}),
          range, std::make_shared<Label>(Label{"", std::move(description), std::move(axis)})};
}

double Curve::operator()(double x) const {
  const double value = function_->value(clamped(x));
  if (!std::isfinite(value)) {
    const auto& [symbol, unit] = label_->axis;
    throw Error(fmt::format("{}: no finite value{}", title(),
                            symbol.empty() ? "" : fmt::format(" at {} = {} {}", symbol, x, unit)));
  }
  return value;
}

double Curve::maximum(double a, double b) const {
  double greatest = -std::numeric_limits<double>::infinity();
  for (const double x : candidates(a, b)) greatest = std::max(greatest, (*this)(x));
  return greatest;
}

double Curve::minimum(double a, double b) const {
  double least = std::numeric_limits<double>::infinity();
  for (const double x : candidates(a, b)) least = std::min(least, (*this)(x));
  return least;
}

std::optional<Interval> Curve::first_fall(double a, double b) const {
  std::vector<double> points = candidates(a, b);
  std::ranges::sort(points);
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((*this)(points[i]) < (*this)(points[i - 1])) return Interval{points[i - 1], points[i]};
  return std::nullopt;
}

const CurveAxis& Curve::axis() const {
  return label_->axis;
}
bool Curve::is_constant() const {
  return function_->is_constant();
}

Curve Curve::named(std::string name) const {
  return {function_, range_,
          std::make_shared<Label>(Label{std::move(name), label_->description, label_->axis})};
}

Curve Curve::described_as(std::string description) const {
  return {function_, range_,
          std::make_shared<Label>(Label{label_->name, std::move(description), label_->axis})};
}

Curve Curve::shifted(double by) const {
  if (is_constant() || by == 0.0) return *this;
  const Interval wider{std::min(range_.lower, range_.lower + by), std::max(range_.upper, range_.upper + by)};
  return {std::make_shared<Shifted>(function_, range_, by), wider,
          std::make_shared<Label>(Label{
              label_->name, fmt::format("{}, moved by {:g} K", label_->description, by), label_->axis})};
}

const std::string& Curve::description() const {
  return label_->description;
}

std::string Curve::describe() const {
  if (is_constant()) return label_->description;
  return fmt::format("{}, {} = {}", label_->description, label_->axis.symbol, to_text(range_, label_->axis));
}

Curve operator*(const Curve& a, const Curve& b) {
  const Curve::Label& la = *a.label_;
  const Curve::Label& lb = *b.label_;
  std::string description = fmt::format("({}) * ({})", la.description, lb.description);
  if (!a.is_constant() && !b.is_constant() && la.axis != lb.axis) {
    throw Error(fmt::format("{}: cannot multiply a curve of {} [{}] by one of {} [{}]", description,
                            la.axis.symbol, la.axis.unit, lb.axis.symbol, lb.axis.unit));
  }
  const Interval common{std::max(a.range_.lower, b.range_.lower), std::min(a.range_.upper, b.range_.upper)};
  if (common.lower > common.upper) {
    throw Error(fmt::format("{}: the ranges {} and {} have nothing in common", description,
                            to_text(a.range_, la.axis), to_text(b.range_, lb.axis)));
  }
  // A multiple keeps the name of the curve that it is a multiple of.
  std::string name = a.is_constant() ? lb.name : b.is_constant() ? la.name : "";
  return {std::make_shared<Product>(a.function_, b.function_), common,
          std::make_shared<Curve::Label>(
              Curve::Label{std::move(name), std::move(description), a.is_constant() ? lb.axis : la.axis})};
}

double Curve::clamped(double x) const {
  if (range_.contains(x)) return x;
  if (!holds(x)) refuse(x);
  return std::clamp(x, range_.lower, range_.upper);
}

double Curve::zero() const {
  return axis() == temperature_axis() ? absolute_zero : 0.0;
}

/// Returns the abscissae on [a, b] at which extremes are looked for.
std::vector<double> Curve::candidates(double a, double b) const {
  if (!(a <= b)) {
    throw Error(fmt::format("{}: the interval {} to {} is not in ascending order", title(), a, b));
  }
  a = clamped(a);
  b = clamped(b);
  std::vector<double> points = {a, b};
  for (const double x : function_->breaks()) {
    if (a < x && x < b) points.push_back(x);
  }
  if (!function_->linear_between_breaks()) {
    for (int i = 1; i < extreme_steps; ++i) points.push_back(a + (b - a) * i / extreme_steps);
  }
  return points;
}

/// Returns the name of this curve in messages.
std::string Curve::title() const {
  return label_->name.empty() ? label_->description
                              : fmt::format("{} ({})", label_->name, label_->description);
}

void Curve::refuse(double x) const {
  const CurveAxis& axis = label_->axis;
  throw Error(fmt::format("{}: {} = {} {} lies outside its range of {}; curves are not extrapolated", title(),
                          axis.symbol, x, axis.unit, to_text(range_, axis)));
}

}  // namespace pyroclast
