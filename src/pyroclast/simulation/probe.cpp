#include "pyroclast/simulation/probe.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {

namespace {

/// Fall of a shape function below zero that is rounding on the zone's edge.
constexpr double kOnEdge = 1e-9;

/// Returns the zone's shape functions at a point: linear, 1/3 each at the centroid.
std::array<double, 3> shape_functions(const Model<2>& model, const ZoneGeometry<2>& geometry,
                                      std::size_t zone, const Vec<2>& x) {
  Vec<2> centroid{};
  for (int g : model.zones[zone]) centroid += (1.0 / 3.0) * model.position[g];
  const auto& gradient = geometry.gradient[zone];
  const double a = 1.0 / 3.0 + dot(gradient[0], x - centroid);
  const double b = 1.0 / 3.0 + dot(gradient[1], x - centroid);
  return {a, b, 1.0 - a - b};
}

}  // namespace

Probe::Probe(const Model<2>& model, const ProbePosition& at) : name_(at.name) {
  const auto geometry = zone_geometry(model);
  const auto blocks = zone_blocks(model);
  // The deepest zone is taken, so that rounding on an edge loses no point.
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t z = 0; z < model.zones.size(); ++z) {
    if (model.is_of_bearing(blocks[z])) continue;
    const auto weights = shape_functions(model, geometry, z, at.position);
    const double depth = *std::min_element(weights.begin(), weights.end());
    if (depth <= deepest) continue;
    deepest = depth;
    gridpoints_ = model.zones[z];
    weights_ = weights;
  }
  if (!(deepest >= -kOnEdge))
    throw Error(fmt::format("no zone of the specimen holds the point ({:g}, {:g}) m of probe {}",
                            at.position[0], at.position[1], at.name));
}

double Probe::read(const std::vector<double>& gridpoints) const {
  double value = 0.0;
  for (std::size_t i = 0; i < 3; ++i) value += weights_[i] * gridpoints[gridpoints_[i]];
  return value;
}

}  // namespace pyroclast
