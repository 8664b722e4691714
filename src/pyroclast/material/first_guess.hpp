#pragma once

#include <optional>
#include <string_view>

#include "pyroclast/material/concrete.hpp"

namespace pyroclast {

/// Contacts within mortar, SI. The numbers belong to contacts, not to the concrete.
struct MortarContacts {
  double f_t, G_f1, f_cm, c_o, G_f2;
  double phi;                         ///< friction angle, rad
  double c_res = 0.0, phi_res = 0.0;  ///< residual ones, of the law `cohesive` alone
};

/// What is known of a concrete before its calibration: a deck of known strength and stiffness, and how both
/// go with the numbers of its mortar.
struct FirstGuess {
  std::string_view source;  ///< where the numbers of the contacts are from
  std::string_view law;     ///< of the contacts
  MortarContacts contacts;
  double mortar_modulus;         ///< E of the mortar, Pa
  double strength;               ///< f_c with these numbers, Pa
  double modulus_over_estimate;  ///< E of a run over the estimate of uniform stress
  double of_stiffness;           ///< exponent with which f_c goes with E of the mortar
  double of_factor;              ///< ... with one factor on all strengths and fracture energies
  double block_size,
      of_block_size;  ///< size of blocks, m, with which f_c was found, and the exponent of f_c with it

  /// Returns f_c, Pa, to some 10 %.
  /// \param modulus  E of the mortar, Pa
  /// \param factor   factor on the strengths and fracture energies of `contacts`
  double strength_with(double modulus, double size, double factor) const;
  /// Returns the factor of a mortar's strengths at 20 °C over those of `contacts`; none where they are of
  /// another mix or law.
  std::optional<double> factor_of(const ContactMaterial& mortar) const;
};

/// Returns what is known of bodies in the plane or in space, whose stones may part where they touch.
const FirstGuess& first_guess(int dimension);

}  // namespace pyroclast
