#pragma once

#include <cmath>
#include <numbers>

#include "pyroclast/material/contact_law.hpp"

namespace pyroclast {

/// Mortar-mortar contact of the paper's Table 2.
inline ContactProperties mortar_contact() {
  ContactProperties p;
  p.normal_stiffness = 18400e9;
  p.shear_stiffness = 7660e9;
  p.tensile_strength = 2.5e6;
  p.mode_1_energy = 60.0;
  p.compressive_limit = 31e6;
  p.hardening = 0.05;
  p.cohesion = 3.8e6;
  p.residual_cohesion = 0.038e6;
  p.friction = p.residual_friction = std::tan(34.0 * std::numbers::pi / 180.0);
  p.mode_2_energy = 240.0;
  return p;
}

}  // namespace pyroclast
