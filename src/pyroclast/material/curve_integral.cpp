#include "pyroclast/material/curve_integral.hpp"

#include <cmath>

namespace pyroclast {
namespace {

constexpr double kRelativeTolerance = 1e-13;
constexpr int kMostHalvings = 40;

struct Quadrature {
  double value;
  double magnitude;  ///< value for the curve's absolute value
};

/// Returns the integral by Gauss-Legendre quadrature with three points.
Quadrature gauss(const Curve& curve, double a, double b) {
  const double middle = 0.5 * (a + b);
  const double offset = 0.5 * (b - a) * std::sqrt(0.6);
  const double left = curve(middle - offset), centre = curve(middle), right = curve(middle + offset);
  const auto sum = [&](double l, double c, double r) {
    return (b - a) * (5.0 * l + 8.0 * c + 5.0 * r) / 18.0;
  };
  return {sum(left, centre, right), sum(std::abs(left), std::abs(centre), std::abs(right))};
}

/// Returns the integral. Halves the interval until the halves agree with the whole: this corners kinks and
/// jumps.
double integral(const Curve& curve, double a, double b, double whole, double tolerance, int halvings) {
  const double middle = 0.5 * (a + b);
  const double left = gauss(curve, a, middle).value;
  const double right = gauss(curve, middle, b).value;
  if (halvings == 0 || std::abs(left + right - whole) <= tolerance) return left + right;
  return integral(curve, a, middle, left, tolerance, halvings - 1) +
         integral(curve, middle, b, right, tolerance, halvings - 1);
}

}  // namespace

double integral(const Curve& curve, double a, double b) {
  const Quadrature whole = gauss(curve, a, b);
  return integral(curve, a, b, whole.value, kRelativeTolerance * whole.magnitude, kMostHalvings);
}

}  // namespace pyroclast
