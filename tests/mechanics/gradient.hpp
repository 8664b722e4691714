#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace pyroclast {

/// Largest difference between the forces on some corners and minus the gradient of an energy, by central
/// differences of fourth order.
/// \param step     of the differences, m
/// \param corners  all where it is empty
template <class Corners, class Forces, class Energy>
double gradient_error(double step, const Corners& x, const Forces& forces, Energy energy,
                      std::vector<int> corners = {}) {
  if (corners.empty()) {
    corners.resize(x.size());
    std::iota(corners.begin(), corners.end(), 0);
  }
  double worst = 0.0;
  for (const int corner : corners)
    for (std::size_t i = 0; i < x[corner].c.size(); ++i) {
      const auto moved = [&](double by) {
        Corners y = x;
        y[corner][i] += by;
        return energy(y);
      };
      const double gradient =
          (8.0 * (moved(step) - moved(-step)) - (moved(2 * step) - moved(-2 * step))) / (12.0 * step);
      worst = std::max(worst, std::abs(forces[corner][i] + gradient));
    }
  return worst;
}

}  // namespace pyroclast
