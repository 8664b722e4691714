#include "pyroclast/simulation/probe.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_text.hpp"

namespace pyroclast {

namespace {

/// Fall of a shape function below zero that is rounding on the zone's edge.
constexpr double kOnEdge = 1e-9;

/// Returns the zone's shape functions at a point: linear, and equal at the centroid.
template <int Dim>
std::array<double, Dim + 1> shape_functions(const ModelOf<Dim>& model, const ZoneGeometry<Dim>& geometry,
                                            std::size_t zone, const Vec<Dim>& x) {
  constexpr double at_centroid = 1.0 / (Dim + 1);
  Vec<Dim> centroid{};
  for (int g : model.zones[zone]) centroid += at_centroid * model.position[g];
  std::array<double, Dim + 1> weights;
  weights[Dim] = 1.0;
  for (std::size_t i = 0; i < Dim; ++i) {
    weights[i] = at_centroid + dot(geometry.gradient[zone][i], x - centroid);
    weights[Dim] -= weights[i];
  }
  return weights;
}

/// Zone that holds a point.
struct Found {
  double depth = -std::numeric_limits<double>::infinity();  ///< least shape function
  std::vector<int> gridpoints;
  std::vector<double> weights;
};

/// Finds the zone of the specimen in which a point lies deepest, so that rounding on an edge loses no point.
template <int Dim>
Found deepest_zone(const ModelOf<Dim>& model, const Vec<Dim>& point) {
  const auto geometry = zone_geometry(model);
  const auto blocks = zone_blocks(model);
  Found deepest;
  for (std::size_t z = 0; z < model.zones.size(); ++z) {
    if (model.is_of_bearing(blocks[z])) continue;
    const auto weights = shape_functions(model, geometry, z, point);
    const double depth = *std::min_element(weights.begin(), weights.end());
    if (depth <= deepest.depth) continue;
    deepest = {depth, {model.zones[z].begin(), model.zones[z].end()}, {weights.begin(), weights.end()}};
  }
  return deepest;
}

}  // namespace

Probe::Probe(const Model& model, const ProbePosition& at) : name_(at.name) {
  Found found = with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    return deepest_zone(of_dimension, resized<Dim>(at.position));
  });
  if (!(found.depth >= -kOnEdge))
    throw Error(fmt::format("no zone of the specimen holds the point {} m of probe {}",
                            place_text(at.position, model.dimension(), "{:g}"), at.name));
  gridpoints_ = std::move(found.gridpoints);
  weights_ = std::move(found.weights);
}

double Probe::read(const std::vector<double>& gridpoints) const {
  double value = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) value += weights_[i] * gridpoints[gridpoints_[i]];
  return value;
}

}  // namespace pyroclast
