#pragma once

#include <array>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Returns the determinant of a zone's edge matrix and computes the gradients of the first Dim shape
/// functions times the determinant. The gradient of the last function is minus their sum.
/// \param x        corners, m
/// \param vectors  out: gradients times the determinant, m (2D), m² (3D)
template <class Real>
inline Real shape_vectors(const std::array<Vec<2, Real>, 3>& x, std::array<Vec<2, Real>, 2>& vectors) {
  const Vec<2, Real> e0 = x[0] - x[2];
  const Vec<2, Real> e1 = x[1] - x[2];
  vectors[0] = {{e1[1], -e1[0]}};
  vectors[1] = {{-e0[1], e0[0]}};
  return cross(e0, e1);
}

template <class Real>
inline Real shape_vectors(const std::array<Vec<3, Real>, 4>& x, std::array<Vec<3, Real>, 3>& vectors) {
  const Vec<3, Real> e0 = x[0] - x[3];
  const Vec<3, Real> e1 = x[1] - x[3];
  const Vec<3, Real> e2 = x[2] - x[3];
  vectors[0] = cross(e1, e2);
  vectors[1] = cross(e2, e0);
  vectors[2] = cross(e0, e1);
  return dot(e0, vectors[0]);
}

/// Area (2D) or volume (3D) of a zone over its determinant. Edges are taken from the last gridpoint, so the
/// usual orientation gives a negative determinant in 3D.
template <int Dim>
inline constexpr double volume_over_determinant = Dim == 2 ? 0.5 : -1.0 / 6.0;

/// Computes the gradients of the first Dim shape functions of a zone, 1/m.
/// \return area (2D, m²) or volume (3D, m³), negative for a zone turned inside out
template <int Dim, class Real>
inline Real shape_gradients(const std::array<Vec<Dim, Real>, Dim + 1>& x,
                            std::array<Vec<Dim, Real>, Dim>& gradient) {
  const Real determinant = shape_vectors(x, gradient);
  for (auto& g : gradient) g *= 1.0 / determinant;
  return determinant * volume_over_determinant<Dim>;
}

}  // namespace pyroclast
