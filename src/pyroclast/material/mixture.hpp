#pragma once

#include <vector>

namespace pyroclast {

/// A phase of a composite.
struct MixedPhase {
  double fraction = 0.0;  ///< of the volume
  double young = 0.0;     ///< E, Pa; with what lies in series with it, such as contacts
  double poisson = 0.0;   ///< nu
};

/// What a matrix with round inclusions is as a whole, by Mori and Tanaka 1973 in the form of Benveniste 1987:
/// discs in plane stress (2D), spheres (3D).
template <int Dim>
class Mixture {
 public:
  Mixture(const MixedPhase& matrix, std::vector<MixedPhase> inclusions);

  double young() const;  ///< Pa

  /// w of: free strain of the whole = w (that of the inclusions) + (1 - w) (that of the matrix). Levin 1967;
  /// with one kind of inclusions. Throws Error with several.
  double inclusion_weight() const;

  /// R: what the whole gives way by over what the matrix does, both under the same stress along one axis,
  /// when the matrix alone creeps by as much as it gives way elastically. By the correspondence principle;
  /// from a tenth to thirty times as much R differs by less than 3 %.
  /// \param poisson  of the creep, nu_L
  double creep_share(double poisson) const;

 private:
  /// Moduli of area (2D) or volume, and of shear, Pa.
  struct Moduli {
    double bulk, shear;
    double young() const;
  };
  static Moduli moduli_of(const MixedPhase& phase);
  Moduli mixed(const Moduli& matrix) const;

  MixedPhase matrix_;
  std::vector<MixedPhase> inclusions_;
};

extern template class Mixture<2>;
extern template class Mixture<3>;

}  // namespace pyroclast
