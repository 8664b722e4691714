#include "pyroclast/simulation/watching/heated_line.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "pyroclast/simulation/acting/heat_conditions.hpp"

namespace pyroclast {

namespace {

constexpr int kPoints = 121;
/// Names of the sides of a box, by axis, the lower one first.
constexpr std::array<std::array<const char*, 2>, 3> kSides{
    {{"left", "right"}, {"bottom", "top"}, {"front", "back"}}};

struct PlaceBox {
  Vec<3> low, high;
};

/// Returns the box around the specimen, m: a collective.
PlaceBox box_of(const Model& model) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PlaceBox box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (auto [b, last] = model.chunks().own(); b < last; ++b) {
    if (model.is_of_bearing(b)) continue;
    for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g) {
      const Vec<3> at = model.place(g);
      for (int d = 0; d < 3; ++d) {
        box.low[d] = std::min(box.low[d], at[d]);
        box.high[d] = std::max(box.high[d], at[d]);
      }
    }
  }
  for (int d = 0; d < 3; ++d) {
    box.low[d] = model.ranks().least(box.low[d]);
    box.high[d] = model.ranks().largest(box.high[d]);
  }
  return box;
}

}  // namespace

HeatedLine::HeatedLine(const Simulation& simulation, double duration) {
  const Model& model = simulation.model();
  const BoxSide side =
      most_heated_side(model, simulation.materials().block_materials, simulation.heat(), duration);
  const PlaceBox box = box_of(model);
  face_ = kSides[side.axis][side.is_upper ? 1 : 0];
  const double length = box.high[side.axis] - box.low[side.axis];
  std::vector<Vec<3>> points(kPoints, 0.5 * (box.low + box.high));
  for (int i = 0; i < kPoints; ++i) {
    const double depth = length * i / (kPoints - 1);
    points[i][side.axis] = side.is_upper ? box.high[side.axis] - depth : box.low[side.axis] + depth;
  }
  const auto probes = Probe::at(model, points);
  for (int i = 0; i < kPoints; ++i)
    if (probes[i]) {
      depths_.push_back(length * i / (kPoints - 1));
      probes_.push_back(*probes[i]);
    }
  for (std::size_t i = depths_.size(); i-- > 0;) depths_[i] -= depths_.front();
}

std::vector<double> HeatedLine::read(const TemperatureField& field) const {
  return Probe::read_all(probes_, field.gridpoints());
}

}  // namespace pyroclast
