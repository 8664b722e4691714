#include "pyroclast/simulation/fields.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/simulation/cracks.hpp"

namespace pyroclast {

namespace {

using S = Simulation;
using R = FieldReader;

bool always(const S&) {
  return true;
}
bool moves(const S& s) {
  return s.moves();
}
bool creeps(const S& s) {
  return s.moves() && s.mechanics().body().creeps();
}
bool parts_heat(const S& s) {
  return s.moves() && s.cracks_hinder_heat();
}

constexpr int kMostComponents = 6;  // components of a tensor
constexpr std::array<std::string_view, 4> kItemNames{"gridpoint", "zone", "contact", "contact_end"};

void put(double* to, const Vec<2>& v) {
  to[0] = v[0];
  to[1] = v[1];
}

/// Writes a tensor in the plane, with a component across it.
void put(double* to, const SymmetricTensor<2>& t, double across) {
  const std::array<double, kMostComponents> all{t[0], t[1], across, t[2], 0.0, 0.0};
  std::ranges::copy(all, to);
}

/// Returns the creep strain of a zone, and its component across the plane, which acts on nothing.
std::pair<SymmetricTensor<2>, double> creep_of(const R& r, int zone) {
  if (!r.mechanics().body().creeps()) return {};
  const Model<2>& model = r.model();
  const auto& creep =
      r.simulation().materials().solids[model.block_material[model.block_of(model.zones[zone][0])]].creep;
  const auto strain = r.mechanics().read().creep_strain(zone);
  return {strain, creep ? creep_across(strain, creep->choices.poisson) : 0.0};
}

/// Writes the strain of a zone in plane stress: in the plane that of the displacements, and across it the
/// strain that leaves the zone free of stress there.
void put_strain(R& r, int zone, double* to) {
  const SymmetricTensor<2>& stress = r.stress(zone);
  const ZoneProperties properties = r.mechanics().read().properties_of_zone(zone);
  const auto [creep, creep_across] = creep_of(r, zone);
  const double in_plane = (stress[0] + stress[1]) / (2.0 * (properties.lambda + properties.mu));
  const auto direct = [&](double s) { return (s - properties.lambda * in_plane) / (2.0 * properties.mu); };
  put(to,
      {direct(stress[0]) + properties.thermal_strain + creep[0],
       direct(stress[1]) + properties.thermal_strain + creep[1], 0.5 * stress[2] / properties.mu + creep[2]},
      direct(0.0) + properties.thermal_strain + creep_across);
}

/// Writes the traction on a contact as the stress in its direction: σ n n + τ (n t + t n).
void put_contact_stress(R& r, int contact, double* to) {
  const ContactState<2>& state = r.contact(contact);
  const ContactFrame<2> frame = r.mechanics().read().frame_of_forces(contact);
  const auto &n = frame.normal, &t = frame.tangents[0];
  const double normal = state.normal_traction, shear = state.shear_traction[0];
  put(to,
      {normal * n[0] * n[0] + 2.0 * shear * n[0] * t[0], normal * n[1] * n[1] + 2.0 * shear * n[1] * t[1],
       normal * n[0] * n[1] + shear * (n[0] * t[1] + n[1] * t[0])},
      0.0);
}

/// Returns the largest damage of a contact by any mode, 0 to 1; 0 at bearings, whose contacts are no cracks.
double crack(const R& r, int contact) {
  if (r.model().is_of_bearing(r.model().contacts[contact])) return 0.0;
  double most = 0.0;
  for (const auto mode : kCrackModes) most = std::max(most, r.mechanics().read().remembered(contact, mode));
  return most;
}

double temperature_jump(const R& r, int contact) {
  const auto& temperature = r.simulation().field().gridpoints();
  const auto& c = r.model().contacts[contact];
  return r.model().is_of_bearing(c) ? 0.0 : temperature[c.b] - temperature[c.a];
}

/// Writes the displacement at an end of a contact's line: the mean of both sides. The second end is half way
/// to the other contact of the edge.
void put_end(R& r, int end, double* to) {
  const auto mean = [&](int contact) {
    const auto& c = r.model().contacts[contact];
    return 0.5 * (r.mechanics().read().displacement(c.a) + r.mechanics().read().displacement(c.b));
  };
  const int contact = end / 2;
  const Vec<2> here = mean(contact);
  put(to,
      end % 2 == 0 ? here : 0.5 * (here + mean(contact ^ 1)));  // the two contacts of an edge stand together
}

/// Field that does not come from a law.
struct KnownField {
  const char* name;
  const Unit& unit;
  Item item;
  ValueKind kind;
  bool in_files;
  bool (*is_there)(const S&);
  void (*read)(R&, int, double*);
  const char* meaning;
};

constexpr auto kOfBlocks = std::to_array<KnownField>({
    {"displacement", unit::length, Item::gridpoint, ValueKind::vector, true, moves,
     [](R& r, int i, double* to) { put(to, r.mechanics().read().displacement(i)); },
     "since the start; not in runs of heat alone"},
    {"velocity", unit::velocity, Item::gridpoint, ValueKind::vector, false, moves,
     [](R& r, int i, double* to) { put(to, r.mechanics().read().velocity(i)); },
     "in the middle of the last step"},
    {"force", unit::force, Item::gridpoint, ValueKind::vector, false, moves,
     [](R& r, int i, double* to) { put(to, r.mechanics().read().force(i)); },
     "sum of all forces at the last step; where the motion is held, minus the reaction"},
    {"stress", unit::stress, Item::zone, ValueKind::tensor, true, moves,
     [](R& r, int i, double* to) { put(to, r.stress(i), 0.0); }, "of a zone"},
    {"strain", unit::dimensionless, Item::zone, ValueKind::tensor, true, moves, put_strain,
     "of a zone, with the thermal strain and what it has crept"},
    {"creep_strain", unit::dimensionless, Item::zone, ValueKind::tensor, true, creeps,
     [](R& r, int i, double* to) {
       const auto [strain, across] = creep_of(r, i);
       put(to, strain, across);
     },
     "what a zone has crept under load, see [method.md](method.md#creep-under-load); only where a phase "
     "creeps. ZZ "
     "acts on nothing"},
    {"temperature", unit::temperature, Item::gridpoint, ValueKind::number, true, always,
     [](R& r, int i, double* to) { *to = r.simulation().field().gridpoints()[i]; }, "platens stay at 20 °C"},
});

constexpr KnownField kOfEnds{"displacement", unit::length, Item::contact_end, ValueKind::vector,
                             true,           moves,        put_end,           "mean of both sides"};

constexpr auto kOfContacts = std::to_array<KnownField>({
    {"crack", unit::dimensionless, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = crack(r, i); },
     "the largest damage by any mode, 0 intact, 1 broken; 0 at the platens, which are no cracks"},
    {"opening", unit::length, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).opening; }, "normal jump, positive when open"},
    {"tangential_jump", unit::length, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).tangential_jump[0]; }, "slip along the face"},
    {"normal_traction", unit::stress, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).normal_traction; }, "positive in tension"},
    {"shear_traction", unit::stress, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).shear_traction[0]; }, "along the face"},
    {"stress", unit::stress, Item::contact, ValueKind::tensor, true, moves, put_contact_stress,
     "σ n n + τ (n t + t n) of the tractions σ and τ, with n across the contact and t along it"},
    {"heat_conductance", unit::heat_transfer, Item::contact, ValueKind::number, true, parts_heat,
     [](R& r, int i, double* to) { *to = r.heat_conductances()[i]; },
     "h as the heat of this frame met it, where [cracks hinder heat](heat.md#cracks); 0 at bearings"},
    {"temperature_jump", unit::temperature_difference, Item::contact, ValueKind::number, true, parts_heat,
     [](R& r, int i, double* to) { *to = temperature_jump(r, i); },
     "likewise: of side b less that of side a"},
    {"stored", unit::fracture_energy, Item::contact, ValueKind::number, false, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).stored; }, "elastic energy"},
});

FieldInfo info_of(const KnownField& f) {
  return {f.name, f.unit, f.item, f.kind, f.meaning, f.in_files};
}

/// Adds the internal variables of a law, without those whose names another law has given already.
void add_memory(const LawTable& law, std::vector<FieldInfo>& all) {
  for (const InternalInfo& info : law.internals(2))
    if (std::ranges::find(all, std::string(info.name), &FieldInfo::name) == all.end())
      all.push_back({info.name, info.unit, Item::contact, ValueKind::number, info.meaning, info.in_files});
}

/// Adds the losses of a law, without those whose names another law has given already.
void add_losses(const LawTable& law, std::vector<FieldInfo>& all) {
  for (const LossInfo& info : law.losses)
    if (const auto name = fmt::format("lost_{}", info.name);
        std::ranges::find(all, name, &FieldInfo::name) == all.end())
      all.push_back({name, info.unit, Item::contact, ValueKind::number,
                     fmt::format("since the start: {}", info.meaning), false});
}

template <class Laws>
std::vector<FieldInfo> of_laws(const Laws& laws, void (*add)(const LawTable&, std::vector<FieldInfo>&)) {
  std::vector<FieldInfo> all;
  for (const LawTable* law : laws) add(*law, all);
  return all;
}

/// Returns the laws of the contacts in the order in which the model has them.
std::vector<const LawTable*> laws_in_order(const Mechanics<2>& mechanics) {
  std::vector<const LawTable*> laws;
  const LawTable* last = nullptr;
  for (int i = 0; i < mechanics.model().contact_count(); ++i) {
    const LawTable* const law = &mechanics.body().law_of(i);
    if (std::exchange(last, law) != law && std::ranges::find(laws, law) == laws.end()) laws.push_back(law);
    if (laws.size() == mechanics.body().laws.size()) break;
  }
  return laws;
}

}  // namespace

const char* name_of(Item item) {
  return kItemNames[static_cast<std::size_t>(item)].data();
}

Item item_of(std::string_view name) {
  const auto found = std::ranges::find(kItemNames, name);
  if (found == kItemNames.end())
    throw Error(fmt::format("item \"{}\": must be one of {}", name, fmt::join(kItemNames, ", ")));
  return static_cast<Item>(found - kItemNames.begin());
}

std::string product_of(const Unit& unit) {
  std::string product;
  std::istringstream parts(unit.si);
  for (std::string part; std::getline(parts, part, '/');) {
    if (product.empty()) {
      product = part;
      continue;
    }
    const auto digits = std::min(part.find_first_of("0123456789"), part.size());
    product +=
        fmt::format(" {}-{}", part.substr(0, digits), digits < part.size() ? part.substr(digits) : "1");
  }
  return product.starts_with("1 ") ? product.substr(2) : product;
}

std::string name_with_unit(const FieldInfo& field) {
  return column_with_unit(field.name, field.unit).name;
}

int count_of(Item item, const Model<2>& model) {
  switch (item) {
    case Item::gridpoint:
      return model.gridpoint_count();
    case Item::zone:
      return model.zone_count();
    case Item::contact:
      return model.contact_count();
    case Item::contact_end:
      break;
  }
  return 2 * model.contact_count();
}

int components_of(ValueKind kind) {
  return kind == ValueKind::number ? 1 : kind == ValueKind::vector ? 2 : kMostComponents;
}

const ContactState<2>& FieldReader::contact(int contact) {
  if (std::exchange(contact_, contact) != contact) state_ = mechanics().read().contact(contact);
  return state_;
}

const SymmetricTensor<2>& FieldReader::stress(int zone) {
  if (std::exchange(zone_, zone) != zone) stress_ = mechanics().read().stress(zone);
  return stress_;
}

const std::vector<double>& FieldReader::heat_conductances() {
  const TemperatureField& field = simulation_.field();
  if (heat_conductances_.empty())
    heat_conductances_ = field.conduction()->gaps()->conductances(field.gridpoints());
  return heat_conductances_;
}

std::vector<Field> fields_of(const Simulation& simulation) {
  std::vector<Field> all;
  const auto add = [&](const KnownField& f) {
    if (f.is_there(simulation)) all.push_back({info_of(f), f.read});
  };
  for (const KnownField& f : kOfBlocks) add(f);
  add(kOfEnds);
  if (!simulation.moves()) return all;
  const auto laws = laws_in_order(simulation.mechanics());
  for (const FieldInfo& info : of_laws(laws, add_memory))
    all.push_back({info, [name = info.name](R& r, int i, double* to) {
                     *to = r.contact(i).remembered(std::string_view(name));
                   }});
  for (const KnownField& f : kOfContacts) add(f);
  for (const FieldInfo& info : of_laws(laws, add_losses))
    all.push_back({info, [name = info.name.substr(info.name.find('_') + 1)](R& r, int i, double* to) {
                     *to = r.contact(i).lost(name);
                   }});
  return all;
}

std::vector<FieldInfo> possible_fields() {
  std::vector<FieldInfo> all;
  for (const KnownField& f : kOfBlocks) all.push_back(info_of(f));
  all.push_back(info_of(kOfEnds));
  std::ranges::copy(of_laws(built_in_laws(), add_memory), std::back_inserter(all));
  for (const KnownField& f : kOfContacts) all.push_back(info_of(f));
  std::ranges::copy(of_laws(built_in_laws(), add_losses), std::back_inserter(all));
  return all;
}

template <class T>
std::vector<std::vector<T>> values_of(const std::vector<Field>& fields, const Simulation& simulation) {
  std::vector<std::vector<T>> values(fields.size());
  if (fields.empty()) return values;
  const int count = count_of(fields.front().item, simulation.model());
  for (std::size_t f = 0; f < fields.size(); ++f)
    values[f].reserve(static_cast<std::size_t>(count) * components_of(fields[f].kind));
  FieldReader reader(simulation);
  std::array<double, kMostComponents> value;
  for (int i = 0; i < count; ++i)
    for (std::size_t f = 0; f < fields.size(); ++f) {
      fields[f].read(reader, i, value.data());
      for (int c = 0; c < components_of(fields[f].kind); ++c) values[f].push_back(static_cast<T>(value[c]));
    }
  return values;
}

template std::vector<std::vector<float>> values_of(const std::vector<Field>&, const Simulation&);
template std::vector<std::vector<double>> values_of(const std::vector<Field>&, const Simulation&);

}  // namespace pyroclast
