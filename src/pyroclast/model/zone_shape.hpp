#pragma once

#include <array>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Gradients of the first Dim shape functions of a zone, 1/m; that of the last is minus their sum. They are
/// the rows of the inverse of its edge matrix.
/// \param x  corners, m
/// \return area (2D, m²) or volume (3D, m³), negative for a zone turned inside out
template <class Real>
inline Real shape_gradients(const std::array<Vec<2, Real>, 3>& x, std::array<Vec<2, Real>, 2>& gradient) {
  const Vec<2, Real> e0 = x[0] - x[2];
  const Vec<2, Real> e1 = x[1] - x[2];
  const Real determinant = cross(e0, e1);
  const Real over = 1.0 / determinant;
  gradient[0] = Vec<2, Real>{{e1[1], -e1[0]}} * over;
  gradient[1] = Vec<2, Real>{{-e0[1], e0[0]}} * over;
  return 0.5 * determinant;
}

template <class Real>
inline Real shape_gradients(const std::array<Vec<3, Real>, 4>& x, std::array<Vec<3, Real>, 3>& gradient) {
  const Vec<3, Real> e0 = x[0] - x[3];
  const Vec<3, Real> e1 = x[1] - x[3];
  const Vec<3, Real> e2 = x[2] - x[3];
  const Real determinant = dot(e0, cross(e1, e2));
  const Real over = 1.0 / determinant;
  gradient[0] = cross(e1, e2) * over;
  gradient[1] = cross(e2, e0) * over;
  gradient[2] = cross(e0, e1) * over;
  // Edges are taken from the fourth gridpoint, so the usual orientation gives a negative determinant.
  return determinant * (-1.0 / 6.0);
}

}  // namespace pyroclast
