#include "pyroclast/simulation/watching/fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/simulation/watching/found_fields.hpp"

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
  return s.moves() && s.motion().creeps();
}
bool is_moist(const S& s) {
  return s.moisture() != nullptr;
}
bool bears_water(const S& s) {
  return s.moves() && is_moist(s) && s.moisture()->acts_on_contacts();
}
bool loses_pieces(const S& s) {
  return s.spalling() != nullptr;
}
bool parts_heat(const S& s) {
  return s.moves() && s.cracks_hinder_heat();
}

constexpr int kMostComponents = 6;  // components of a tensor

void put(double* to, const Vec<3>& v) {
  std::ranges::copy(v.c, to);
}

void put(double* to, const SymmetricTensor<3>& t) {
  std::ranges::copy(t, to);
}

int block_of_zone(const R& r, int zone) {
  return r.model().block_of(r.model().gridpoints_of_zone(zone)[0]);
}

/// Returns the creep strain of a zone. In plane stress its component across the plane acts on nothing.
SymmetricTensor<3> creep_of(const R& r, int zone) {
  if (!r.motion().creeps()) return {};
  const Model& model = r.model();
  const int block = block_of_zone(r, zone);
  const auto& creep = r.simulation().materials().block_materials[model.block_material[block]].creep;
  SymmetricTensor<3> strain = r.motion().read().creep_strain(zone);
  if (model.dimension() == 2 && creep) strain[2] = creep_across(strain[0], strain[1], creep->choices.poisson);
  return strain;
}

/// Writes the strain of a zone, that of its displacements.
void put_strain(R& r, int zone, double* to) {
  const SymmetricTensor<3> creep = creep_of(r, zone);
  const double thermal = r.motion().read().properties_of_zone(zone).thermal_strain;
  SymmetricTensor<3> strain = r.motion().read().elastic_strain(zone);
  for (std::size_t i = 0; i < 3; ++i) strain[i] += thermal;
  for (std::size_t i = 0; i < strain.size(); ++i) strain[i] += creep[i];
  put(to, strain);
}

/// Writes the traction on a contact as the stress in its direction: σ n n + τ (n t + t n).
void put_contact_stress(R& r, int contact, double* to) {
  const ContactState& state = r.contact(contact);
  const ContactFrame<3> frame = r.motion().read().frame_of_forces(contact);
  const auto& n = frame.normal;
  // places of the components among those of the tensor
  constexpr std::array<std::array<int, 2>, 6> kPlaces{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
  SymmetricTensor<3> stress{};
  for (std::size_t k = 0; k < kPlaces.size(); ++k) {
    const auto [i, j] = kPlaces[k];
    if (j >= r.model().dimension()) continue;
    stress[k] = state.normal_traction * n[i] * n[j];
    for (int s = 0; s + 1 < r.model().dimension(); ++s) {
      const auto& t = frame.tangents[s];
      stress[k] += i == j ? 2.0 * state.shear_traction[s] * n[i] * t[i]
                          : state.shear_traction[s] * (n[i] * t[j] + n[j] * t[i]);
    }
  }
  put(to, stress);
}

/// Returns the component of a vector along a face; of a solid, which has two, their size.
double along_face(const R& r, const Vec<2>& tangential) {
  return r.model().dimension() == 2 ? tangential[0] : norm(tangential);
}

/// Returns the largest damage of a contact by any mode, 0 to 1; 0 at bearings, whose contacts are no cracks.
double crack(const R& r, int contact) {
  return r.model().is_of_bearing(r.model().joint(contact)) ? 0.0 : r.motion().read().damage(contact);
}

/// Returns the step at which a contact was first found cracked, as `crack` tells it.
double crack_step(const R& r, int contact) {
  if (r.model().is_of_bearing(r.model().joint(contact)) || r.is_gone(Item::contact, contact))
    return kNotCracked;
  return r.motion().read().crack_step(contact);
}

double temperature_jump(const R& r, int contact) {
  const auto& temperature = r.simulation().field().gridpoints();
  const Joint& c = r.model().joint(contact);
  return r.model().is_of_bearing(c) ? 0.0 : temperature[c.b] - temperature[c.a];
}

/// Writes the displacement at an end of a contact's cell: the mean of both sides.
void put_end(R& r, int end, double* to) {
  const int ends = ends_of_contact(r.model().dimension());
  put(to, at_end(r.model(), end / ends, end % ends, [&](int contact) {
        const Joint& c = r.model().joint(contact);
        return 0.5 * (r.motion().read().displacement(c.a) + r.motion().read().displacement(c.b));
      }));
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
     [](R& r, int i, double* to) { put(to, r.motion().read().displacement(i)); },
     "since the start; not in runs of heat alone"},
    {"velocity", unit::velocity, Item::gridpoint, ValueKind::vector, false, moves,
     [](R& r, int i, double* to) { put(to, r.motion().read().velocity(i)); },
     "in the middle of the last step"},
    {"force", unit::force, Item::gridpoint, ValueKind::vector, false, moves,
     [](R& r, int i, double* to) { put(to, r.motion().read().force(i)); },
     "sum of all forces at the last step; where the motion is held, minus the reaction"},
    {"stress", unit::stress, Item::zone, ValueKind::tensor, true, moves,
     [](R& r, int i, double* to) { put(to, r.motion().read().stress(i)); }, "of a zone"},
    {"strain", unit::dimensionless, Item::zone, ValueKind::tensor, true, moves, put_strain,
     "of a zone, with the thermal strain and the creep strain"},
    {"creep_strain", unit::dimensionless, Item::zone, ValueKind::tensor, true, creeps,
     [](R& r, int i, double* to) { put(to, creep_of(r, i)); },
     "strain of a zone by creep under load, see [Creep under "
     "load](../understand/theory.md#creep-under-load); "
     "only where "
     "a phase creeps. ZZ acts on nothing"},
    {"pore_pressure", unit::stress, Item::zone, ValueKind::number, true, is_moist,
     [](R& r, int i, double* to) { *to = r.simulation().moisture()->pore_pressure(block_of_zone(r, i)); },
     "pressure of the vapour in the pores of the block less that of the atmosphere, at least 0; only with "
     "[water in pores](../understand/moisture.md)"},
    {"saturation", unit::dimensionless, Item::zone, ValueKind::number, true, is_moist,
     [](R& r, int i, double* to) { *to = r.simulation().moisture()->saturation(block_of_zone(r, i)); },
     "likewise: share of the pores that liquid fills"},
    {"water_content", unit::density, Item::zone, ValueKind::number, true, is_moist,
     [](R& r, int i, double* to) { *to = r.simulation().moisture()->content(block_of_zone(r, i)); },
     "likewise: liquid and vapour"},
    {"temperature", unit::temperature, Item::gridpoint, ValueKind::number, true, always,
     [](R& r, int i, double* to) {
       *to = r.is_gone(Item::gridpoint, i) ? kReferenceTemperature : r.simulation().field().gridpoints()[i];
     },
     "bearings stay at 20 °C"},
    {"gone", unit::dimensionless, Item::zone, ValueKind::number, true, loses_pieces,
     [](R& r, int i, double* to) { *to = r.is_gone(Item::zone, i) ? 1.0 : 0.0; },
     "1 in blocks that have left the body, else 0; only where [pieces leave](../understand/spalling.md). All "
     "other fields of such blocks and of their contacts are 0, `crack_step` -1, their temperature 20 °C and "
     "their displacement that with which they left"},
});

constexpr KnownField kOfEnds{"displacement", unit::length, Item::contact_end, ValueKind::vector,
                             true,           moves,        put_end,           "mean of both sides"};

constexpr auto kOfContacts = std::to_array<KnownField>({
    {"face_pressure", unit::stress, Item::contact, ValueKind::number, true, is_moist,
     [](R& r, int i, double* to) { *to = r.simulation().moisture()->contact_pressure(i); },
     "pressure of the vapour between the two blocks, or in the crack there, less that of the atmosphere, at "
     "least 0; only with [water in pores](../understand/moisture.md)"},
    {"pressure_over_strength", unit::dimensionless, Item::contact, ValueKind::number, true, bears_water,
     [](R& r, int i, double* to) { *to = r.simulation().pressure_over_strength(i); },
     "pore pressure that an intact contact bears, `biot` times that at the face, over its tensile "
     "strength at its temperatures; 0 where the contact is damaged. Above 1 a contact that bears nothing "
     "else tears; only with [water in pores](../understand/moisture.md)"},
    {"crack", unit::dimensionless, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = crack(r, i); },
     "the largest damage by any mode, 0 intact, 1 broken; 0 at bearings, whose contacts are no cracks"},
    {"crack_step", unit::dimensionless, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = crack_step(r, i); },
     "step of the first row of the history that found the largest damage above 0.5; -1 before, and at "
     "bearings"},
    {"opening", unit::length, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).opening; }, "normal jump, positive when open"},
    {"tangential_jump", unit::length, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = along_face(r, r.contact(i).tangential_jump); },
     "jump along the face; of a solid its size"},
    {"normal_traction", unit::stress, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).normal_traction; }, "positive in tension"},
    {"shear_traction", unit::stress, Item::contact, ValueKind::number, true, moves,
     [](R& r, int i, double* to) { *to = along_face(r, r.contact(i).shear_traction); },
     "along the face; of a solid its size"},
    {"stress", unit::stress, Item::contact, ValueKind::tensor, true, moves, put_contact_stress,
     "σ n n + τ (n t + t n) of the tractions σ and τ, with n across the contact and t along it"},
    {"heat_conductance", unit::heat_transfer, Item::contact, ValueKind::number, true, parts_heat,
     [](R& r, int i, double* to) { *to = r.heat_conductances()[i]; },
     "h as the heat of this frame met it, where [cracks hinder heat](../understand/heat.md#cracks); 0 at "
     "bearings"},
    {"temperature_jump", unit::temperature_difference, Item::contact, ValueKind::number, true, parts_heat,
     [](R& r, int i, double* to) { *to = temperature_jump(r, i); },
     "likewise: of side b less that of side a"},
    {"stored", unit::fracture_energy, Item::contact, ValueKind::number, false, moves,
     [](R& r, int i, double* to) { *to = r.contact(i).stored; }, "elastic energy"},
});

FieldInfo info_of(const KnownField& f) {
  return {f.name, f.unit, f.item, f.kind, f.meaning, f.in_files};
}

/// Returns how many internal variables of a law have a name: a vector along the face has two in 3D.
auto numbers_named(const LawTable& law, int dimension, std::string_view name) {
  return std::ranges::count(law.internals(dimension), name, [](const auto& info) { return info.name; });
}

/// Adds the internal variables of a law, without those whose names another law has given already.
void add_memory(const LawTable& law, int dimension, std::vector<FieldInfo>& all) {
  for (const InternalInfo& info : law.internals(dimension))
    if (std::ranges::find(all, std::string(info.name), &FieldInfo::name) == all.end())
      all.push_back({info.name, info.unit, Item::contact, ValueKind::number,
                     fmt::format("{}{}", info.meaning,
                                 numbers_named(law, 3, info.name) > 1 ? "; of a solid its size" : ""),
                     info.in_files});
}

/// Returns an internal variable of a contact; of one with two components the size.
double memory_of(const ContactState& contact, std::string_view name) {
  if (numbers_named(*contact.law, contact.dimension, name) < 2) return contact.remembered(name);
  double squares = 0.0;
  const auto infos = contact.law->internals(contact.dimension);
  for (std::size_t i = 0; i < infos.size(); ++i)
    if (infos[i].name == name) squares += contact.internals[i] * contact.internals[i];
  return std::sqrt(squares);
}

/// Adds the losses of a law, without those whose names another law has given already.
void add_losses(const LawTable& law, int /*dimension*/, std::vector<FieldInfo>& all) {
  for (const LossInfo& info : law.losses)
    if (const auto name = fmt::format("lost_{}", info.name);
        std::ranges::find(all, name, &FieldInfo::name) == all.end())
      all.push_back({name, info.unit, Item::contact, ValueKind::number,
                     fmt::format("since the start: {}", info.meaning), info.is_energy()});
}

template <class Laws>
std::vector<FieldInfo> of_laws(const Laws& laws, std::initializer_list<int> dimensions,
                               void (*add)(const LawTable&, int dimension, std::vector<FieldInfo>&)) {
  std::vector<FieldInfo> all;
  for (const int dimension : dimensions)
    for (const LawTable* law : laws) add(*law, dimension, all);
  return all;
}

/// Returns the laws of the contacts in the order in which the whole model has them: a collective.
std::vector<const LawTable*> laws_in_order(const Motion& motion) {
  const Model& model = motion.model();
  std::vector<const LawTable*> laws(motion.laws().begin(), motion.laws().end());
  constexpr int kNone = std::numeric_limits<int>::max();  // of a law that no contact here has
  std::vector<int> first(laws.size(), kNone);
  const LawTable* last = nullptr;
  for (int i = 0; i < model.contact_count(); ++i) {
    const LawTable* const law = &motion.law_of(i);
    if (std::exchange(last, law) == law) continue;
    int& of_law = first[std::ranges::find(laws, law) - laws.begin()];
    of_law = std::min(of_law, model.part ? model.part->contact[i] : i);
  }
  const std::vector<int> of_ranks = model.ranks().collect(first);
  for (std::size_t i = 0; i < of_ranks.size(); ++i)
    first[i % laws.size()] = std::min(first[i % laws.size()], of_ranks[i]);
  const auto place = [&](const LawTable* law) {
    return first[std::ranges::find(motion.laws(), law) - motion.laws().begin()];
  };
  std::erase_if(laws, [&](const LawTable* law) { return place(law) == kNone; });
  std::ranges::sort(laws, {}, place);
  return laws;
}

/// Writes the components of one field after the other.
template <class T>
void put_row(const std::vector<Field>& fields, FieldReader& reader, int item, T* row) {
  std::array<double, kMostComponents> value;
  for (const Field& field : fields) {
    const bool tells_itself =
        field.item == Item::gridpoint || field.name == "gone" || field.name == "crack_step";
    if (!tells_itself && reader.is_gone(field.item, item))
      value.fill(0.0);
    else
      field.read(reader, item, value.data());
    const int components = components_of(field.kind, reader.model().dimension());
    for (int c = 0; c < components; ++c) *row++ = static_cast<T>(value[c]);
  }
}

}  // namespace

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

int components_of(ValueKind kind, int dimension) {
  return kind == ValueKind::number ? 1 : kind == ValueKind::vector ? dimension : kMostComponents;
}

bool FieldReader::is_gone(Item item, int number) const {
  if (!simulation_.spalling()) return false;
  const auto gone = [&](int gridpoint) { return simulation_.is_gone(model().block_of(gridpoint)); };
  if (item == Item::gridpoint) return gone(number);
  if (item == Item::zone) return gone(model().gridpoints_of_zone(number)[0]);
  const Joint& joint =
      model().joint(item == Item::contact_end ? number / ends_of_contact(model().dimension()) : number);
  return gone(joint.a) || gone(joint.b);
}

const ContactState& FieldReader::contact(int contact) {
  if (std::exchange(contact_, contact) != contact) state_ = motion().read().contact(contact);
  return state_;
}

const std::vector<double>& FieldReader::heat_conductances() {
  const TemperatureField& field = simulation_.field();
  if (heat_conductances_.empty()) heat_conductances_ = field.conduction()->conductances(field.gridpoints());
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
  const int dimension = simulation.model().dimension();
  const auto laws = laws_in_order(simulation.motion());
  for (const FieldInfo& info : of_laws(laws, {dimension}, add_memory))
    all.push_back(
        {info, [name = info.name](R& r, int i, double* to) { *to = memory_of(r.contact(i), name); }});
  for (const KnownField& f : kOfContacts) add(f);
  for (const FieldInfo& info : of_laws(laws, {dimension}, add_losses))
    all.push_back({info, [name = info.name.substr(info.name.find('_') + 1)](R& r, int i, double* to) {
                     *to = r.contact(i).lost(name);
                   }});
  return all;
}

std::vector<FieldInfo> possible_fields() {
  std::vector<FieldInfo> all;
  for (const KnownField& f : kOfBlocks) all.push_back(info_of(f));
  all.push_back(info_of(kOfEnds));
  std::ranges::copy(of_laws(built_in_laws(), {2, 3}, add_memory), std::back_inserter(all));
  for (const KnownField& f : kOfContacts) all.push_back(info_of(f));
  std::ranges::copy(of_laws(built_in_laws(), {2, 3}, add_losses), std::back_inserter(all));
  std::ranges::copy(found_fields(), std::back_inserter(all));
  return all;
}

int width_of(const std::vector<Field>& fields, const Simulation& simulation) {
  int width = 0;
  for (const Field& field : fields) width += components_of(field.kind, simulation.model().dimension());
  return width;
}

void own_values_in_slices(
    const std::vector<Field>& fields, const Simulation& simulation,
    const std::function<void(std::int64_t first, const std::vector<float>& rows)>& take) {
  if (fields.empty()) return;
  FieldReader reader(simulation);
  in_own_slices<float>(
      fields.front().item, simulation.model(), width_of(fields, simulation),
      [&](int item, float* row) { put_row(fields, reader, item, row); }, take);
}

std::vector<std::vector<double>> values_of(const std::vector<Field>& fields, const Simulation& simulation) {
  std::vector<std::vector<double>> values(fields.size());
  if (fields.empty()) return values;
  FieldReader reader(simulation);
  in_slices(
      fields.front().item, simulation.model(), width_of(fields, simulation),
      [&](int item, double* row) { put_row(fields, reader, item, row); },
      [&](std::int64_t, const std::vector<double>& rows) {
        for (auto next = rows.begin(); next != rows.end();)
          for (std::size_t f = 0; f < fields.size(); ++f) {
            const auto end = next + components_of(fields[f].kind, simulation.model().dimension());
            values[f].insert(values[f].end(), next, end);
            next = end;
          }
      });
  return values;
}

}  // namespace pyroclast
