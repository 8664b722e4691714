#include "pyroclast/mechanics/properties.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

template <int Dim>
void Properties<Dim>::place() {
  const Reader<Dim> reader(body_);
  auto& packs = body_.arrays.zone_properties;
  std::vector<ZoneProperties> softened;
  if (!body_.creep_under_way.empty())
    for (int z = 0; z < body_.model.zone_count(); ++z) softened.push_back(reader.properties_of_zone(z));
  const std::vector<ZoneProperties>& zones =
      body_.creep_under_way.empty() ? body_.properties.zones : softened;
  const auto same = [](const ZoneProperties& a, const ZoneProperties& b) {
    return a.lambda == b.lambda && a.mu == b.mu && a.thermal_strain == b.thermal_strain;
  };
  bool by_bundle = true;
  for (int b = 0; b < body_.model.block_count() && by_bundle; ++b)
    for (int z = body_.model.block_zones[b]; z < body_.model.block_zones[b + 1]; ++z)
      by_bundle = by_bundle && same(zones[z], zones[body_.model.block_zones[b]]);
  body_.state.by_bundle = by_bundle;
  const std::size_t count =
      by_bundle ? body_.layout.bundles.size() : static_cast<std::size_t>(body_.layout.zone_packs);
  if (packs.size() != count) packs = body_.template made<ZonePropertyPack>(count);
  const auto place = [&](std::size_t pack, int lane, const ZoneProperties& p) {
    packs[pack].lambda[lane] = p.lambda;
    packs[pack].mu[lane] = p.mu;
    packs[pack].thermal_strain[lane] = p.thermal_strain;
  };
  if (by_bundle) {
    for (std::size_t b = 0; b < count; ++b)
      for (int lane = 0; lane < kLanes; ++lane)
        if (const int block = body_.layout.block_in(static_cast<int>(b), lane); block >= 0)
          place(b, lane, zones[body_.model.block_zones[block]]);
  } else {
    for (int z = 0; z < body_.model.zone_count(); ++z)
      place(body_.layout.zone_slot[z] / kLanes, body_.layout.zone_slot[z] % kLanes, zones[z]);
  }
  place_creep_strain();
  place_contact_properties();
}

template <int Dim>
void Properties<Dim>::place_creep_strain() {
  auto& packs = body_.arrays.creep_strain;
  const std::size_t count = body_.creeps() ? static_cast<std::size_t>(body_.layout.zone_packs) : 0;
  if (packs.size() != count) packs = body_.template made<TensorPack<Dim>>(count);
  for (std::size_t z = 0; z < body_.creep_strain.size(); ++z) {
    const int slot = body_.layout.zone_slot[z];
    for (std::size_t i = 0; i < body_.creep_strain[z].size(); ++i)
      packs[slot / kLanes].component[i][slot % kLanes] = body_.creep_strain[z][i];
  }
}

template <int Dim>
void Properties<Dim>::place_contact_properties() {
  auto& s = body_.arrays;
  const ContactSets& sets = body_.properties.contacts;
  const std::vector<int> set_of_faces = find_sets_of_faces();
  std::vector<int> first(static_cast<std::size_t>(sets.size()), -1);
  s.first_constant.resize(body_.layout.faces.size());
  std::size_t bytes = 0;
  for (std::size_t pack = 0; pack < set_of_faces.size(); ++pack) {
    const int set = set_of_faces[pack];
    if (first[set] < 0)
      first[set] = static_cast<int>(std::exchange(bytes, bytes + sets.law(set).constants_size));
    s.first_constant[pack] = first[set];
  }
  s.contact_constants.resize(bytes);
  for (int set = 0; set < sets.size(); ++set)
    if (first[set] >= 0) sets.derive(set, s.contact_constants.data() + first[set]);
  if (!std::ranges::all_of(s.one_set, std::identity())) place_own_constants();
  body_.refresh_views();
}

/// Returns the first set of each pack of faces, and marks the packs whose points share one set. Throws Error
/// where contacts of one interface have several laws.
template <int Dim>
std::vector<int> Properties<Dim>::find_sets_of_faces() {
  auto& one_set = body_.arrays.one_set;
  const ContactSets& sets = body_.properties.contacts;
  std::vector<int> set_of_faces(body_.layout.faces.size(), -1);
  one_set.resize(body_.layout.faces.size());
  std::fill(one_set.begin(), one_set.end(), true);
  for (int c = 0; c < body_.model.contact_count(); ++c) {
    const int pack = body_.layout.face_pack_of_point[body_.layout.contact_slot[c] / kLanes];
    const int set = body_.properties.of_contact[c];
    if (&sets.law(set) != &body_.law_of_pack(pack))
      throw Error(fmt::format(
          "contact {} of interface \"{}\" has the law \"{}\", others of it have \"{}\": contacts of "
          "one interface have one law, from the start of a run to its end",
          c, body_.model.interface_names[body_.model.contacts[c].interface], sets.law(set).name,
          body_.law_of_pack(pack).name));
    if (set_of_faces[pack] < 0) set_of_faces[pack] = set;
    if (set_of_faces[pack] != set) one_set[pack] = false;
  }
  return set_of_faces;
}

/// Places the constants of each contact point, for packs of faces whose points do not share one set.
template <int Dim>
void Properties<Dim>::place_own_constants() {
  auto& s = body_.arrays;
  const auto count = [&](int pack) { return body_.law_of_pack(pack).constant_count; };
  if (s.own_constants.empty()) {
    s.first_own_constant = FlatArray<int>(body_.layout.faces.size() + 1);
    for (int pack = 0; pack < body_.layout.face_packs(); ++pack)
      s.first_own_constant[pack + 1] =
          s.first_own_constant[pack] +
          (body_.layout.first_point_of(pack + 1) - body_.layout.first_point_of(pack)) * count(pack);
    s.own_constants =
        body_.template made<Line>(static_cast<std::size_t>(s.first_own_constant[body_.layout.face_packs()]));
  }
  for (int pack = 0; pack < body_.layout.face_packs(); ++pack) {  // so that idle lanes have constants too
    if (s.one_set[pack]) continue;
    for (int line = s.first_own_constant[pack]; line < s.first_own_constant[pack + 1]; line += count(pack))
      for (int lane = 0; lane < kLanes; ++lane)
        body_.law_of_pack(pack).numbers_of(s.contact_constants.data() + s.first_constant[pack],
                                           s.own_constants[line].number + lane, kLanes);
  }
  std::size_t most = 0;
  for (const LawTable* law : body_.laws) most = std::max(most, law->constants_size);
  FlatArray<std::byte> constants(most);
  for (int c = 0; c < body_.model.contact_count(); ++c) {
    const int slot = body_.layout.contact_slot[c], pack = body_.layout.face_pack_of_point[slot / kLanes];
    if (s.one_set[pack]) continue;
    body_.properties.contacts.derive(body_.properties.of_contact[c], constants.data());
    Line* const line = lines_of(body_.layout, s.own_constants, s.first_own_constant, c, count(pack));
    body_.law_of_pack(pack).numbers_of(constants.data(), line->number + slot % kLanes, kLanes);
  }
}

template <int Dim>
void Properties<Dim>::begin_creep(const std::vector<CreepIncrement>& creep) {
  const Reader<Dim> reader(body_);
  if (std::ranges::none_of(creep, [](const CreepIncrement& i) { return i.compliance != 0.0; })) return;
  body_.creep_under_way.resize(creep.size());
  for (int z = 0; z < body_.model.zone_count(); ++z) {
    CreepUnderWay<Dim>& zone = body_.creep_under_way[z];
    Rotation<double> rotation;
    zone.poisson = creep[z].poisson;
    zone.stress = reader.stress_in_own_frame(z, rotation);
    zone.split = creep_split<Dim>(creep[z], zone.stress);
  }
  // only now, because the stresses above still need the creep strains from before
  for (int z = 0; z < body_.model.zone_count(); ++z)
    for (std::size_t i = 0; i < body_.creep_strain[z].size(); ++i)
      body_.creep_strain[z][i] += body_.creep_under_way[z].split.known[i];
}

template <int Dim>
void Properties<Dim>::end_creep() {
  const Reader<Dim> reader(body_);
  const auto crept = [&](const CreepUnderWay<Dim>& zone, const SymmetricTensor<Dim>& stress) {
    auto strain = creep_direction<Dim>(stress, zone.poisson);
    for (double& component : strain) component *= zone.split.compliance;
    return strain;
  };
  std::vector<SymmetricTensor<Dim>> last(body_.creep_under_way.size());
  body_.books.creep_work += chunked_sum(body_.layout.chunks.zones, [&](int z) {
    const CreepUnderWay<Dim>& zone = body_.creep_under_way[z];
    Rotation<double> rotation;
    const auto stress = reader.stress_in_own_frame(z, rotation);
    last[z] = crept(zone, stress);
    SymmetricTensor<Dim> all, twice_mean;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = zone.split.known[i] + last[z][i];
      twice_mean[i] = zone.stress[i] + stress[i];
    }
    return energy_density<Dim>(twice_mean, all) * body_.geometry.volume[z];
  });
  for (int z = 0; z < body_.model.zone_count(); ++z)
    for (std::size_t i = 0; i < last[z].size(); ++i) body_.creep_strain[z][i] += last[z][i];
  body_.creep_under_way.clear();
}

template <int Dim>
bool Properties<Dim>::break_contact(int contact) {
  const LawTable& law = body_.law_of(contact);
  bool breaks = false;
  for (const auto what : {Remembers::tension_damage, Remembers::shear_damage, Remembers::mixed_damage})
    if (const int place = place_of(law, what, Dim); place >= 0) {
      lines_of(body_.layout, body_.arrays.internals, body_.arrays.first_internal, contact,
               law.internals(Dim).size())[place]
          .number[body_.layout.contact_slot[contact] % kLanes] = 1.0;
      breaks = true;
    }
  return breaks;
}

/// Shows the properties at the temperatures that were last handed over; the temperature field may be at
/// others by now.
template <int Dim>
void Properties<Dim>::visit_state(StateVisitor& visitor) {
  auto& creep_strain = body_.creep_strain;
  auto& under_way = body_.creep_under_way;
  visitor.visit_numbers("creep_strains", creep_strain, state::finite().of(creep_strain.size()));
  visitor.visit_numbers("creep_under_way", under_way);
  visitor.require(under_way.empty() || (body_.creeps() && under_way.size() == creep_strain.size()),
                  "creep_under_way", "does not have each zone, or nothing creeps");
  bool by_block = body_.state.by_bundle;
  visitor.visit("properties_by_block", by_block);
  std::vector<ZoneProperties> zones;
  if (by_block)
    for (int b = 0; b < body_.model.block_count(); ++b)
      zones.push_back(body_.properties.zones[body_.model.block_zones[b]]);
  else
    zones = body_.properties.zones;
  const int count = by_block ? body_.model.block_count() : body_.model.zone_count();
  visitor.visit_numbers("zone_properties", zones, state::finite().of(static_cast<std::size_t>(count)));

  ContactSets& sets = body_.properties.contacts;
  std::vector<int> laws, choices;
  std::vector<double> numbers;
  for (int set = 0; set < sets.size(); ++set) {
    laws.push_back(static_cast<int>(std::ranges::find(body_.laws, &sets.law(set)) - body_.laws.begin()));
    numbers.insert(numbers.end(), sets.numbers(set).begin(), sets.numbers(set).end());
    choices.insert(choices.end(), sets.choices(set).begin(), sets.choices(set).end());
  }
  visitor.visit("law_of_set", laws, state::index(body_.laws.size()));
  std::size_t number_count = 0, choice_count = 0;
  for (const int index : laws) {
    number_count += body_.laws.at(index)->properties.size();
    choice_count += body_.laws.at(index)->choices.size();
  }
  visitor.visit("numbers_of_sets", numbers, state::number().of(number_count));
  visitor.visit("choices_of_sets", choices, state::index(ChoiceInfo::kMostOptions).of(choice_count));
  visitor.visit("set_of_contact", body_.properties.of_contact,
                state::index(laws.size()).of(body_.model.contacts.size()));
  if (!visitor.replaces()) return;

  for (int b = 0; b < body_.model.block_count(); ++b)
    for (int z = body_.model.block_zones[b]; z < body_.model.block_zones[b + 1]; ++z)
      body_.properties.zones[z] = zones.at(by_block ? b : z);
  sets = {};
  auto number = numbers.begin();
  auto choice = choices.begin();
  for (const int index : laws) {
    const LawTable& law = *body_.laws.at(index);
    const auto last_number = number + static_cast<std::ptrdiff_t>(law.properties.size());
    const auto last_choice = choice + static_cast<std::ptrdiff_t>(law.choices.size());
    std::copy(number, last_number, sets.add(law, {choice, last_choice}).begin());
    if (visitor.checks()) sets.validate(sets.size() - 1, law.name);
    number = last_number;
    choice = last_choice;
  }
  place();
}

template class Properties<2>;
template class Properties<3>;

}  // namespace pyroclast
