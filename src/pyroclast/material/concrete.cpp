#include "pyroclast/material/concrete.hpp"

#include <limits>

namespace pyroclast {

ContactProperties ContactMaterial::at(double temperature) const {
  ContactProperties p;
  p.normal_stiffness = normal_stiffness(temperature);
  p.shear_stiffness = shear_stiffness(temperature);
  p.tensile_strength = tensile_strength(temperature);
  p.mode_1_energy = mode_1_energy(temperature);
  p.compressive_limit = compressive_limit(temperature);
  p.hardening = hardening;
  p.cohesion = cohesion(temperature);
  p.residual_cohesion = residual_cohesion(temperature);
  p.friction = friction;
  p.residual_friction = residual_friction;
  p.mode_2_energy = mode_2_energy(temperature);
  p.behaviour = behaviour;
  p.compression = compression;
  p.coupled = coupled;
  return p;
}

ContactMaterial ContactMaterial::elastic(const Curve& normal_stiffness, const Curve& shear_stiffness) {
  ContactMaterial m;
  m.normal_stiffness = normal_stiffness;
  m.shear_stiffness = shear_stiffness;
  m.behaviour = ContactBehaviour::elastic;
  return m;
}

ContactMaterial ContactMaterial::unbonded(const Curve& normal_stiffness, const Curve& shear_stiffness,
                                          double friction) {
  ContactMaterial m;
  m.normal_stiffness = normal_stiffness;
  m.shear_stiffness = shear_stiffness;
  m.friction = m.residual_friction = friction;
  // Never reached: a platen contact stays linear in compression.
  m.compressive_limit = Curve::constant(1e300);
  m.hardening = 0.5;
  return m;
}

ContactMaterial ContactMaterial::scaled(double stiffness, double strength, double fracture_energy) const {
  ContactMaterial m = *this;
  m.normal_stiffness = normal_stiffness * stiffness;
  m.shear_stiffness = shear_stiffness * stiffness;
  m.tensile_strength = tensile_strength * strength;
  m.compressive_limit = compressive_limit * strength;
  m.cohesion = cohesion * strength;
  m.residual_cohesion = residual_cohesion * strength;
  m.mode_1_energy = mode_1_energy * fracture_energy;
  m.mode_2_energy = mode_2_energy * fracture_energy;
  return m;
}

}  // namespace pyroclast
