#include "pyroclast/simulation/watching/probe.hpp"

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

/// Tells whether a zone lies wholly on one side of all points.
template <int Dim>
bool is_beside(const ModelOf<Dim>& model, std::size_t zone, const std::vector<Vec<Dim>>& points) {
  for (int axis = 0; axis < Dim; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int g : model.zones[zone]) {
      low = std::min(low, model.position[g][axis]);
      high = std::max(high, model.position[g][axis]);
    }
    const double slack = high - low;  // far more than rounding on an edge
    const auto is_below = [&](const Vec<Dim>& p) { return p[axis] < low - slack; };
    const auto is_above = [&](const Vec<Dim>& p) { return p[axis] > high + slack; };
    if (std::ranges::all_of(points, is_below) || std::ranges::all_of(points, is_above)) return true;
  }
  return false;
}

/// Finds for each point the zone of the specimen in which it lies deepest, so that rounding on an edge loses
/// no point. A zone far from the box of all points is passed over.
template <int Dim>
std::vector<Found> deepest_zones(const ModelOf<Dim>& model, const std::vector<Vec<Dim>>& points) {
  const auto geometry = zone_geometry(model);
  const auto blocks = zone_blocks(model);
  std::vector<Found> deepest(points.size());
  for (std::size_t z = 0; z < model.zones.size(); ++z) {
    if (model.is_of_bearing(blocks[z]) || is_beside(model, z, points)) continue;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto weights = shape_functions(model, geometry, z, points[i]);
      const double depth = *std::min_element(weights.begin(), weights.end());
      if (depth <= deepest[i].depth) continue;
      deepest[i] = {depth, {model.zones[z].begin(), model.zones[z].end()}, {weights.begin(), weights.end()}};
    }
  }
  return deepest;
}

/// Finds the zones of points in a body of either space.
std::vector<Found> deepest_zones(const Model& model, const std::vector<Vec<3>>& points) {
  return with_dimension(model, [&]<int Dim>(const ModelOf<Dim>& of_dimension) {
    std::vector<Vec<Dim>> own;
    for (const Vec<3>& point : points) own.push_back(resized<Dim>(point));
    return deepest_zones<Dim>(of_dimension, own);
  });
}

}  // namespace

Probe::Probe(const Model& model, const ProbePosition& at) {
  auto found = Probe::at(model, {at.position}).front();
  if (!found)
    throw Error(fmt::format("no zone of the specimen holds the point {} m of probe {}",
                            place_text(at.position, model.dimension(), "{:g}"), at.name));
  *this = *std::move(found);
  name_ = at.name;
}

std::vector<std::optional<Probe>> Probe::at(const Model& model, const std::vector<Vec<3>>& points) {
  std::vector<Found> deepest = deepest_zones(model, points);
  std::vector<double> depths;
  for (const Found& found : deepest) depths.push_back(found.depth);
  const std::vector<double> of_ranks = model.ranks().collect(depths);
  std::vector<std::optional<Probe>> probes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    int rank = 0;  // the first of equals, as in the whole
    const auto depth_on = [&](int r) { return of_ranks[static_cast<std::size_t>(r) * points.size() + i]; };
    for (int r = 1; r < model.ranks().count(); ++r)
      if (depth_on(r) > depth_on(rank)) rank = r;
    if (!(depth_on(rank) >= -kOnEdge)) continue;
    Probe probe;
    probe.gridpoints_ = std::move(deepest[i].gridpoints);
    probe.weights_ = std::move(deepest[i].weights);
    probe.ranks_ = &model.ranks();
    probe.rank_ = rank;
    probes[i] = std::move(probe);
  }
  return probes;
}

double Probe::read(const std::vector<double>& gridpoints) const {
  double value = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) value += weights_[i] * gridpoints[gridpoints_[i]];
  return ranks_->of(rank_, value);
}

std::vector<double> Probe::read_all(const std::vector<Probe>& probes, const std::vector<double>& gridpoints) {
  const auto read = [&] {
    std::vector<double> values;
    for (const Probe& probe : probes) values.push_back(probe.read(gridpoints));
    return values;
  };
  return probes.empty() ? read() : probes.front().ranks_->together(read);
}

}  // namespace pyroclast
