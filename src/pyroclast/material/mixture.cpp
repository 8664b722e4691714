#include "pyroclast/material/mixture.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

template <int Dim>
Mixture<Dim>::Mixture(const MixedPhase& matrix, std::vector<MixedPhase> inclusions)
    : matrix_(matrix), inclusions_(std::move(inclusions)) {}

template <int Dim>
double Mixture<Dim>::Moduli::young() const {
  return 1.0 / (1.0 / (Dim * Dim * bulk) + (Dim - 1) / (2.0 * Dim * shear));
}

template <int Dim>
auto Mixture<Dim>::moduli_of(const MixedPhase& phase) -> Moduli {
  return {phase.young / (Dim * (1.0 - (Dim - 1) * phase.poisson)), 0.5 * phase.young / (1.0 + phase.poisson)};
}

/// Returns the moduli of the inclusions and a matrix of other moduli, each as if alone in a medium.
template <int Dim>
auto Mixture<Dim>::mixed(const Moduli& matrix, const Moduli& medium) const -> Moduli {
  const auto [bulk, shear] = medium;
  // resistances of the medium around a phase to a change of its size and of its shape
  const double of_size = 2.0 * (Dim - 1) / Dim * shear;
  const double of_shape = shear *
                          (0.5 * Dim * bulk + (Dim + 1) * (Dim - 2) / static_cast<double>(Dim) * shear) /
                          (bulk + 2.0 * shear);
  double size = matrix_.fraction / (matrix.bulk + of_size),
         shape = matrix_.fraction / (matrix.shear + of_shape);
  for (const MixedPhase& inclusion : inclusions_) {
    const Moduli m = moduli_of(inclusion);
    size += inclusion.fraction / (m.bulk + of_size);
    shape += inclusion.fraction / (m.shear + of_shape);
  }
  return {1.0 / size - of_size, 1.0 / shape - of_shape};
}

/// Returns the moduli of the whole, where the medium around each phase is the whole itself.
template <int Dim>
auto Mixture<Dim>::self_consistent(const Moduli& matrix) const -> Moduli {
  constexpr double kNear = 1e-14;
  constexpr int kMost = 10000;
  Moduli whole = mixed(matrix, matrix);
  for (int i = 0; i < kMost; ++i) {
    const Moduli next = mixed(matrix, whole);
    const bool is_there = std::abs(next.bulk - whole.bulk) <= kNear * whole.bulk &&
                          std::abs(next.shear - whole.shear) <= kNear * whole.shear;
    whole = next;
    if (is_there) break;
  }
  return whole;
}

template <int Dim>
double Mixture<Dim>::young() const {
  const Moduli matrix = moduli_of(matrix_);
  return mixed(matrix, matrix).young();
}

template <int Dim>
double Mixture<Dim>::inclusion_weight() const {
  if (inclusions_.size() != 1)
    throw Error(
        fmt::format("a mixture of {} kinds of inclusions has no one weight of them", inclusions_.size()));
  const Moduli matrix = moduli_of(matrix_);
  const double inclusion = moduli_of(inclusions_.front()).bulk;
  if (matrix.bulk == inclusion) return inclusions_.front().fraction;
  const double whole = mixed(matrix, matrix).bulk;
  return (1.0 / whole - 1.0 / matrix.bulk) / (1.0 / inclusion - 1.0 / matrix.bulk);
}

template <int Dim>
double Mixture<Dim>::creep(double of_matrix, double poisson) const {
  const Moduli elastic = moduli_of(matrix_);
  const Moduli crept{1.0 / (1.0 / elastic.bulk + Dim * of_matrix * (1.0 - (Dim - 1) * poisson)),
                     1.0 / (1.0 / elastic.shear + 2.0 * of_matrix * (1.0 + poisson))};
  return 1.0 / self_consistent(crept).young() - 1.0 / self_consistent(elastic).young();
}

template <int Dim>
double Mixture<Dim>::creep_share(double ratio, double poisson) const {
  const double of_matrix = ratio / matrix_.young;
  return creep(of_matrix, poisson) / of_matrix;
}

template class Mixture<2>;
template class Mixture<3>;

}  // namespace pyroclast
