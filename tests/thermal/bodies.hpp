#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/thermal/conduction.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

/// Bodies of blocks joined by contacts, for the tests of this room.
namespace pyroclast {

template <int Dim>
struct BodyShape {
  std::array<int, Dim> blocks;   ///< along each axis
  std::array<double, Dim> size;  ///< m
  double jitter = 0.0;           ///< random shift of inner vertices, as a fraction of the block
  std::function<int(const Vec<Dim>&)> material{};  ///< of the block at a centre; none: all 0
};

template <int Dim>
class BlockLattice {
 public:
  explicit BlockLattice(const BodyShape<Dim>& shape) : shape_(shape) {
    Random random(7);
    int count = 1;
    for (int n : shape.blocks) count *= n + 1;
    for (int v = 0; v < count; ++v) {
      Vec<Dim> x;
      int rest = v;
      for (int d = 0; d < Dim; ++d) {
        const int n = shape.blocks[d], i = rest % (n + 1);
        rest /= n + 1;
        const double shift = shape.jitter * random.uniform(-1.0, 1.0);
        x[d] = shape.size[d] * (i + (i > 0 && i < n ? shift : 0.0)) / n;
      }
      vertices_.push_back(x);
    }
  }

  /// Corner of a block, bit d of `corner` telling its side along axis d.
  const Vec<Dim>& corner(const std::array<int, Dim>& block, int corner) const {
    int index = 0;
    for (int d = Dim - 1; d >= 0; --d) index = index * (shape_.blocks[d] + 1) + block[d] + (corner >> d & 1);
    return vertices_[index];
  }

  int index(const std::array<int, Dim>& block) const {
    int i = 0;
    for (int d = Dim - 1; d >= 0; --d) i = i * shape_.blocks[d] + block[d];
    return i;
  }

  template <class Visit>
  void for_each_block(Visit visit) const {
    std::array<int, Dim> block{};
    for (int i = 0; i < count(); ++i) {
      int rest = i;
      for (int d = 0; d < Dim; ++d) {
        block[d] = rest % shape_.blocks[d];
        rest /= shape_.blocks[d];
      }
      visit(block);
    }
  }

  int count() const {
    int count = 1;
    for (int n : shape_.blocks) count *= n;
    return count;
  }

  int material(const Vec<Dim>& centre) const { return shape_.material ? shape_.material(centre) : 0; }
  const BodyShape<Dim>& shape() const { return shape_; }

 private:
  BodyShape<Dim> shape_;
  std::vector<Vec<Dim>> vertices_;
};

/// Quadrilateral blocks of four triangles around their centre.
inline ModelOf<2> plane_body(const BodyShape<2>& shape, int materials = 1) {
  const BlockLattice<2> lattice(shape);
  ModelOf<2> model;
  model.interface_names = {"joint"};
  for (int m = 0; m < materials; ++m) model.material_names.push_back("material " + std::to_string(m));
  lattice.for_each_block([&](const std::array<int, 2>& b) {
    std::vector<Vec<2>> x;
    Vec<2> centre{};
    for (int corner : {0, 1, 3, 2}) {  // counter-clockwise
      x.push_back(lattice.corner(b, corner));
      centre += x.back() * 0.25;
    }
    x.push_back(centre);
    model.add_block(x, {{{0, 1, 4}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 0, 4}}}, lattice.material(centre));
  });
  lattice.for_each_block([&](const std::array<int, 2>& b) {
    const int here = model.block_gridpoints[lattice.index(b)];
    if (b[0] + 1 < shape.blocks[0]) {
      const int right = model.block_gridpoints[lattice.index({b[0] + 1, b[1]})];
      model.join_faces({here + 1, here + 2}, {right, right + 3}, 0);
    }
    if (b[1] + 1 < shape.blocks[1]) {
      const int above = model.block_gridpoints[lattice.index({b[0], b[1] + 1})];
      model.join_faces({here + 2, here + 3}, {above + 1, above}, 0);
    }
  });
  return model;
}

/// Hexahedral blocks of six tetrahedra around a diagonal (Kuhn's division, whose faces match).
inline ModelOf<3> solid_body(const BodyShape<3>& shape, int materials = 1) {
  const BlockLattice<3> lattice(shape);
  ModelOf<3> model;
  model.interface_names = {"joint"};
  for (int m = 0; m < materials; ++m) model.material_names.push_back("material " + std::to_string(m));
  const std::vector<std::array<int, 4>> tetrahedra = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                                      {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};
  lattice.for_each_block([&](const std::array<int, 3>& b) {
    std::vector<Vec<3>> x;
    for (int corner = 0; corner < 8; ++corner) x.push_back(lattice.corner(b, corner));
    model.add_block(x, tetrahedra, lattice.material((x[0] + x[7]) * 0.5));
  });
  lattice.for_each_block([&](const std::array<int, 3>& b) {
    for (int d = 0; d < 3; ++d) {
      if (b[d] + 1 == shape.blocks[d]) continue;
      auto neighbour = b;
      ++neighbour[d];
      const int here = model.block_gridpoints[lattice.index(b)];
      const int there = model.block_gridpoints[lattice.index(neighbour)];
      const int side = 1 << d, p = 1 << (d + 1) % 3, q = 1 << (d + 2) % 3;
      model.join_faces({here + side, here + side + p, here + 7}, {there, there + p, there + p + q}, 0);
      model.join_faces({here + side, here + 7, here + side + q}, {there, there + p + q, there + q}, 0);
    }
  });
  return model;
}

/// Node nearest to a place.
template <int Dim>
int node_at(const ModelOf<Dim>& model, const Conduction<Dim>& heat, const Vec<Dim>& x) {
  int nearest = 0;
  for (int node = 1; node < heat.nodes().count(); ++node) {
    const auto distance = [&](int n) { return norm(model.position[heat.nodes().gridpoint[n]] - x); };
    if (distance(node) < distance(nearest)) nearest = node;
  }
  return nearest;
}

inline HeatParameters heat_parameters(const Interval& range, double initial, double largest_change = 10.0,
                                      double largest_step = 1e3) {
  return {.temperature_range = range,
          .initial_temperature = initial,
          .scheme = HeatScheme::super_time_stepping,
          .safety = 0.9,
          .largest_change = largest_change,
          .largest_step = largest_step};
}

inline HeatMaterial constant_material(double conductivity, double heat_capacity) {
  return {Curve::constant(conductivity), Curve::constant(heat_capacity)};
}

/// Concrete of EN 1992-1-2 with a moisture content, %; one of 3 % has a high peak.
inline HeatMaterial moist_concrete(double moisture = 3.0) {
  return {builtin_curves().at("en1992_conductivity_upper").curve,
          en1992_specific_heat(moisture) * builtin_curves().at("en1992_density").curve * 2300.0};
}

inline void expose_to_fire(Conduction<2>& heat, const std::vector<int>& faces) {
  const Curve fire = fire_curves().at("iso834").curve;
  heat.apply(faces, Convection{Curve::constant(25.0), fire});
  heat.apply(faces, Radiation{Curve::constant(0.7), fire});
}

}  // namespace pyroclast
