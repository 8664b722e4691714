#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "pyroclast/laws/built_in.hpp"
#include "pyroclast/laws/contact_properties.hpp"
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

/// A contact's parameters as functions of temperature (paper, Table 2 and §4.1), of any law.
struct ContactMaterial {
  const LawTable* law = nullptr;
  std::vector<Curve> numbers;  ///< in the order of LawTable::properties
  std::vector<int> choices;    ///< likewise

  /// All zero, with the first option of each choice.
  explicit ContactMaterial(const LawTable& of = table_of<Cohesive>());

  /// The property of that key. Throws Error when the law has none.
  Curve& operator[](std::string_view key);
  const Curve& operator[](std::string_view key) const;
  /// Sets every property of a role.
  void set(Role role, const Curve& curve);
  /// The property of a role, where there is one alone.
  const Curve& of(Role role) const;
  /// With every property of a role multiplied.
  ContactMaterial times(Role role, double factor) const;

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
