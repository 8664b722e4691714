#include "pyroclast/material/creep.hpp"

#include <cmath>

namespace pyroclast {

namespace {

/// Share of the stress at the end of an exchange in its creep; a half is second order in the increment of
/// temperature.
constexpr double kEnd = 0.5;

/// Number of rounds of Jacobi's rotations; each round more than doubles the digits that are right.
constexpr int kMostRounds = 12;

template <int Dim>
using Matrix = std::array<std::array<double, Dim>, Dim>;

/// Returns the place of the component ij of a symmetric tensor.
template <int Dim>
int place(int i, int j) {
  if (i == j) return i;
  return Dim == 2 ? 2 : (i + j == 1 ? 3 : i + j == 3 ? 4 : 5);
}

template <int Dim>
double trace(const SymmetricTensor<Dim>& t) {
  double sum = t[0];
  for (int i = 1; i < Dim; ++i) sum += t[i];
  return sum;
}

/// Returns a : b.
template <int Dim>
double contraction(const SymmetricTensor<Dim>& a, const SymmetricTensor<Dim>& b) {
  return 2.0 * energy_density<Dim>(a, b);
}

template <int Dim>
SymmetricTensor<Dim> combined(double a, const SymmetricTensor<Dim>& s, double b,
                              const SymmetricTensor<Dim>& t) {
  SymmetricTensor<Dim> sum;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a * s[i] + b * t[i];
  return sum;
}

/// Returns the part of a tensor with positive principal values, by Jacobi's rotations.
template <int Dim>
SymmetricTensor<Dim> positive_part(const SymmetricTensor<Dim>& tensor) {
  Matrix<Dim> a, v{};  // a = (transposed v) tensor v
  for (int i = 0; i < Dim; ++i) {
    v[i][i] = 1.0;
    for (int j = 0; j < Dim; ++j) a[i][j] = tensor[place<Dim>(i, j)];
  }
  for (int round = 0; round < kMostRounds; ++round)
    for (int p = 0; p < Dim; ++p)
      for (int q = p + 1; q < Dim; ++q) {
        if (a[p][q] == 0.0) continue;
        const double slope = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double t = std::copysign(1.0, slope) / (std::abs(slope) + std::sqrt(slope * slope + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        const double shift = t * a[p][q];
        a[p][p] -= shift;
        a[q][q] += shift;
        a[p][q] = a[q][p] = 0.0;
        for (int i = 0; i < Dim; ++i) {
          if (i != p && i != q) {
            const double of_p = a[i][p], of_q = a[i][q];
            a[i][p] = a[p][i] = c * of_p - s * of_q;
            a[i][q] = a[q][i] = s * of_p + c * of_q;
          }
          const double of_p = v[i][p], of_q = v[i][q];
          v[i][p] = c * of_p - s * of_q;
          v[i][q] = s * of_p + c * of_q;
        }
      }
  int positive = 0;
  for (int n = 0; n < Dim; ++n) positive += a[n][n] > 0.0 ? 1 : 0;
  if (positive == Dim) return tensor;
  SymmetricTensor<Dim> part{};
  for (int n = 0; n < Dim; ++n)
    for (int i = 0; i < Dim && a[n][n] > 0.0; ++i)
      for (int j = i; j < Dim; ++j) part[place<Dim>(i, j)] += a[n][n] * v[i][n] * v[j][n];
  return part;
}

}  // namespace

template <int Dim>
SymmetricTensor<Dim> creep_direction(const SymmetricTensor<Dim>& stress, double poisson) {
  SymmetricTensor<Dim> q;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = (1.0 + poisson) * stress[i];
  const double lateral = poisson * trace<Dim>(stress);
  for (int i = 0; i < Dim; ++i) q[i] -= lateral;
  return q;
}

template <int Dim>
CreepSplit<Dim> creep_split(const CreepIncrement& increment, const SymmetricTensor<Dim>& stress) {
  double compliance = increment.compliance;
  if (compliance == 0.0) return {};
  const double square = contraction<Dim>(stress, stress);
  SymmetricTensor<Dim> acting = stress;  // s
  double alike = 1.0;                    // omega: s : sigma over sigma : sigma
  if ((increment.tension != 1.0 || increment.confinement != 0.0) && square > 0.0) {
    const auto tensile = positive_part<Dim>(stress);
    const auto compressive = combined<Dim>(1.0, stress, -1.0, tensile);
    acting = combined<Dim>(1.0, compressive, increment.tension, tensile);
    alike = contraction<Dim>(acting, stress) / square;
    if (const double norm = std::sqrt(contraction<Dim>(compressive, compressive)); norm > 0.0)
      compliance *= 1.0 + (-trace<Dim>(compressive) / norm - 1.0) * increment.confinement;
  }
  const double at_end = kEnd * alike * compliance;
  return {combined<Dim>(compliance, creep_direction<Dim>(acting, increment.poisson), -at_end,
                        creep_direction<Dim>(stress, increment.poisson)),
          at_end};
}

template <int Dim>
ZoneProperties with_compliance(const ZoneProperties& zone, double compliance, double poisson) {
  if (compliance == 0.0) return zone;
  // compliances by modes: half of the one in shear, and the one of the mean strain
  const double shear = 1.0 / (2.0 * zone.mu) + compliance * (1.0 + poisson);
  const double mean = 1.0 / (Dim * zone.lambda + 2.0 * zone.mu) + compliance * (1.0 - (Dim - 1) * poisson);
  const double mu = 0.5 / shear;
  return {(1.0 / mean - 2.0 * mu) / Dim, mu, zone.thermal_strain};
}

template SymmetricTensor<2> creep_direction<2>(const SymmetricTensor<2>&, double);
template SymmetricTensor<3> creep_direction<3>(const SymmetricTensor<3>&, double);
template CreepSplit<2> creep_split<2>(const CreepIncrement&, const SymmetricTensor<2>&);
template CreepSplit<3> creep_split<3>(const CreepIncrement&, const SymmetricTensor<3>&);
template ZoneProperties with_compliance<2>(const ZoneProperties&, double, double);
template ZoneProperties with_compliance<3>(const ZoneProperties&, double, double);

}  // namespace pyroclast
