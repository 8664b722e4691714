#pragma once

#include <vector>

namespace pyroclast {

/// A phase of a composite.
struct MixedPhase {
  double fraction = 0.0;  ///< of the volume
  double young = 0.0;     ///< E, Pa; with what lies in series with it, such as contacts
  double poisson = 0.0;   ///< nu
};

/// What a matrix with round inclusions is as a whole: discs in plane stress (2D), spheres (3D).
///
/// Elasticity and free strain by Mori and Tanaka 1973 in the form of Benveniste 1987. Creep by the
/// self-consistent scheme (Hill 1965, Budiansky 1965): inclusions that hardly give way, in a matrix that
/// creeps to many times its elastic strain, bear on one another, which the former does not see.
template <int Dim>
class Mixture {
 public:
  Mixture(const MixedPhase& matrix, std::vector<MixedPhase> inclusions);

  double young() const;  ///< Pa

  /// w of: free strain of the whole = w (that of the inclusions) + (1 - w) (that of the matrix). Levin 1967;
  /// with one kind of inclusions. Throws Error with several.
  double inclusion_weight() const;

  /// What the whole creeps by under a stress along one axis, 1/Pa, when its matrix creeps by `of_matrix`,
  /// 1/Pa, after loading. By the correspondence principle. \param poisson  of the creep, nu_L
  double creep(double of_matrix, double poisson) const;

  /// R: the creep of the whole over that of its matrix, when the latter is `ratio` times what the matrix
  /// gives way by elastically.
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
