#pragma once

#include <cmath>
#include <numbers>

namespace pyroclast {

/// Dimensionless temperature of a plane wall that convects on both sides, Carslaw and Jaeger; its half is a
/// wall that convects on one side and is adiabatic on the other. \param place    distance from the middle
/// over the half thickness \param fourier  time times diffusivity over the half thickness squared
inline double convective_wall(double biot, double place, double fourier) {
  using std::numbers::pi;
  double sum = 0.0;
  for (int n = 0; n < 60; ++n) {
    double low = n * pi, high = n * pi + 0.5 * pi;  // root of zeta tan(zeta) = Bi
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (middle * std::tan(middle) < biot ? low : high) = middle;
    }
    const double zeta = 0.5 * (low + high);
    sum += 4.0 * std::sin(zeta) / (2.0 * zeta + std::sin(2.0 * zeta)) * std::exp(-zeta * zeta * fourier) *
           std::cos(zeta * place);
  }
  return sum;
}

}  // namespace pyroclast
