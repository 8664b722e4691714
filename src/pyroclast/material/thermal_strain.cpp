#include "pyroclast/material/thermal_strain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/material/curve_integral.hpp"

namespace pyroclast {
namespace {

/// Largest distance of knots, K. Between knots the integral is taken anew at each reading, so a cell is only
/// as wide as three points can see.
constexpr double kWidestCell = 1.0;

/// Integral of a curve from 20 °C, kept at even knots.
class Integral {
 public:
  Integral(const Curve& curve, Interval range) : curve_(curve), lower_(range.lower) {
    const int cells = std::max(1, static_cast<int>(std::ceil((range.upper - range.lower) / kWidestCell)));
    width_ = (range.upper - range.lower) / cells;
    knots_ = {0.0};
    for (int i = 0; i < cells; ++i)
      knots_.push_back(knots_.back() + integral(curve_, knot(i), std::min(knot(i + 1), range.upper)));
    at_reference_ = from_lower(kReferenceTemperature);
  }

  double operator()(double T) const { return from_lower(T) - at_reference_; }

 private:
  double knot(int i) const { return lower_ + i * width_; }

  double from_lower(double T) const {
    const int last = static_cast<int>(knots_.size()) - 2;
    const int cell = std::clamp(static_cast<int>((T - lower_) / width_), 0, last);
    // Rounding may put the temperature a hair below the knot.
    return T > knot(cell) ? knots_[cell] + integral(curve_, knot(cell), T) : knots_[cell];
  }

  Curve curve_;
  double lower_;
  double width_ = 0.0;
  std::vector<double> knots_;  ///< integral from the lower end
  double at_reference_ = 0.0;
};

Interval common(const Interval& a, const Interval& b) {
  return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
}

Curve secant_strain(const Curve& expansion, Interval range) {
  const Curve rise = Curve::table({range.lower, range.upper},
                                  {range.lower - kReferenceTemperature, range.upper - kReferenceTemperature},
                                  temperature_axis());
  return (expansion * rise)
      .described_as(
          fmt::format("alpha(T) (T - {}), alpha {}", kReferenceTemperature, expansion.description()));
}

Curve tangent_strain(const Curve& expansion, Interval range) {
  if (!range.holds(kReferenceTemperature, absolute_zero))
    throw Error(
        fmt::format("{}: the tangent reading integrates from {} degC, which is not between {} and {} degC",
                    expansion.describe(), kReferenceTemperature, range.lower, range.upper));
  const auto strain = std::make_shared<const Integral>(expansion, range);
  return Curve::function(
      fmt::format("integral of alpha from {} degC, alpha {}", kReferenceTemperature, expansion.description()),
      [strain](double T) { return (*strain)(T); }, range, temperature_axis());
}

}  // namespace

Curve free_thermal_strain(const Curve& expansion, ExpansionReading reading, Interval temperatures) {
  const Interval range = common(temperatures, expansion.range());
  if (!(range.lower < range.upper))
    throw Error(fmt::format("{}: is not defined between {} and {} degC", expansion.describe(),
                            temperatures.lower, temperatures.upper));
  return reading == ExpansionReading::secant ? secant_strain(expansion, range)
                                             : tangent_strain(expansion, range);
}

Curve with_quartz_step(const Curve& strain, const QuartzStep& step, Interval temperatures) {
  const double lower = step.over.lower, upper = step.over.upper;
  return Curve::function(
      fmt::format("{}, and {} of quartz from {} to {} degC", strain.description(), step.strain, lower, upper),
      [=](double T) {
        const double way = std::clamp((T - lower) / (upper - lower), 0.0, 1.0);
        return strain(T) + step.strain * way * way * (3.0 - 2.0 * way);
      },
      common(strain.range(), temperatures), temperature_axis(), {lower, upper});
}

}  // namespace pyroclast
