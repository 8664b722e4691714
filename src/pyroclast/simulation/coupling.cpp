#include "pyroclast/simulation/coupling.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "pyroclast/model/visit_contacts.hpp"

namespace pyroclast {

namespace {

/// Returns the material of each zone, by place in the materials of blocks.
std::vector<int> materials_of_zones(const Model& model) {
  std::vector<int> block_materials = zone_blocks(model);
  for (int& entry : block_materials) entry = model.block_material[entry];
  return block_materials;
}

/// Elastic constants by dimension: in 2D those of plane stress.
using Elasticity = ZoneProperties (*)(double young, double poisson, double thermal_strain);

Elasticity elasticity_of(const Model& model) {
  return with_dimension(model, []<int Dim>(const ModelOf<Dim>&) -> Elasticity {
    return [](double young, double poisson, double strain) {
      return zone_properties<Dim>(young, poisson, strain);
    };
  });
}

/// \param hottest        highest temperature so far, °C
/// \param pore_pressure  pressure of pore water times Biot's coefficient, Pa. A free strain stands for it
///                       (Terzaghi, Biot): in space and in plane stress alike p (1 - 2 nu) / E.
ZoneProperties zone_at(const ConcreteMaterials& materials, Elasticity elasticity,
                       const BlockMaterial& material, double temperature, double hottest,
                       double pore_pressure = 0.0) {
  const double young = material.young_at(temperature, materials.property_temperature(temperature, hottest));
  double strain = material.free_strain(temperature, hottest);
  if (pore_pressure != 0.0) strain += pore_pressure * (1.0 - 2.0 * material.poisson) / young;
  return elasticity(young, material.poisson, strain);
}

/// Finds the creep of each zone; none where nothing creeps.
/// \param zone_materials  material of each zone, by place in the materials of blocks
/// \param increments   creep of each zone, out
void find_creep_increments(const std::vector<int>& zone_materials, const ConcreteMaterials& materials,
                           const TemperatureField& field, const HottestTemperatures& before,
                           std::vector<CreepIncrement>& increments) {
  increments.clear();
  if (!materials.creeps()) return;
  for (int z = 0; z < static_cast<int>(zone_materials.size()); ++z) {
    const BlockMaterial& material = materials.block_materials[zone_materials[z]];
    const double now = field.zones()[z];
    increments.push_back(material.creep
                             ? material.creep->between(before.of_zone_at_exchanges(z, kReferenceTemperature),
                                                       before.of_zone(z, now))
                             : CreepIncrement{});
  }
}

bool blocks_are_alike(const Model& model) {
  for (int c = 0; c < model.contact_count(); ++c)
    if (model.joint(c).block_size > 0.0) return false;
  return true;
}

/// Returns properties of a body whose contacts differ by interface, and in their stiffness by the size of the
/// blocks: one set of parameters for each that occurs.
/// \param interfaces  contact properties of each interface where blocks have their mean size
BodyProperties by_block_size(const Model& model, std::vector<ZoneProperties> zones,
                             const ConcreteMaterials& materials,
                             const std::vector<ContactProperties>& interfaces) {
  std::map<std::pair<int, double>, int> set_of;
  BodyProperties p;
  p.zones = std::move(zones);
  for (const ContactProperties& of_mean : interfaces) p.contacts.know(*of_mean.law, of_mean.choices);
  p.of_contact.reserve(model.contact_count());
  for (int c = 0; c < model.contact_count(); ++c) {
    const Joint& joint = model.joint(c);
    const ContactMaterial& contact = materials.contacts[joint.interface];
    const double factor = contact.stiffness_between(joint.block_size);
    const auto [set, is_new] = set_of.try_emplace({joint.interface, factor}, p.contacts.size());
    p.of_contact.push_back(set->second);
    if (!is_new) continue;
    ContactProperties scaled = interfaces[joint.interface];
    contact.scale_to_size(factor, scaled.numbers);
    validate(scaled, model.interface_names[joint.interface]);
    p.contacts.add(scaled);
  }
  for (std::size_t i = 0; materials.has_found_contacts && i < interfaces.size(); ++i) {
    p.of_interface.push_back(p.contacts.size());
    p.contacts.add(interfaces[i]);
  }
  return p;
}

/// Returns properties at one temperature: one set of parameters a material and an interface. Bearings keep
/// the reference temperature.
BodyProperties properties_at_one_temperature(const Model& model, const std::vector<int>& zone_materials,
                                             const ConcreteMaterials& materials, double temperature,
                                             double hottest) {
  const Elasticity elasticity = elasticity_of(model);
  std::vector<ZoneProperties> block_materials;
  for (const BlockMaterial& material : materials.block_materials)
    block_materials.push_back(
        material.is_of_bearing
            ? zone_at(materials, elasticity, material, kReferenceTemperature, kReferenceTemperature)
            : zone_at(materials, elasticity, material, temperature, hottest));
  std::vector<ZoneProperties> zones;
  zones.reserve(zone_materials.size());
  for (int material : zone_materials) zones.push_back(block_materials[material]);
  std::vector<ContactProperties> interfaces;
  for (std::size_t i = 0; i < materials.contacts.size(); ++i) {
    interfaces.push_back(
        materials.contacts[i].at(temperature, materials.property_temperature(temperature, hottest)));
    validate(interfaces.back(), model.interface_names[i]);
  }
  return blocks_are_alike(model) ? by_interface(model, std::move(zones), interfaces)
                                 : by_block_size(model, std::move(zones), materials, interfaces);
}

}  // namespace

HottestTemperatures::HottestTemperatures(const Model& model, const ConcreteMaterials& materials,
                                         const TemperatureField& field,
                                         const std::vector<double>& stress_free)
    : model_(&model),
      keeps_zones_(materials.asks_for_hottest()),
      keeps_contacts_(materials.on_cooling == OnCooling::irreversible) {
  if (keeps_zones_) zones_ = field.zones();
  if (keeps_contacts_) contacts_ = field.contacts();
  body_ = field.mean();
  if (materials.stress_free) {
    begin_at(model, std::vector<double>(model.gridpoint_count(), *materials.stress_free));
    body_ = std::max(body_, *materials.stress_free);
  } else if (!stress_free.empty()) {
    stress_free_zones_ = begin_at(model, stress_free);
  }
  seen_zones_ = zones_;
  seen_contacts_ = contacts_;
}

std::vector<double> HottestTemperatures::begin_at(const Model& model, const std::vector<double>& gridpoints) {
  std::vector<double> of_zones(model.zone_count(), kReferenceTemperature);
  for (int b = 0; b < model.block_count(); ++b) {
    if (model.is_of_bearing(b)) continue;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z) {
      of_zones[z] = mean_of_zone(model, z, gridpoints);
      if (!zones_.empty()) zones_[z] = std::max(zones_[z], of_zones[z]);
    }
  }
  const auto between = contact_gridpoints(model);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto [a, b] = between[c];
    contacts_[c] = std::max(contacts_[c], 0.5 * (gridpoints[a] + gridpoints[b]));
  }
  return of_zones;
}

void HottestTemperatures::note_field(const TemperatureField& field) {
  for (std::size_t z = 0; z < zones_.size(); ++z) seen_zones_[z] = std::max(seen_zones_[z], field.zones()[z]);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    seen_contacts_[c] = std::max(seen_contacts_[c], field.contacts()[c]);
}

void HottestTemperatures::note_exchange(const TemperatureField& field) {
  note_field(field);
  zones_ = seen_zones_;
  contacts_ = seen_contacts_;
  body_ = std::max(body_, field.mean());
}

void HottestTemperatures::visit_state(StateVisitor& visitor) {
  const ChunkList zones = model_->zone_chunks();
  if (keeps_zones_) visitor.visit_by_chunk("zones", zones_, zones, kTemperatures);
  if (keeps_zones_) visitor.visit_by_chunk("seen_zones", seen_zones_, zones, kTemperatures);
  if (keeps_contacts_) visit_contacts(visitor, "contacts", *model_, contacts_, kTemperatures);
  if (keeps_contacts_) visit_contacts(visitor, "seen_contacts", *model_, seen_contacts_, kTemperatures);
  visitor.visit("body", body_, kTemperatures);
}

BodyProperties properties_at(const Model& model, const ConcreteMaterials& materials,
                             const TemperatureField& field, const HottestTemperatures& before,
                             const std::optional<PorePressures>& water, BodyProperties memory) {
  const std::vector<int> zone_materials = materials_of_zones(model);
  BodyProperties p = std::move(memory);
  const PorePressures none;
  const PorePressures& pressures = water ? *water : none;
  p.pore_pressure = pressures.of_contacts;
  p.pore_opening = pressures.at_openings;
  p.pore_reserve = pressures.reserve;
  find_creep_increments(zone_materials, materials, field, before, p.creep);
  if (field.is_uniform() && before.stress_free_zones().empty() && !water) {
    BodyProperties even = properties_at_one_temperature(model, zone_materials, materials, field.mean(),
                                                        before.of_body(field.mean()));
    even.creep = std::move(p.creep);
    return even;
  }
  const Elasticity elasticity = elasticity_of(model);
  p.zones.clear();
  p.zones.reserve(zone_materials.size());
  const std::vector<int> blocks = water ? zone_blocks(model) : std::vector<int>();
  for (int z = 0; z < model.zone_count(); ++z) {
    const double now = field.zones()[z];
    const BlockMaterial& material = materials.block_materials[zone_materials[z]];
    p.zones.push_back(zone_at(materials, elasticity, material, now, before.of_zone(z, now),
                              water ? water->of_blocks[blocks[z]] : 0.0));
    if (!before.stress_free_zones().empty() && !material.is_of_bearing)
      p.zones.back().thermal_strain -= material.thermal_strain(before.stress_free_zones()[z]);
  }
  std::size_t numbers = 0;
  for (int c = 0; c < model.contact_count(); ++c)
    numbers += materials.contacts[model.joint(c).interface].numbers.size();
  p.contacts.clear();
  for (const ContactMaterial& contact : materials.contacts) p.contacts.know(*contact.law, contact.choices);
  p.contacts.reserve(model.contact_count(), numbers);
  p.of_contact.clear();
  p.of_contact.reserve(model.contact_count());
  for (int c = 0; c < model.contact_count(); ++c) {
    const int interface = model.joint(c).interface;
    p.of_contact.push_back(c);
    const double now = field.contacts()[c];
    const ContactMaterial& contact = materials.contacts[interface];
    const auto to = p.contacts.add(*contact.law, contact.choices);
    contact.write_at(now, materials.property_temperature(now, before.of_contact(c, now)), to);
    if (const double size = model.joint(c).block_size; size > 0.0)
      contact.scale_to_size(contact.stiffness_between(size), to);
    p.contacts.validate(c, model.interface_names[interface]);
  }
  p.of_interface.clear();
  if (!materials.has_found_contacts) return p;
  const double mean = field.mean();
  for (const ContactMaterial& contact : materials.contacts) {
    p.of_interface.push_back(p.contacts.size());
    p.contacts.add(contact.at(mean, materials.property_temperature(mean, before.of_body(mean))));
  }
  return p;
}

}  // namespace pyroclast
