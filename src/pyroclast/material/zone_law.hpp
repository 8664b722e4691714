#pragma once

#include <array>

#include "pyroclast/base/vec.hpp"

/// The zone law, paper Eq. (5): sigma = D_T (eps - eps_th), isotropic, small strain, total form.
namespace pyroclast {

/// Symmetric tensor: 2D (xx, yy, xy), 3D (xx, yy, zz, xy, yz, zx); shear components are tensor, not engineering.
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

/// Mechanical strain (total minus thermal) of a zone.
///
/// \param gradient  of the first Dim shape functions, 1/m
/// \param u         displacements of the zone's Dim + 1 gridpoints, m
template <int Dim>
inline SymmetricTensor<Dim> mechanical_strain(const std::array<Vec<Dim>, Dim>& gradient,
                                              const std::array<Vec<Dim>, Dim + 1>& u, double thermal_strain) {
  std::array<Vec<Dim>, Dim> h{};  // displacement gradient, h[j][i] = du_i/dx_j
  for (int n = 0; n < Dim; ++n) {
    const Vec<Dim> d = u[n] - u[Dim];
    for (int j = 0; j < Dim; ++j) h[j] += d * gradient[n][j];
  }
  if constexpr (Dim == 2) {
    return {h[0][0] - thermal_strain, h[1][1] - thermal_strain, 0.5 * (h[0][1] + h[1][0])};
  } else {
    return {h[0][0] - thermal_strain,    h[1][1] - thermal_strain,    h[2][2] - thermal_strain,
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
