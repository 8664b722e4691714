#include "pyroclast/mechanics/properties.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/mechanics/reader.hpp"
#include "pyroclast/model/item_halo.hpp"
#include "pyroclast/model/visit_contacts.hpp"

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
  place_pore_pressure();
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
void Properties<Dim>::place_pore_pressure() {
  const std::vector<double>& pressure = body_.properties.pore_pressure;
  auto& lines = body_.arrays.pore_pressure;
  if (!pressure.empty() && lines.empty()) lines = body_.template made<Line>(body_.layout.points.size());
  const std::vector<double>& opening = body_.properties.pore_opening;
  auto& openings = body_.arrays.pore_opening;
  if (!opening.empty() && openings.empty()) openings = body_.template made<Line>(body_.layout.points.size());
  body_.state.pore_reserve = body_.properties.pore_reserve;
  for (std::size_t c = 0; c < pressure.size(); ++c) {
    const int slot = body_.layout.contact_slot[c];
    lines[slot / kLanes].number[slot % kLanes] = pressure[c];
    if (!opening.empty()) openings[slot / kLanes].number[slot % kLanes] = opening[c];
  }
}

template <int Dim>
bool Properties<Dim>::creep_here(const std::vector<CreepIncrement>& creep) const {
  if (!body_.creeps()) return false;
  const auto [first, last] = body_.layout.chunks.zones.own();
  return std::any_of(creep.begin() + first, creep.begin() + last,
                     [](const CreepIncrement& i) { return i.compliance != 0.0; });
}

template <int Dim>
void Properties<Dim>::begin_creep(const std::vector<CreepIncrement>& creep) {
  const Reader<Dim> reader(body_);
  body_.creep_under_way.resize(creep.size());
  for (int z = 0; z < body_.model.zone_count(); ++z) {
    CreepUnderWay<Dim>& zone = body_.creep_under_way[z];
    Rotation<Dim> rotation;
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
typename Properties<Dim>::EndOfCreep Properties<Dim>::end_of_creep() const {
  const Reader<Dim> reader(body_);
  const auto crept = [&](const CreepUnderWay<Dim>& zone, const SymmetricTensor<Dim>& stress) {
    auto strain = creep_direction<Dim>(stress, zone.poisson);
    for (double& component : strain) component *= zone.split.compliance;
    return strain;
  };
  EndOfCreep end;
  end.strain.resize(body_.creep_under_way.size());
  end.work.keep(body_.layout.chunks.zones, [&](int z) {
    const CreepUnderWay<Dim>& zone = body_.creep_under_way[z];
    Rotation<Dim> rotation;
    const auto stress = reader.stress_in_own_frame(z, rotation);
    end.strain[z] = crept(zone, stress);
    SymmetricTensor<Dim> all, twice_mean;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = zone.split.known[i] + end.strain[z][i];
      twice_mean[i] = zone.stress[i] + stress[i];
    }
    return energy_density<Dim>(twice_mean, all) * body_.geometry.volume[z];
  });
  return end;
}

template <int Dim>
void Properties<Dim>::end_creep(const EndOfCreep& end) {
  for (int z = 0; z < body_.model.zone_count(); ++z)
    for (std::size_t i = 0; i < end.strain[z].size(); ++i) body_.creep_strain[z][i] += end.strain[z][i];
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
  const Chunks& chunks = body_.layout.chunks;
  Ranks& ranks = body_.model.ranks();
  if (body_.creeps()) {
    auto& under_way = body_.creep_under_way;
    bool creeps_now = !under_way.empty();
    visitor.visit_by_chunk("creep_strains", body_.creep_strain, chunks.zones);
    visitor.visit("creeps_now", creeps_now);
    under_way.resize(creeps_now ? body_.creep_strain.size() : 0);
    if (creeps_now) visitor.visit_by_chunk("creep_under_way", under_way, chunks.zones);
  }
  bool by_block = !ranks.any(!body_.state.by_bundle);
  visitor.visit("properties_by_block", by_block);
  std::vector<ZoneProperties> zones;
  if (by_block)
    for (int b = 0; b < body_.model.block_count(); ++b)
      zones.push_back(body_.properties.zones[body_.model.block_zones[b]]);
  else
    zones = body_.properties.zones;
  visitor.visit_by_chunk("zone_properties", zones, by_block ? chunks.blocks : chunks.zones);
  if (visitor.replaces())
    for (int b = 0; b < body_.model.block_count(); ++b)
      for (int z = body_.model.block_zones[b]; z < body_.model.block_zones[b + 1]; ++z)
        body_.properties.zones[z] = zones.at(by_block ? b : z);
  visit_contacts_sets(visitor);
  if (body_.has_pore_pressure())
    visit_contacts(visitor, "pore_pressure", body_.model, body_.properties.pore_pressure, state::number());
  if (!body_.properties.pore_opening.empty())
    visit_contacts(visitor, "pore_opening", body_.model, body_.properties.pore_opening, state::number());
  if (visitor.replaces()) place();
}

/// Shows the parameters of contacts: each chunk has the sets that occur in it, as it comes to them.
template <int Dim>
void Properties<Dim>::visit_contacts_sets(StateVisitor& visitor) {
  const ChunkList& chunks = body_.layout.chunks.contacts;
  const auto& contacts = body_.layout.contacts_by_chunk;
  ContactSets& sets = body_.properties.contacts;
  std::vector<int>& of_contact = body_.properties.of_contact;
  std::vector<int> set_by_chunk(contacts.size());  // numbers of the chunk's own sets
  std::vector<int> number_in_chunk(static_cast<std::size_t>(sets.size()), -1);
  std::vector<std::vector<int>> sets_of_chunk(static_cast<std::size_t>(chunks.count()));
  for (int chunk = 0; chunk < chunks.count(); ++chunk) {
    std::vector<int>& here = sets_of_chunk[chunk];
    for (int i = chunks[chunk]; i < chunks[chunk + 1]; ++i) {
      const int set = of_contact[contacts[i]];
      if (number_in_chunk[set] < 0) {
        number_in_chunk[set] = static_cast<int>(here.size());
        here.push_back(set);
      }
      set_by_chunk[i] = number_in_chunk[set];
    }
    for (const int set : here) number_in_chunk[set] = -1;
  }
  auto laws = ListByChunk<int>::of(chunks, [&](int chunk, std::vector<int>& list) {
    for (const int set : sets_of_chunk[chunk]) list.push_back(place_in(body_.laws, &sets.law(set)));
  });
  auto choices = ListByChunk<int>::of(chunks, [&](int chunk, std::vector<int>& list) {
    for (const int set : sets_of_chunk[chunk])
      list.insert(list.end(), sets.choices(set).begin(), sets.choices(set).end());
  });
  auto numbers = ListByChunk<double>::of(chunks, [&](int chunk, std::vector<double>& list) {
    for (const int set : sets_of_chunk[chunk])
      list.insert(list.end(), sets.numbers(set).begin(), sets.numbers(set).end());
  });
  visitor.visit_by_chunk("laws_of_sets", laws, chunks);
  visitor.visit_by_chunk("choices_of_sets", choices, chunks);
  visitor.visit_by_chunk("numbers_of_sets", numbers, chunks);
  visitor.visit_by_chunk("set_of_contact", set_by_chunk, chunks, state::at_least(0));
  std::vector<ContactProperties> of_interfaces;
  if (body_.parameters.found.is_on) of_interfaces = visit_sets_of_interfaces(visitor);
  if (!visitor.replaces()) return;

  sets = {};
  std::span<const int> next_law(laws.entries), next_choice(choices.entries);
  std::span<const double> next_number(numbers.entries);
  const auto take = [&](auto& rest, std::size_t count, const char* name) {
    visitor.require(count <= rest.size(), name, "are fewer than the laws have");
    const auto taken = rest.first(count);
    rest = rest.subspan(count);
    return taken;
  };
  laws.for_each(chunks, [&](int chunk, std::span<const int> of_chunk) {
    const int first = sets.size();
    for (const int index : of_chunk) {
      visitor.require(index >= 0 && index < std::ssize(body_.laws), "laws_of_sets",
                      "names a law that is not there");
      const LawTable& law = *body_.laws[index];
      add_set(visitor, law, take(next_choice, law.choices.size(), "choices_of_sets"),
              take(next_number, law.properties.size(), "numbers_of_sets"));
    }
    for (int i = chunks[chunk]; i < chunks[chunk + 1]; ++i) {
      visitor.require(set_by_chunk[i] < std::ssize(of_chunk), "set_of_contact",
                      "names a set that is not there");
      of_contact[contacts[i]] = first + set_by_chunk[i];
    }
  });
  visitor.require(next_choice.empty(), "choices_of_sets", "are more than the laws have");
  visitor.require(next_number.empty(), "numbers_of_sets", "are more than the laws have");
  for (std::size_t i = 0; i < of_interfaces.size(); ++i) {
    body_.properties.of_interface[i] = sets.size();
    sets.add(of_interfaces[i]);
  }
  if (body_.model.part) take_sets_from_owners();
}

/// Shows the numbers of the sets that interfaces have for found contacts, and returns these sets.
template <int Dim>
std::vector<ContactProperties> Properties<Dim>::visit_sets_of_interfaces(StateVisitor& visitor) {
  std::vector<ContactProperties> sets;
  for (const int set : body_.properties.of_interface) {
    ContactProperties& one = sets.emplace_back(body_.properties.contacts[set]);
    const std::string name = fmt::format("numbers_of_interface_{}", sets.size() - 1);
    const std::size_t count = one.numbers.size();
    visitor.visit(name, one.numbers, state::number().of(count));
    if (visitor.checks()) validate(one, body_.model.interface_names[sets.size() - 1]);
  }
  return sets;
}

/// Adds a set of parameters from a state.
template <int Dim>
void Properties<Dim>::add_set(const StateVisitor& visitor, const LawTable& law, std::span<const int> choices,
                              std::span<const double> numbers) {
  for (const int choice : choices)
    visitor.require(choice >= 0 && choice < ChoiceInfo::kMostOptions, "choices_of_sets",
                    "names an option that is not there");
  for (const double number : numbers)
    visitor.require(!std::isnan(number), "numbers_of_sets", "holds one that is no number");
  ContactSets& sets = body_.properties.contacts;
  std::ranges::copy(numbers, sets.add(law, {choices.begin(), choices.end()}).begin());
  if (visitor.checks()) sets.validate(sets.size() - 1, law.name);
}

/// Gives contacts of other ranks the parameters that their owners have.
template <int Dim>
void Properties<Dim>::take_sets_from_owners() {
  ContactSets& sets = body_.properties.contacts;
  std::size_t most = 0;
  for (const LawTable* law : body_.laws) most = std::max(most, law->choices.size() + law->properties.size());
  const std::size_t of_each = 1 + most;  // the law, its choices, its numbers
  const auto count = static_cast<std::size_t>(body_.model.contact_count());
  std::vector<double> all(of_each * count);
  const ChunkList::Items own = body_.layout.chunks.contacts.own();
  const auto entry = [&](int i) { return all.begin() + of_each * body_.layout.contacts_by_chunk[i]; };
  for (int i = own.first; i < own.last; ++i) {
    const int set = body_.properties.of_contact[body_.layout.contacts_by_chunk[i]];
    auto to = entry(i);
    *to++ = place_in(body_.laws, &sets.law(set));
    to = std::ranges::copy(sets.choices(set), to).out;
    std::ranges::copy(sets.numbers(set), to);
  }
  contact_halo(body_.model).spread(all.data(), of_each);
  std::map<std::vector<double>, int> set_of;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    if (own.first <= i && i < own.last) continue;
    const auto from = entry(i);
    const LawTable& law = *body_.laws[static_cast<std::size_t>(*from)];
    const auto choices = from + 1, numbers = choices + std::ssize(law.choices);
    const auto end = numbers + std::ssize(law.properties);
    const auto [set, is_new] = set_of.try_emplace(std::vector<double>(from, end), sets.size());
    body_.properties.of_contact[body_.layout.contacts_by_chunk[i]] = set->second;
    if (is_new) std::copy(numbers, end, sets.add(law, std::vector<int>(choices, numbers)).begin());
  }
}

template class Properties<2>;
template class Properties<3>;

}  // namespace pyroclast
