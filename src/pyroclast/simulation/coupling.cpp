#include "pyroclast/simulation/coupling.hpp"

namespace pyroclast {

namespace {

ZoneProperties zone_at(const SolidMaterial& solid, double temperature) {
  return zone_properties<2>(solid.young(temperature), solid.poisson, solid.thermal_strain(temperature));
}

/// One set of parameters a material and an interface; bearings keep the reference temperature.
BodyProperties properties_at_one_temperature(const Model<2>& model, const ConcreteMaterials& materials,
                                             double temperature) {
  std::vector<ZoneProperties> solids;
  for (const SolidMaterial& solid : materials.solids)
    solids.push_back(zone_at(solid, solid.is_of_bearing ? kReferenceTemperature : temperature));
  std::vector<ZoneProperties> zones;
  zones.reserve(model.zones.size());
  for (int block : zone_blocks(model)) zones.push_back(solids[model.block_material[block]]);
  std::vector<ContactProperties> interfaces;
  for (std::size_t i = 0; i < materials.contacts.size(); ++i) {
    interfaces.push_back(materials.contacts[i].at(temperature));
    validate(interfaces.back(), model.interface_names[i]);
  }
  return by_interface(model, std::move(zones), interfaces);
}

}  // namespace

BodyProperties properties_at(const Model<2>& model, const ConcreteMaterials& materials,
                             const TemperatureField& field) {
  if (field.is_uniform()) return properties_at_one_temperature(model, materials, field.mean());
  BodyProperties p;
  p.zones.reserve(model.zones.size());
  const auto blocks = zone_blocks(model);
  for (int z = 0; z < model.zone_count(); ++z)
    p.zones.push_back(zone_at(materials.solids[model.block_material[blocks[z]]], field.zones()[z]));
  p.of_contact.reserve(model.contacts.size());
  for (int c = 0; c < model.contact_count(); ++c) {
    const int interface = model.contacts[c].interface;
    p.of_contact.push_back(c);
    const ContactProperties properties = materials.contacts[interface].at(field.contacts()[c]);
    validate(properties, model.interface_names[interface]);
    p.contacts.add(properties);
  }
  return p;
}

}  // namespace pyroclast
