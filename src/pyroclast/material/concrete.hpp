#pragma once

#include <array>
#include <optional>

#include "pyroclast/material/contact_law.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/material/zone_law.hpp"

namespace pyroclast {

/// What a block is made of: the zones' parameters as functions of temperature.
struct SolidMaterial {
  Curve young = Curve::constant(0.0);           ///< E, Pa
  double poisson = 0.0;                         ///< nu
  Curve density = Curve::constant(0.0);         ///< kg/m³; mass is that at the reference temperature
  Curve thermal_strain = Curve::constant(0.0);  ///< free strain since the reference temperature
  std::optional<Curve> conductivity;            ///< gamma, W/(m K); only for heat conduction
  std::optional<Curve> specific_heat;           ///< c, J/(kg K); likewise
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
};

/// How the contacts of a concrete follow from its mortar (paper §3.1, physics of contacts A-A, A-M, platen).
struct ContactParameters {
  ContactMaterial mortar;                  ///< M-M; its stiffnesses are filled in by make_contacts
  std::optional<double> normal_stiffness;  ///< K_n of M-M at the reference temperature, Pa/m; else E / t_b
  std::optional<double> shear_stiffness;   ///< K_s, likewise; else G / t_b
  double fracture_zone = 0.0;              ///< t_b, m, Eq. (17)
  std::optional<double>
      fracture_zone_size;  ///< block size at which t_b holds, m; it scales with the size; else fixed
  double interface_stiffness = 0.0;     ///< A-M over M-M: K_n, K_s
  double interface_strength = 0.0;      ///< A-M over M-M: f_t, c, f_cm
  bool scale_interface_energy = false;  ///< G_f of A-M scaled like its strengths
  double platen_friction = 0.0;         ///< tan(phi) between platen and concrete
};

/// Everything a concrete specimen is made of; arrays by MaterialIndex and InterfaceIndex of the model.
struct ConcreteMaterials {
  std::array<SolidMaterial, 3> solids;      ///< aggregate, mortar, platen
  std::array<ContactMaterial, 4> contacts;  ///< A-A, A-M, M-M, platen
  double fracture_zone = 0.0;               ///< t_b as it came out, m
};

/// \param block_size  square root of the mean block area, m
ConcreteMaterials make_concrete(const std::array<SolidMaterial, 3>& solids,
                                const ContactParameters& parameters, double block_size);

}  // namespace pyroclast
