#include "pyroclast/material/concrete.hpp"

#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// E(T) / t_b and G(T) / t_b of Eq. (17).
void set_stiffness(ContactMaterial& contact, const SolidMaterial& solid, double fracture_zone) {
  contact.set(Role::normal_stiffness, solid.young * (1.0 / fracture_zone));
  contact.set(Role::shear_stiffness, solid.young * (0.5 / (1.0 + solid.poisson) / fracture_zone));
}

std::size_t place_of(const LawTable& law, std::string_view key) {
  for (std::size_t i = 0; i < law.properties.size(); ++i)
    if (law.properties[i].key == key) return i;
  throw Error(fmt::format("the contact law \"{}\" has no property \"{}\"", law.name, key));
}

}  // namespace

ContactMaterial::ContactMaterial(const LawTable& of)
    : law(&of), numbers(of.properties.size(), Curve::constant(0.0)), choices(of.choices.size()) {}

Curve& ContactMaterial::operator[](std::string_view key) {
  return numbers[place_of(*law, key)];
}

const Curve& ContactMaterial::operator[](std::string_view key) const {
  return numbers[place_of(*law, key)];
}

void ContactMaterial::set(Role role, const Curve& curve) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].role == role) numbers[i] = curve;
}

const Curve& ContactMaterial::of(Role role) const {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].role == role) return numbers[i];
  throw Error(fmt::format("the contact law \"{}\" has no property of that role", law->name));
}

ContactMaterial ContactMaterial::times(Role role, double factor) const {
  ContactMaterial scaled = *this;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (law->properties[i].role == role) scaled.numbers[i] = numbers[i] * factor;
  return scaled;
}

ContactProperties ContactMaterial::at(double temperature) const {
  std::vector<double> values;
  values.reserve(numbers.size());
  for (const Curve& curve : numbers) values.push_back(curve(temperature));
  return {*law, std::move(values), choices};
}

ConcreteMaterials make_concrete(const std::array<SolidMaterial, 3>& solids, const ContactParameters& p,
                                double block_size) {
  const auto& [aggregate, mortar, platen] = solids;
  ConcreteMaterials concrete;
  concrete.solids = solids;
  concrete.fracture_zone =
      p.fracture_zone_size ? p.fracture_zone * block_size / *p.fracture_zone_size : p.fracture_zone;
  auto& [aa, am, mm, pc] = concrete.contacts;

  aa = ContactMaterial(table_of<Elastic>());
  set_stiffness(aa, aggregate, concrete.fracture_zone);

  mm = p.mortar;
  set_stiffness(mm, mortar, concrete.fracture_zone);
  // A stated stiffness follows E(T) like a computed one.
  const double young = mortar.young(kReferenceTemperature);
  if (p.normal_stiffness) mm.set(Role::normal_stiffness, mortar.young * (*p.normal_stiffness / young));
  if (p.shear_stiffness) mm.set(Role::shear_stiffness, mortar.young * (*p.shear_stiffness / young));

  am = mm.times(Role::normal_stiffness, p.interface_stiffness)
           .times(Role::shear_stiffness, p.interface_stiffness)
           .times(Role::strength, p.interface_strength)
           .times(Role::energy, p.scale_interface_energy ? p.interface_strength : 1.0);

  pc = ContactMaterial(table_of<Frictional>());
  pc.set(Role::normal_stiffness, mm.of(Role::normal_stiffness));
  pc.set(Role::shear_stiffness, mm.of(Role::shear_stiffness));
  pc["friction"] = Curve::constant(p.platen_friction);
  return concrete;
}

}  // namespace pyroclast
