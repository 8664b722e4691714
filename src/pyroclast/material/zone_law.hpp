#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "pyroclast/base/vec.hpp"

/// Zone law, paper Eq. (5): sigma = D_T (eps - eps_th), isotropic, small strain, total form.
namespace pyroclast {

/// Effect of displacements on the geometry.
enum class Kinematics : std::uint8_t {
  small,  ///< zones and contact frames keep their first orientation; exact for small rotations and jumps
  finite  ///< zones strain in a frame that turns with them, and contact frames turn with their faces
};

/// Symmetric tensor: 2D (xx, yy, xy), 3D (xx, yy, zz, xy, yz, zx); shear components are tensor, not
/// engineering.
template <int Dim, class Real = double>
using SymmetricTensor = std::array<Real, Dim*(Dim + 1) / 2>;

/// Returns a tensor in space: one of the plane gets a component across it.
inline SymmetricTensor<3> in_space(const SymmetricTensor<2>& t, double across = 0.0) {
  return {t[0], t[1], across, t[2], 0.0, 0.0};
}
inline SymmetricTensor<3> in_space(const SymmetricTensor<3>& t) {
  return t;
}

/// Elastic constants of a zone at its temperature.
template <class Real>
struct ZonePropertiesOf {
  Real lambda{};          ///< first Lamé constant; in 2D the plane stress one, E nu / (1 - nu²), Pa
  Real mu{};              ///< shear modulus G, Pa
  Real thermal_strain{};  ///< free thermal strain in every direction
};
using ZoneProperties = ZonePropertiesOf<double>;

/// Returns the elastic constants from `young`, Pa, and Poisson's ratio; in 2D for true plane stress.
template <int Dim>
constexpr ZoneProperties zone_properties(double young, double poisson, double thermal_strain = 0.0) {
  const double denominator = Dim == 2 ? 1.0 - poisson * poisson : (1.0 + poisson) * (1.0 - 2.0 * poisson);
  return {young * poisson / denominator, 0.5 * young / (1.0 + poisson), thermal_strain};
}

/// Matrix in space, column by column.
template <class Real = double>
using Matrix3 = std::array<Vec<3, Real>, 3>;

/// Turn of a zone; the identity with small kinematics.
template <int Dim, class Real = double>
struct Rotation;

template <class Real>
struct Rotation<2, Real> {
  Real cosine{1.0}, sine{0.0};
};

template <class Real>
struct Rotation<3, Real> {
  /// Directions of the axes of the zone's own frame: the columns of R.
  Matrix3<Real> axis{{{{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}, {{0.0, 0.0, 1.0}}}};
};

/// Turns a vector of the zone's own frame into the frame of the model.
template <int Dim, class Real>
inline Vec<Dim, Real> rotated(const Rotation<Dim, Real>& r, const Vec<Dim, Real>& v) {
  if constexpr (Dim == 2)
    return {{r.cosine * v[0] - r.sine * v[1], r.sine * v[0] + r.cosine * v[1]}};
  else
    return r.axis[0] * v[0] + r.axis[1] * v[1] + r.axis[2] * v[2];
}

/// Turns a stress of the zone's own frame into the frame of the model.
template <int Dim, class Real>
inline SymmetricTensor<Dim, Real> rotated(const Rotation<Dim, Real>& r, const SymmetricTensor<Dim, Real>& s) {
  if constexpr (Dim == 2) {
    const Real cc = r.cosine * r.cosine, ss = r.sine * r.sine, cs = r.cosine * r.sine;
    return {cc * s[0] + ss * s[1] - 2.0 * cs * s[2], ss * s[0] + cc * s[1] + 2.0 * cs * s[2],
            cs * (s[0] - s[1]) + (cc - ss) * s[2]};
  } else {
    // R s, whose rows go along R once more
    const Matrix3<Real> columns{rotated<3>(r, Vec<3, Real>{{s[0], s[3], s[5]}}),
                                rotated<3>(r, Vec<3, Real>{{s[3], s[1], s[4]}}),
                                rotated<3>(r, Vec<3, Real>{{s[5], s[4], s[2]}})};
    const auto component = [&](int i, int j) {
      return columns[0][i] * r.axis[0][j] + columns[1][i] * r.axis[1][j] + columns[2][i] * r.axis[2][j];
    };
    return {component(0, 0), component(1, 1), component(2, 2),
            component(0, 1), component(1, 2), component(2, 0)};
  }
}

/// Steps to the rotation of a zone in space: to round-off up to strains of 0.1, to 1e-8 up to 0.3.
inline constexpr int kStepsToRotation = 4;

/// Returns the columns of R of F = R U from those of F, by Newton's steps R <- (R + R^-T) / 2 (Higham 1986).
/// The columns of R^-T are cross products of the columns of R over its determinant, so no step branches.
template <class Real>
inline Matrix3<Real> rotation_of(const Matrix3<Real>& gradient) {
  Matrix3<Real> r = gradient;  // 2^step R: no step divides by 2
  double power = 1.0;          // 4^step
  for (int step = 0; step < kStepsToRotation; ++step) {
    const Matrix3<Real> cofactors{cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])};
    const Real over = Real(power) / dot(r[0], cofactors[0]);
    for (int j = 0; j < 3; ++j) r[j] += cofactors[j] * over;
    power *= 4.0;
  }
  for (auto& column : r) column *= Real(1.0 / (1 << kStepsToRotation));
  return r;
}

template <class Set>
inline Matrix3<Lanes<Set>> rotation_of(const Matrix3<Lanes<Set>>& gradient) {
  Matrix3<Lanes<Set>> r;
  unroll<Lanes<Set>::kParts>([&](auto part) {
    Matrix3<PartOfLanes<Set>> of_part;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) of_part[j][i] = PartOfLanes<Set>::of(gradient[j][i].part[part]);
    of_part = rotation_of(of_part);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) r[j][i].part[part] = of_part[j][i].value;
  });
  return r;
}

/// Returns the mechanical strain (total minus thermal) of a zone, in the zone's own frame.
///
/// Finite kinematics take the rotation R out of the deformation gradient F = R U (polar decomposition) and
/// return U - I, so that a zone may turn freely; small kinematics take the symmetric part of F - I.
///
/// \param vectors   gradients of the first Dim shape functions, 1/m, once multiplied by `scale`
/// \param u         displacements of the first Dim gridpoints as seen from the last, m
/// \param rotation  out: turn of the zone
template <int Dim, class Real>
inline SymmetricTensor<Dim, Real> mechanical_strain(const std::array<Vec<Dim, Real>, Dim>& vectors,
                                                    const Real& scale,
                                                    const std::array<Vec<Dim, Real>, Dim>& u,
                                                    const Real& thermal_strain, Kinematics kinematics,
                                                    Rotation<Dim, Real>& rotation) {
  using std::sqrt;
  std::array<Vec<Dim, Real>, Dim> h;  // displacement gradient, h[j][i] = du_i/dx_j
  for (int n = 0; n < Dim; ++n)
    for (int j = 0; j < Dim; ++j) h[j] = n == 0 ? u[n] * vectors[n][j] : h[j] + u[n] * vectors[n][j];
  if constexpr (Dim == 2) {
    for (auto& column : h) column *= scale;
    if (kinematics == Kinematics::finite) {
      const Real along = 2.0 + h[0][0] + h[1][1];
      const Real across = h[0][1] - h[1][0];
      const Real over = 1.0 / sqrt(along * along + across * across);
      const Real c = along * over, s = across * over;
      rotation = {c, s};
      return {c * (1.0 + h[0][0]) + s * h[0][1] - 1.0 - thermal_strain,
              c * (1.0 + h[1][1]) - s * h[1][0] - 1.0 - thermal_strain, c * h[1][0] + s * (1.0 + h[1][1])};
    }
    return {h[0][0] - thermal_strain, h[1][1] - thermal_strain, 0.5 * (h[0][1] + h[1][0])};
  } else {
    if (kinematics == Kinematics::finite) {
      for (int j = 0; j < 3; ++j) {
        h[j] *= scale;
        h[j][j] += 1.0;
      }
      rotation.axis = rotation_of(h);
      const auto& r = rotation.axis;
      const auto direct = [&](int i) { return dot(r[i], h[i]) - 1.0 - thermal_strain; };
      const auto shear = [&](int i, int j) { return dot(r[i], h[j]); };  // R^T F is symmetric
      return {direct(0), direct(1), direct(2), shear(0, 1), shear(1, 2), shear(2, 0)};
    }
    const Real half = 0.5 * scale;
    return {h[0][0] * scale - thermal_strain, h[1][1] * scale - thermal_strain,
            h[2][2] * scale - thermal_strain, (h[0][1] + h[1][0]) * half,
            (h[1][2] + h[2][1]) * half,       (h[2][0] + h[0][2]) * half};
  }
}

/// Returns the stress, Pa, tension positive, from the mechanical strain.
template <int Dim, class Real>
inline SymmetricTensor<Dim, Real> zone_stress(const ZonePropertiesOf<Real>& p,
                                              const SymmetricTensor<Dim, Real>& strain) {
  Real trace = strain[0];
  for (int i = 1; i < Dim; ++i) trace += strain[i];
  const Real of_trace = p.lambda * trace;
  const Real of_strain = 2.0 * p.mu;
  SymmetricTensor<Dim, Real> stress;
  for (int i = 0; i < Dim; ++i) stress[i] = of_strain * strain[i] + of_trace;
  for (std::size_t i = Dim; i < stress.size(); ++i) stress[i] = of_strain * strain[i];
  return stress;
}

/// Applies a stress to a vector, which gives the traction on a plane with that normal.
template <int Dim, class Real>
inline Vec<Dim, Real> apply(const SymmetricTensor<Dim, Real>& s, const Vec<Dim, Real>& n) {
  if constexpr (Dim == 2) {
    return {{s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]}};
  } else {
    return {{s[0] * n[0] + s[3] * n[1] + s[5] * n[2], s[3] * n[0] + s[1] * n[1] + s[4] * n[2],
             s[5] * n[0] + s[4] * n[1] + s[2] * n[2]}};
  }
}

/// Returns the elastic energy density of a strain under its stress, J/m³.
template <int Dim, class Real>
inline Real energy_density(const SymmetricTensor<Dim, Real>& stress,
                           const SymmetricTensor<Dim, Real>& strain) {
  Real w = 0.5 * stress[0] * strain[0];
  for (int i = 1; i < Dim; ++i) w += 0.5 * stress[i] * strain[i];
  for (std::size_t i = Dim; i < stress.size(); ++i) w += stress[i] * strain[i];
  return w;
}

}  // namespace pyroclast
