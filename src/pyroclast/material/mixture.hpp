#pragma once

#include <vector>

namespace pyroclast {

/// Phase of a composite.
struct MixedPhase {
  double fraction = 0.0;  ///< fraction of the volume
  double young = 0.0;     ///< E, Pa, including whatever lies in series with the phase, such as contacts
  double poisson = 0.0;   ///< nu
};

/// Properties as a whole of a matrix with round inclusions: discs in plane stress (2D), spheres (3D).
///
/// Elasticity and free strain follow Mori and Tanaka 1973 in the form of Benveniste 1987. Creep follows the
/// self-consistent scheme (Hill 1965, Budiansky 1965): stiff inclusions in a matrix that creeps to many times
/// its elastic strain bear on one another, which the scheme of Mori and Tanaka does not capture.
template <int Dim>
class Mixture {
 public:
  Mixture(const MixedPhase& matrix, std::vector<MixedPhase> inclusions);

  double young() const;  ///< Pa

  /// Returns w of: free strain of the whole = w (free strain of the inclusions) + (1 - w) (free strain of the
  /// matrix). Levin 1967, for one kind of inclusions. Throws Error with several.
  double inclusion_weight() const;

  /// Returns the creep of the whole under a stress along one axis after loading, 1/Pa, by the correspondence
  /// principle.
  /// \param of_matrix  creep of the matrix, 1/Pa
  /// \param poisson    nu_L, Poisson's ratio of the creep
  double creep(double of_matrix, double poisson) const;

  /// Returns R, the creep of the whole over the creep of its matrix, when the matrix has crept by `ratio`
  /// times its elastic strain.
  double creep_share(double ratio, double poisson) const;

 private:
  /// Moduli of area (2D) or volume, and of shear, Pa.
  struct Moduli {
    double bulk, shear;
    double young() const;
  };
  static Moduli moduli_of(const MixedPhase& phase);
  Moduli mixed(const Moduli& matrix, const Moduli& medium) const;
  Moduli self_consistent(const Moduli& matrix) const;

  MixedPhase matrix_;
  std::vector<MixedPhase> inclusions_;
};

extern template class Mixture<2>;
extern template class Mixture<3>;

}  // namespace pyroclast
