#pragma once

#include <array>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Returns the determinant of a zone's edge matrix and computes the gradients of the first Dim shape
/// functions times the determinant. The gradient of the last function is minus their sum.
/// \param edge     first Dim corners as seen from the last, m
/// \param vectors  out: gradients times the determinant, m (2D), m² (3D)
template <class Real>
inline Real shape_vectors(const std::array<Vec<2, Real>, 2>& edge, std::array<Vec<2, Real>, 2>& vectors) {
  vectors[0] = {{edge[1][1], -edge[1][0]}};
  vectors[1] = {{-edge[0][1], edge[0][0]}};
  return cross(edge[0], edge[1]);
}

template <class Real>
inline Real shape_vectors(const std::array<Vec<3, Real>, 3>& edge, std::array<Vec<3, Real>, 3>& vectors) {
  vectors[0] = cross(edge[1], edge[2]);
  vectors[1] = cross(edge[2], edge[0]);
  vectors[2] = cross(edge[0], edge[1]);
  return dot(edge[0], vectors[0]);
}

/// Area (2D) or volume (3D) of a zone over its determinant. Edges are taken from the last gridpoint, so the
/// usual orientation gives a negative determinant in 3D.
template <int Dim>
inline constexpr double volume_over_determinant = Dim == 2 ? 0.5 : -1.0 / 6.0;

/// Computes the gradients of the first Dim shape functions of a zone, 1/m.
/// \param x  corners, m
/// \return area (2D, m²) or volume (3D, m³), negative for a zone turned inside out
template <int Dim, class Real>
inline Real shape_gradients(const std::array<Vec<Dim, Real>, Dim + 1>& x,
                            std::array<Vec<Dim, Real>, Dim>& gradient) {
  std::array<Vec<Dim, Real>, Dim> edge;
  for (int n = 0; n < Dim; ++n) edge[n] = x[n] - x[Dim];
  const Real determinant = shape_vectors(edge, gradient);
  for (auto& g : gradient) g *= 1.0 / determinant;
  return determinant * volume_over_determinant<Dim>;
}

}  // namespace pyroclast
