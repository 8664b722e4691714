#pragma once

#include <numbers>

#include "pyroclast/laws/cohesive.hpp"
#include "pyroclast/laws/mixed_mode.hpp"

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

/// The same with one damage for tension and shear, and a dilatancy of its own.
inline MixedMode::Properties<double> mixed_mode_contact() {
  const auto mortar = mortar_contact();
  MixedMode::Properties<double> p;
  p.normal_stiffness = mortar.normal_stiffness;
  p.shear_stiffness = mortar.shear_stiffness;
  p.tensile_strength = mortar.tensile_strength;
  p.mode_1_energy = mortar.mode_1_energy;
  p.compressive_limit = mortar.compressive_limit;
  p.hardening = mortar.hardening;
  p.cohesion = mortar.cohesion;
  p.friction_angle = mortar.friction_angle;
  p.mode_2_energy = mortar.mode_2_energy;
  p.dilatancy_angle = 25.0 * std::numbers::pi / 180.0;
  p.fading_slip = 100e-6;
  p.initial_share = 0.4;
  return p;
}

}  // namespace pyroclast
