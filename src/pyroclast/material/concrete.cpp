#include "pyroclast/material/concrete.hpp"

namespace pyroclast {

namespace {

/// A compressive limit that no contact reaches: platen contacts stay linear in compression.
constexpr double kNeverReached = 1e300;

/// E(T) / t_b and G(T) / t_b of Eq. (17).
void set_stiffness(ContactMaterial& contact, const SolidMaterial& solid, double fracture_zone) {
  contact.normal_stiffness = solid.young * (1.0 / fracture_zone);
  contact.shear_stiffness = solid.young * (0.5 / (1.0 + solid.poisson) / fracture_zone);
}

ContactMaterial scaled(const ContactMaterial& m, double stiffness, double strength, double fracture_energy) {
  ContactMaterial s = m;
  s.normal_stiffness = m.normal_stiffness * stiffness;
  s.shear_stiffness = m.shear_stiffness * stiffness;
  s.tensile_strength = m.tensile_strength * strength;
  s.compressive_limit = m.compressive_limit * strength;
  s.cohesion = m.cohesion * strength;
  s.residual_cohesion = m.residual_cohesion * strength;
  s.mode_1_energy = m.mode_1_energy * fracture_energy;
  s.mode_2_energy = m.mode_2_energy * fracture_energy;
  return s;
}

}  // namespace

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

ConcreteMaterials make_concrete(const std::array<SolidMaterial, 3>& solids, const ContactParameters& p,
                                double block_size) {
  const auto& [aggregate, mortar, platen] = solids;
  ConcreteMaterials concrete;
  concrete.solids = solids;
  concrete.fracture_zone =
      p.fracture_zone_size ? p.fracture_zone * block_size / *p.fracture_zone_size : p.fracture_zone;
  auto& [aa, am, mm, pc] = concrete.contacts;

  set_stiffness(aa, aggregate, concrete.fracture_zone);
  aa.behaviour = ContactBehaviour::elastic;

  mm = p.mortar;
  set_stiffness(mm, mortar, concrete.fracture_zone);
  // A stated stiffness follows E(T) like a computed one.
  const double young = mortar.young(kReferenceTemperature);
  if (p.normal_stiffness) mm.normal_stiffness = mortar.young * (*p.normal_stiffness / young);
  if (p.shear_stiffness) mm.shear_stiffness = mortar.young * (*p.shear_stiffness / young);

  am = scaled(mm, p.interface_stiffness, p.interface_strength,
              p.scale_interface_energy ? p.interface_strength : 1.0);

  pc.normal_stiffness = mm.normal_stiffness;
  pc.shear_stiffness = mm.shear_stiffness;
  pc.friction = pc.residual_friction = p.platen_friction;
  pc.compressive_limit = Curve::constant(kNeverReached);
  pc.hardening = 0.5;
  return concrete;
}

}  // namespace pyroclast
