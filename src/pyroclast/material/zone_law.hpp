#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "pyroclast/base/vec.hpp"

/// The zone law, paper Eq. (5): sigma = D_T (eps - eps_th), isotropic, small strain, total form.
namespace pyroclast {

/// What displacements do to the geometry.
enum class Kinematics : std::uint8_t {
  small,  ///< zones and contact frames keep their first orientation; exact while rotations and jumps are
          ///< small
  finite  ///< zones strain in a frame that turns with them and contact frames turn with their faces (2D only)
};

/// Symmetric tensor: 2D (xx, yy, xy), 3D (xx, yy, zz, xy, yz, zx); shear components are tensor, not
/// engineering.
template <int Dim>
using SymmetricTensor = std::array<double, Dim*(Dim + 1) / 2>;

/// Elastic constants of a zone at its temperature.
struct ZoneProperties {
  double lambda = 0.0;          ///< first Lamé constant; in 2D the plane stress one, E nu / (1 - nu²), Pa
  double mu = 0.0;              ///< shear modulus G, Pa
  double thermal_strain = 0.0;  ///< free thermal strain in every direction
};

/// 2D: true plane stress. `young` in Pa.
template <int Dim>
constexpr ZoneProperties zone_properties(double young, double poisson, double thermal_strain = 0.0) {
  const double denominator = Dim == 2 ? 1.0 - poisson * poisson : (1.0 + poisson) * (1.0 - 2.0 * poisson);
  return {young * poisson / denominator, 0.5 * young / (1.0 + poisson), thermal_strain};
}

/// Turn of a zone in its plane; the identity with small kinematics.
struct Rotation {
  double cosine = 1.0, sine = 0.0;
};

/// A vector of the zone's own frame in the frame of the model.
template <int Dim>
inline Vec<Dim> rotated(const Rotation& r, const Vec<Dim>& v) {
  if constexpr (Dim == 2)
    return {{r.cosine * v[0] - r.sine * v[1], r.sine * v[0] + r.cosine * v[1]}};
  else
    return v;
}

/// A stress of the zone's own frame in the frame of the model.
template <int Dim>
inline SymmetricTensor<Dim> rotated(const Rotation& r, const SymmetricTensor<Dim>& s) {
  if constexpr (Dim == 2) {
    const double cc = r.cosine * r.cosine, ss = r.sine * r.sine, cs = r.cosine * r.sine;
    return {cc * s[0] + ss * s[1] - 2.0 * cs * s[2], ss * s[0] + cc * s[1] + 2.0 * cs * s[2],
            cs * (s[0] - s[1]) + (cc - ss) * s[2]};
  } else {
    return s;
  }
}

/// Mechanical strain (total minus thermal) of a zone, in the zone's own frame.
///
/// Finite kinematics take the rotation R out of the deformation gradient F = R U (polar decomposition) and
/// return U - I, so that a zone may turn freely; small kinematics take the symmetric part of F - I.
///
/// \param gradient  of the first Dim shape functions, 1/m
/// \param u         displacements of the zone's Dim + 1 gridpoints, m
/// \param rotation  out
template <int Dim>
inline SymmetricTensor<Dim> mechanical_strain(const std::array<Vec<Dim>, Dim>& gradient,
                                              const std::array<Vec<Dim>, Dim + 1>& u, double thermal_strain,
                                              Kinematics kinematics, Rotation& rotation) {
  std::array<Vec<Dim>, Dim> h{};  // displacement gradient, h[j][i] = du_i/dx_j
  for (int n = 0; n < Dim; ++n) {
    const Vec<Dim> d = u[n] - u[Dim];
    for (int j = 0; j < Dim; ++j) h[j] += d * gradient[n][j];
  }
  if constexpr (Dim == 2) {
    if (kinematics == Kinematics::finite) {
      const double along = 2.0 + h[0][0] + h[1][1];
      const double across = h[0][1] - h[1][0];
      const double scale = 1.0 / std::sqrt(along * along + across * across);
      const double c = along * scale, s = across * scale;
      rotation = {c, s};
      return {c * (1.0 + h[0][0]) + s * h[0][1] - 1.0 - thermal_strain,
              c * (1.0 + h[1][1]) - s * h[1][0] - 1.0 - thermal_strain, c * h[1][0] + s * (1.0 + h[1][1])};
    }
    return {h[0][0] - thermal_strain, h[1][1] - thermal_strain, 0.5 * (h[0][1] + h[1][0])};
  } else {
    return {h[0][0] - thermal_strain,  h[1][1] - thermal_strain,  h[2][2] - thermal_strain,
            0.5 * (h[0][1] + h[1][0]), 0.5 * (h[1][2] + h[2][1]), 0.5 * (h[2][0] + h[0][2])};
  }
}

/// Stress, Pa, tension positive, from the mechanical strain.
template <int Dim>
inline SymmetricTensor<Dim> zone_stress(const ZoneProperties& p, const SymmetricTensor<Dim>& strain) {
  double trace = 0.0;
  for (int i = 0; i < Dim; ++i) trace += strain[i];
  SymmetricTensor<Dim> stress;
  for (std::size_t i = 0; i < stress.size(); ++i) stress[i] = 2.0 * p.mu * strain[i];
  for (int i = 0; i < Dim; ++i) stress[i] += p.lambda * trace;
  return stress;
}

/// Stress applied to a vector: the traction on a plane with that normal.
template <int Dim>
inline Vec<Dim> apply(const SymmetricTensor<Dim>& s, const Vec<Dim>& n) {
  if constexpr (Dim == 2) {
    return {{s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]}};
  } else {
    return {{s[0] * n[0] + s[3] * n[1] + s[5] * n[2], s[3] * n[0] + s[1] * n[1] + s[4] * n[2],
             s[5] * n[0] + s[4] * n[1] + s[2] * n[2]}};
  }
}

/// Elastic energy density of a strain under its stress, J/m³.
template <int Dim>
inline double energy_density(const SymmetricTensor<Dim>& stress, const SymmetricTensor<Dim>& strain) {
  double w = 0.0;
  for (int i = 0; i < Dim; ++i) w += 0.5 * stress[i] * strain[i];
  for (std::size_t i = Dim; i < stress.size(); ++i) w += stress[i] * strain[i];
  return w;
}

}  // namespace pyroclast
