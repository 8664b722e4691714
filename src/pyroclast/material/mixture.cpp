#include "pyroclast/material/mixture.hpp"

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

/// The inclusions in a matrix of other moduli.
template <int Dim>
auto Mixture<Dim>::mixed(const Moduli& matrix) const -> Moduli {
  const auto [bulk, shear] = matrix;
  // of the medium around an inclusion, against a change of its size and of its shape
  const double of_size = 2.0 * (Dim - 1) / Dim * shear;
  const double of_shape = shear *
                          (0.5 * Dim * bulk + (Dim + 1) * (Dim - 2) / static_cast<double>(Dim) * shear) /
                          (bulk + 2.0 * shear);
  double size = matrix_.fraction / (bulk + of_size), shape = matrix_.fraction / (shear + of_shape);
  for (const MixedPhase& inclusion : inclusions_) {
    const Moduli m = moduli_of(inclusion);
    size += inclusion.fraction / (m.bulk + of_size);
    shape += inclusion.fraction / (m.shear + of_shape);
  }
  return {1.0 / size - of_size, 1.0 / shape - of_shape};
}

template <int Dim>
double Mixture<Dim>::young() const {
  return mixed(moduli_of(matrix_)).young();
}

template <int Dim>
double Mixture<Dim>::inclusion_weight() const {
  if (inclusions_.size() != 1)
    throw Error(
        fmt::format("a mixture of {} kinds of inclusions has no one weight of them", inclusions_.size()));
  const double matrix = moduli_of(matrix_).bulk, inclusion = moduli_of(inclusions_.front()).bulk;
  if (matrix == inclusion) return inclusions_.front().fraction;
  const double whole = mixed(moduli_of(matrix_)).bulk;
  return (1.0 / whole - 1.0 / matrix) / (1.0 / inclusion - 1.0 / matrix);
}

template <int Dim>
double Mixture<Dim>::creep_share(double poisson) const {
  const Moduli elastic = moduli_of(matrix_);
  const double creep = 1.0 / matrix_.young;
  const Moduli crept{1.0 / (1.0 / elastic.bulk + Dim * creep * (1.0 - (Dim - 1) * poisson)),
                     1.0 / (1.0 / elastic.shear + 2.0 * creep * (1.0 + poisson))};
  return (1.0 / mixed(crept).young() - 1.0 / mixed(elastic).young()) / creep;
}

template class Mixture<2>;
template class Mixture<3>;

}  // namespace pyroclast
