#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "loose_blocks.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"

/// Round bodies around the origin that are pressed down on a held plate, as those of Hertz's contacts are.
namespace pyroclast::bodies {

/// Sizes of a round body of facets below its middle.
struct Round {
  double radius, depth;  ///< m
  double facet_angle;    ///< of the facets around the lowest point
  int fine, coarse;      ///< facets from there on: alike, and then longer and longer ones
  int layers;            ///< thinner towards the surface
  double growth = 1.2;   ///< of a coarse facet over the one before

  /// Returns the angles from the lowest point at which facets end, 0 included.
  std::vector<double> angles() const {
    std::vector<double> ends{0.0};
    double step = facet_angle;
    for (int i = 0; i < fine; ++i) ends.push_back((i + 1) * facet_angle);
    for (int i = 0; i < coarse; ++i) ends.push_back(ends.back() + (step *= growth));
    return ends;
  }
  /// Returns the distance of a layer from the middle, m; layer 0 is the surface.
  double at_layer(int j) const { return radius - depth * std::expm1(3.0 * j / layers) / std::expm1(3.0); }
  /// Returns the length of the facets around the lowest point, m.
  double facet() const { return radius * facet_angle; }
};

/// What a plate bears.
struct PressedSpot {
  double force = 0.0;        ///< N
  double mean_square = 0.0;  ///< mean square of the distance from the axis, by the pressure, m²
  double largest = 0.0;      ///< largest pressure, Pa
};

/// Presses a round body on a plate, the last block, lets it come to rest and returns what the plate bears.
/// \param approach  way of the body's innermost layer, m
/// \param move, rest  number of steps
template <int Dim>
PressedSpot press(const ModelOf<Dim>& model, const Round& round, double young, double approach, int move,
                  int rest) {
  constexpr double kTimeStep = 1e-6, kNear = 1e-9;
  const int plate = model.block_count() - 1;
  auto parameters = quasi_static<Dim>(0.7);
  parameters.damping_form = DampingForm::combined;
  parameters.kinematics = Kinematics::finite;
  parameters.time_step = kTimeStep;
  parameters.safety = 0.5;
  parameters.found.is_on = true;
  auto m = mechanics<Dim>(model, rubbing(1e15, 0.0), parameters, young);
  hold(m, plate);
  for (const auto& [velocity, steps] : {std::pair{-approach / (move * kTimeStep), move}, {0.0, rest}}) {
    for (int g = 0; g < model.block_gridpoints[plate]; ++g) {
      const Vec<Dim>& x = model.position[g];
      const bool is_driven = norm(x) < round.radius - round.depth + kNear;
      for (int i = 0; i < Dim; ++i) {
        const bool is_down = i + 1 == Dim;  // planes through the axis are planes of symmetry
        if (is_driven || (!is_down && std::abs(x[i]) < kNear))
          m.constraints().prescribe_velocity(g, i, is_down ? velocity : 0.0);
      }
    }
    m.advance(steps);
  }
  PressedSpot spot;
  for (const FoundPoint& point : found_points(m.body())) {
    const double pressed = -point.normal_traction * point.area;
    spot.force += pressed;
    for (int i = 0; i + 1 < Dim; ++i) spot.mean_square += pressed * point.position[i] * point.position[i];
    spot.largest = std::max(spot.largest, -point.normal_traction);
  }
  spot.mean_square /= spot.force;
  EXPECT_LT(m.totals().unbalanced_ratio(), 1e-3);
  return spot;
}

}  // namespace pyroclast::bodies
