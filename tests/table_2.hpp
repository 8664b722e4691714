#pragma once

#include <numbers>

#include "pyroclast/laws/cohesive.hpp"

namespace pyroclast {

/// Mortar-mortar contact of the paper's Table 2.
inline Cohesive::Properties<double> mortar_contact() {
  Cohesive::Properties<double> p;
  p.normal_stiffness = 18400e9;
  p.shear_stiffness = 7660e9;
  p.tensile_strength = 2.5e6;
  p.mode_1_energy = 60.0;
  p.compressive_limit = 31e6;
  p.hardening = 0.05;
  p.cohesion = 3.8e6;
  p.residual_cohesion = 0.038e6;
  p.friction_angle = p.residual_friction_angle = 34.0 * std::numbers::pi / 180.0;
  p.mode_2_energy = 240.0;
  return p;
}

}  // namespace pyroclast
