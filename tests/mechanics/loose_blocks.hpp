#pragma once

#include <cmath>
#include <vector>

#include "bodies.hpp"

/// Blocks that are not joined, as the tests of found contacts have them.
namespace pyroclast::bodies {

inline constexpr double kGravity = 9.81;

inline std::vector<Vec<2>> rectangle(double x, double y, double width, double height, double angle = 0.0,
                                     const Vec<2>& about = {}) {
  std::vector<Vec<2>> corners{{{x, y}}, {{x + width, y}}, {{x + width, y + height}}, {{x, y + height}}};
  for (auto& corner : corners) corner = turned(corner - about, angle) + about;
  return corners;
}

inline int add_block(ModelOf<2>& model, const std::vector<Vec<2>>& corners) {
  const auto zoned = specimen::zone_block(corners);
  return model.add_block(zoned.gridpoints, zoned.zones, 0);
}

/// Rotation about an axis by the angle that is the axis' length.
inline Vec<3> turned(const Vec<3>& x, const Vec<3>& by) {
  const double angle = norm(by);
  if (angle == 0.0) return x;
  const Vec<3> k = by * (1.0 / angle);
  return x * std::cos(angle) + cross(k, x) * std::sin(angle) + k * (dot(k, x) * (1.0 - std::cos(angle)));
}

/// Adds a box around a place, cut into tetrahedra around its middle. Returns the block.
inline int add_box(ModelOf<3>& model, const Vec<3>& size, const Vec<3>& place,
                   const std::vector<Vec<3>>& turns) {
  ModelOf<3> one = cubes(1, 1.0);
  for (Vec<3>& x : one.position) {
    for (int i = 0; i < 3; ++i) x[i] = (x[i] - 0.5) * size[i];
    for (const Vec<3>& turn : turns) x = turned(x, turn);
    x += place;
  }
  return model.add_block(one.position, one.zones, 0);
}

template <int Dim = 2>
ModelOf<Dim> empty_model() {
  ModelOf<Dim> model;
  model.material_names = {"mortar"};
  model.interface_names = {"mortar-mortar"};
  return model;
}

/// Parameters of blocks that fly: real mass, no damping.
template <int Dim = 2>
MechanicsParameters flying(double gravity, double safety) {
  MechanicsParameters p;
  p.gravity[Dim - 1] = -gravity;
  p.kinematics = Kinematics::finite;
  p.safety = safety;
  p.found.is_on = true;
  p.zones_for_a_thread = 1;
  return p;
}

inline Frictional::Properties<double> rubbing(double stiffness, double friction) {
  return {stiffness, 0.4 * stiffness, friction};
}

template <int Dim>
void hold(Mechanics<Dim>& m, int block) {
  for (int g = m.model().block_gridpoints[block]; g < m.model().block_gridpoints[block + 1]; ++g)
    for (int i = 0; i < Dim; ++i) m.constraints().prescribe_velocity(g, i, 0.0);
}

template <int Dim>
Vec<Dim> velocity_of_block(const Mechanics<Dim>& m, int block) {
  Vec<Dim> momentum{};
  double mass = 0.0;
  for (int g = m.model().block_gridpoints[block]; g < m.model().block_gridpoints[block + 1]; ++g) {
    momentum += m.read().velocity(g) * m.body().mass[g];
    mass += m.body().mass[g];
  }
  return momentum * (1.0 / mass);
}

inline double lowest(const Mechanics<2>& m, int block) {
  double y = 1e9;
  for (int g = m.model().block_gridpoints[block]; g < m.model().block_gridpoints[block + 1]; ++g)
    y = std::min(y, m.model().position[g][1] + m.read().displacement(g)[1]);
  return y;
}

/// Two rows of square blocks, joined.
inline ModelOf<2> two_rows(int blocks, double size) {
  return lattice(blocks, 2, [=](double x, double y) { return Vec<2>{{x * blocks * size, y * 2 * size}}; });
}

}  // namespace pyroclast::bodies
