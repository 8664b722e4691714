#pragma once

#include <array>
#include <string>

#include "pyroclast/material/contact_law.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/material/zone_law.hpp"

namespace pyroclast {

/// What a block is made of: the zones' parameters as functions of temperature.
struct SolidMaterial {
  Curve young = Curve::constant(0.0);  ///< E, Pa
  double poisson = 0.0;                ///< nu
  double density = 0.0;                ///< kg/m³, at the reference temperature
};

/// A contact's parameters as functions of temperature (paper, Table 2 and §4.1).
struct ContactMaterial {
  Curve normal_stiffness = Curve::constant(0.0);   ///< K_n, Pa/m
  Curve shear_stiffness = Curve::constant(0.0);    ///< K_s, Pa/m
  Curve tensile_strength = Curve::constant(0.0);   ///< f_t, Pa
  Curve mode_1_energy = Curve::constant(0.0);      ///< G_f1, J/m²
  Curve compressive_limit = Curve::constant(0.0);  ///< f_cm, Pa
  Curve cohesion = Curve::constant(0.0);           ///< c_o, Pa
  Curve residual_cohesion = Curve::constant(0.0);  ///< c_res, Pa
  Curve mode_2_energy = Curve::constant(0.0);      ///< G_f2, J/m²
  double hardening = 0.0;                          ///< beta
  double friction = 0.0, residual_friction = 0.0;  ///< tan(phi), tan(phi_res)
  ContactBehaviour behaviour = ContactBehaviour::cohesive;
  CompressionReading compression = CompressionReading::irreversible;
  bool coupled = false;

  /// Parameters at a temperature, °C. Throws Error when a curve is not defined there.
  ContactProperties at(double temperature) const;

  /// An elastic contact (aggregate-aggregate).
  static ContactMaterial elastic(const Curve& normal_stiffness, const Curve& shear_stiffness);
  /// A contact that was never bonded (platen): start it broken, see Mechanics::break_contact.
  static ContactMaterial unbonded(const Curve& normal_stiffness, const Curve& shear_stiffness, double friction);
  /// This one with stiffness, strengths (f_t, c_o, c_res, f_cm) and fracture energies multiplied (ITZ).
  ContactMaterial scaled(double stiffness, double strength, double fracture_energy) const;
};

/// Everything a concrete specimen is made of; arrays by MaterialIndex and InterfaceIndex of the model.
struct ConcreteMaterials {
  std::array<SolidMaterial, 3> solids;
  std::array<ContactMaterial, 4> contacts;
};

}  // namespace pyroclast
