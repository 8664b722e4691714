#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pyroclast {

/// Vector of `Dim` components: a position, displacement, velocity or force.
template <int Dim>
struct Vec {
  std::array<double, Dim> c{};

  constexpr double& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
  constexpr double operator[](int i) const { return c[static_cast<std::size_t>(i)]; }

  constexpr Vec& operator+=(const Vec& o) {
    for (int i = 0; i < Dim; ++i) (*this)[i] += o[i];
    return *this;
  }
  constexpr Vec& operator-=(const Vec& o) {
    for (int i = 0; i < Dim; ++i) (*this)[i] -= o[i];
    return *this;
  }
  constexpr Vec& operator*=(double s) {
    for (int i = 0; i < Dim; ++i) (*this)[i] *= s;
    return *this;
  }
  friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
  friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
  friend constexpr Vec operator-(const Vec& a) { return Vec{} - a; }
  friend constexpr Vec operator*(Vec a, double s) { return a *= s; }
  friend constexpr Vec operator*(double s, Vec a) { return a *= s; }
  friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

template <int Dim>
constexpr double dot(const Vec<Dim>& a, const Vec<Dim>& b) {
  double s = 0.0;
  for (int i = 0; i < Dim; ++i) s += a[i] * b[i];
  return s;
}

template <int Dim>
double norm(const Vec<Dim>& a) {
  return std::sqrt(dot(a, a));
}

/// z component of the cross product; twice the signed area of the triangle (0, a, b).
constexpr double cross(const Vec<2>& a, const Vec<2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

constexpr Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace pyroclast
