#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pyroclast/base/lanes.hpp"

namespace pyroclast {

/// Vector of `Dim` components: a position, displacement, velocity or force. `Real` is a double, or Lanes for
/// eight vectors at once.
template <int Dim, class Real = double>
struct Vec {
  std::array<Real, Dim> c{};

  constexpr Real& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
  constexpr const Real& operator[](int i) const { return c[static_cast<std::size_t>(i)]; }

  constexpr Vec& operator+=(const Vec& o) {
    for (int i = 0; i < Dim; ++i) (*this)[i] += o[i];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& o) {
    for (int i = 0; i < Dim; ++i) (*this)[i] -= o[i];
    return *this;
  }
  constexpr Vec& operator*=(const Real& s) {
    for (int i = 0; i < Dim; ++i) (*this)[i] *= s;
    return *this;
  }
  friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
  friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
  friend constexpr Vec operator-(const Vec& a) { return Vec{} - a; }
  friend constexpr Vec operator*(Vec a, const Real& s) { return a *= s; }
  friend constexpr Vec operator*(const Real& s, Vec a) { return a *= s; }
  friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

template <int Dim, class Real>
constexpr Real dot(const Vec<Dim, Real>& a, const Vec<Dim, Real>& b) {
  Real s = a[0] * b[0];
  for (int i = 1; i < Dim; ++i) s += a[i] * b[i];
  return s;
}

template <int Dim, class Real>
Real norm(const Vec<Dim, Real>& a) {
  using std::abs;
  using std::sqrt;
  if constexpr (Dim == 1)
    return abs(a[0]);
  else
    return sqrt(dot(a, a));
}

/// Returns a vector with another number of components: those that it had not are 0, others are left out.
template <int To, int Dim, class Real>
constexpr Vec<To, Real> resized(const Vec<Dim, Real>& a) {
  Vec<To, Real> b;
  for (int i = 0; i < (To < Dim ? To : Dim); ++i) b[i] = a[i];
  return b;
}

/// Returns the z component of the cross product: twice the signed area of the triangle (0, a, b).
template <class Real>
constexpr Real cross(const Vec<2, Real>& a, const Vec<2, Real>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

template <class Real>
constexpr Vec<3, Real> cross(const Vec<3, Real>& a, const Vec<3, Real>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace pyroclast
