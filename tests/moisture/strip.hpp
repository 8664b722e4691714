#pragma once

#include <utility>
#include <vector>

#include "moisture/pores.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/moisture/moisture.hpp"
#include "thermal/bodies.hpp"

/// Strips of cells along x, whose left and right ends may let water out.
namespace pyroclast {

template <int Dim>
struct MoistBody {
  ModelOf<Dim> model;
  ZoneGeometry<Dim> geometry;
  std::vector<OutlineFace<Dim>> outer;
  Moisture moisture;

  MoistBody(ModelOf<Dim> its_model, const PoreMaterial& pores, const MoistureParameters& parameters = {})
      : model(std::move(its_model)),
        geometry(zone_geometry(model)),
        outer(outline(model, geometry, std::vector<bool>(model.block_count(), true))),
        moisture(moisture_mesh(model, geometry, std::vector<bool>(model.block_count(), true), outer), {pores},
                 parameters) {}

  /// Outer faces in the plane across x.
  std::vector<int> end(double x) const {
    std::vector<int> found;
    const auto is_there = on_plane<Dim>(0, x, 1e-9);
    for (std::size_t f = 0; f < outer.size(); ++f)
      if (is_there(outer[f])) found.push_back(static_cast<int>(f));
    return found;
  }
  std::vector<Vec<3>> centroids() const { return block_centroids(model); }
  std::vector<double> everywhere(double temperature) const {
    return std::vector<double>(moisture.mesh().volume.size(), temperature);
  }
  /// Keeps both ends at a pressure, with steps of 10 days, until flow is steady, and returns the flow out of
  /// the right one, kg/s.
  double steady_flow(double left, double right, double length, const std::vector<double>& temperature) {
    moisture.apply(end(0.0), GivenPressure{Curve::constant(left)});
    for (int i = 0; i < 6; ++i) moisture.advance(1e6, temperature);
    moisture.apply(end(length), GivenPressure{Curve::constant(right)});
    for (int i = 0; i < 12; ++i) moisture.advance(1e6, temperature);
    const double before = moisture.state().ledger.left, stored = moisture.stored();
    moisture.apply(end(0.0), MoistAir{});  // sealed: what leaves for a moment goes through the right end
    moisture.advance(1e-3, temperature);
    EXPECT_NEAR(moisture.stored() / stored, 1.0, 1e-3);
    return (moisture.state().ledger.left - before) / 1e-3;
  }
};

inline MoistBody<2> strip(int cells, double length, const PoreMaterial& pores,
                          const MoistureParameters& parameters = {}) {
  return {plane_body({.blocks = {cells, 1}, .size = {length, 0.01}}), pores, parameters};
}

}  // namespace pyroclast
