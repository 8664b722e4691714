#include "pyroclast/mechanics/found/pair_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pyroclast/base/place_in.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Bound of a gridpoint's share of critical damping over that of its block, the root of the ratio of their
/// masses.
constexpr double kGridpointDamping = 3.0;
/// Largest ratio between the sum of |stiffness| over a row of a contact's matrix and its larger stiffness,
/// whatever its direction: (1 + sqrt 2) / 2, where it has no shear stiffness.
constexpr double kOfAnyDirection = 1.2071067811865476;

}  // namespace

template <int Dim>
auto PairFacts<Dim>::places(const PairKey& key, const FlatArray<Vec<Dim>>& displacement) const -> Corners {
  const auto at = found_.corners(key);
  Corners places;
  for (int i = 0; i < 2 * Dim; ++i)
    places[i] = body_.model.position[at[i]] + displacement[body_.layout.gridpoint_slot[at[i]]];
  return places;
}

template <int Dim>
auto PairFacts<Dim>::places_of_forces(const PairKey& key) const -> Corners {
  const auto at = found_.corners(key);
  const Reader<Dim> read(body_);
  Corners places;
  for (int i = 0; i < 2 * Dim; ++i)
    places[i] = body_.model.position[at[i]] + read.displacement_of_force(at[i]);
  return places;
}

template <int Dim>
PairShape<Dim> PairFacts<Dim>::shape(const PairKey& key, const Corners& at) const {
  PairShape<Dim> shape;
  if constexpr (Dim == 2) {
    shape.p = edge_pair<double>({at[0], at[1]}, {at[2], at[3]}, found_.facets[key[0]].length,
                                found_.facets[key[1]].length);
    shape.points = shape.p.face ? 2 : 0;
  } else {
    const Overlap overlap = overlap_of(at);
    shape.points = overlap.count;
    if (shape.points > 0) shape.p = triangle_pair(overlap, triangle_a(at), triangle_b(at));
  }
  return shape;
}

template <int Dim>
std::uint32_t PairFacts<Dim>::joined_corners(const PairKey& key) const {
  if (found_.face_of(key) >= 0) return 0;
  const GridpointContacts& contacts = found_.at_gridpoint;
  const auto are_joined = [&](int a, int b) {
    for (int i = contacts.begin[a]; i < contacts.begin[a + 1]; ++i) {
      const auto& contact = body_.model.contacts[contacts.contact_side[i] / 2];
      if ((contact.a == b || contact.b == b) && !found_.is_handed_over[contact.face]) return true;
    }
    return false;
  };
  const auto at = found_.corners(key);
  std::uint32_t joined = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = Dim; j < 2 * Dim; ++j)
      if ((Dim == 3 || j == i + Dim) && are_joined(at[i], at[j]))
        joined |= 1U << static_cast<unsigned>(i) | 1U << static_cast<unsigned>(j);
  return joined;
}

template <int Dim>
double PairFacts<Dim>::way_to_press(const PairKey& key, const Corners& at, double within) const {
  const double most_depth = found_.most_depth_of(key);
  if constexpr (Dim == 3) {
    return pyroclast::way_to_press(triangle_a(at), triangle_b(at), most_depth, within);
  } else {
    const EdgePair<double> p = shape(key, at).p;
    if (!p.face) return std::max(-p.overlap, -p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
    const auto [least, most] = std::minmax(p.gap[0], p.gap[1]);
    return std::max(least, -most_depth - most);
  }
}

template <int Dim>
double PairFacts<Dim>::way_to_change(const FoundPair<Dim>& pair, const Corners& at, double within) const {
  if constexpr (Dim == 3) {
    // points of another overlap may take their rest from one and their offset from another
    double rest = 0.0, offset = 0.0;
    for (const PairPoint<Dim>& point : pair.points) {
      rest = std::max(rest, point.rest);
      offset = std::min(offset, point.offset);
    }
    return pyroclast::way_to_change(triangle_a(at), triangle_b(at), rest - offset, within);
  } else {
    const EdgePair<double> p = shape(pair.facets, at).p;
    double way = std::min(p.overlap, p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
    for (int k = 0; k < 2; ++k) way = std::min(way, p.gap[k] + pair.points[k].offset - pair.points[k].rest);
    return way;
  }
}

/// Returns the interface of a pair: that of its face; or that of a loose body, of two the one that the deck
/// names later; else that of the two materials.
template <int Dim>
int PairFacts<Dim>::interface_of(const PairKey& key) const {
  const auto& model = body_.model;
  if (const int face = found_.face_of(key); face >= 0)
    return model.contacts[model.face_contacts[face]].interface;
  const int a = found_.facets[key[0]].block, b = found_.facets[key[1]].block;
  if (const int interface = std::max(found_.of_body[a], found_.of_body[b]); interface >= 0) return interface;
  return found_.interfaces[model.block_material[a] * static_cast<int>(model.material_names.size()) +
                           model.block_material[b]];
}

template <int Dim>
std::array<int, kSetsOfPair<Dim>> PairFacts<Dim>::sets_of(const FoundPair<Dim>& pair) const {
  const auto& model = body_.model;
  const auto& of_contact = body_.properties.of_contact;
  std::array<int, kSetsOfPair<Dim>> sets;
  if (const int face = found_.face_of(pair.facets); face >= 0) {
    const int corner = Dim == 2 ? 0 : pair.facets[0] - found_.first_of_face[face] + 1;
    std::copy_n(of_contact.begin() + model.face_contacts[face] + corner, kSetsOfPair<Dim>, sets.begin());
    return sets;
  }
  const auto nearest = [&] {
    for (const int facet : pair.facets)
      if (const int face = found_.facets[facet].face; face >= 0)
        if (const int c = model.face_contacts[face]; model.contacts[c].interface == pair.interface)
          return of_contact[c];
    for (const int facet : pair.facets)
      for (const int c : found_.contacts_of_block[found_.facets[facet].block])
        if (model.contacts[c].interface == pair.interface) return of_contact[c];
    return set_of_interface(pair.interface);
  };
  sets.fill(nearest());
  return sets;
}

template <int Dim>
int PairFacts<Dim>::set_of_interface(int interface) const {
  if (!body_.properties.of_interface.empty()) return body_.properties.of_interface[interface];
  const int c = found_.first_contact[interface];
  return c < 0 ? -1 : body_.properties.of_contact[c];
}

template <int Dim>
FoundPair<Dim> PairFacts<Dim>::new_pair(const PairKey& key) const {
  FoundPair<Dim> pair;
  pair.facets = key;
  pair.interface = interface_of(key);
  pair.sets = sets_of(pair);
  pair.law = place_in(body_.laws, &body_.properties.contacts.law(pair.sets[0]));
  const LawOfRows& law = found_.arrays.laws[pair.law];
  for (int point = 0; point < kPointsOfPair<Dim>; ++point)
    pair.internals.insert(pair.internals.end(), law.broken, law.broken + law.internals);
  pair.lost.resize(static_cast<std::size_t>(law.losses));
  return pair;
}

template <int Dim>
double PairFacts<Dim>::damping_of(const PairKey& key, double stiffness) const {
  if (found_.parameters.damping == 0.0) return 0.0;
  double mass_of_area = std::numeric_limits<double>::infinity();
  for (const int facet : key) {
    const int block = found_.facets[facet].block;
    double mass = 0.0;
    for (int g = body_.model.block_gridpoints[block]; g < body_.model.block_gridpoints[block + 1]; ++g)
      mass += body_.mass[g];
    mass_of_area = std::min(mass_of_area, mass / found_.broadest[block]);
  }
  return 2.0 * found_.parameters.damping * std::sqrt(stiffness * mass_of_area);
}

template <int Dim>
void PairFacts<Dim>::add_stiffness(std::vector<double>& of_gridpoints) const {
  const auto& model = body_.model;
  const auto& sets = body_.properties.contacts;
  const auto& of_contact = body_.properties.of_contact;
  std::vector<double> of_set(static_cast<std::size_t>(sets.size()), -1.0),
      of_interface(model.interface_names.size());
  const auto stiffness_of_set = [&](int set) {
    if (of_set[set] < 0.0) {
      const auto k = sets[set].stiffness();
      of_set[set] = kOfAnyDirection * std::max(k.normal, k.shear);
    }
    return of_set[set];
  };
  const auto raise = [&](double& most, int set) { most = std::max(most, stiffness_of_set(set)); };
  for (int c = 0; c < model.contact_count(); ++c)
    raise(of_interface[model.contacts[c].interface], of_contact[c]);
  for (int i = 0; i < std::ssize(of_interface); ++i)
    if (const int set = set_of_interface(i); set >= 0) raise(of_interface[i], set);
  double of_bodies = 0.0;
  for (const int interface : found_.of_body)
    if (interface >= 0) of_bodies = std::max(of_bodies, of_interface[interface]);
  // Damping takes a share of the step. It is that of a block, whose gridpoints are lighter.
  const double share = kGridpointDamping * found_.parameters.damping,
               grown = share + std::sqrt(1.0 + share * share);
  const int materials = static_cast<int>(model.material_names.size());
  for (const BlockFacet<Dim>& facet : found_.facets) {
    // any block may meet any body
    double needed = of_bodies;
    for (int other = 0; other < materials; ++other)
      needed = std::max(
          needed, of_interface[found_.interfaces[model.block_material[facet.block] * materials + other]]);
    needed *= grown * grown;
    if (facet.face >= 0) needed -= stiffness_of_set(of_contact[model.face_contacts[facet.face]]);
    // the factor 2 counts the gridpoint itself and those across; each corner has its part of the facet
    if (needed > 0.0)
      for (const int g : facet.gridpoints)
        of_gridpoints[g] += 2.0 * needed * (1.0 / Dim) * facet.extent * model.thickness;
  }
}

template class PairFacts<2>;
template class PairFacts<3>;

}  // namespace pyroclast
