#include "pyroclast/mechanics/found/found_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/place_in.hpp"
#include "pyroclast/laws/common.hpp"
#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/found/carry_over.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/reader.hpp"
#include "pyroclast/model/loose_bodies.hpp"
#include "pyroclast/model/outline.hpp"

namespace pyroclast {

namespace {

/// Depth from which on the end of a pair does not count, over the height of the smaller block: the far sides
/// of two blocks that touch face each other too, as deep as both are high.
constexpr double kMostDepth = 0.25;
/// Depth over the length of an edge that counts as touching where blocks are placed.
constexpr double kTouching = 1e-6;
/// Cosine between the facets of a torn face below which its pairs begin anew: it leans, and does not spin on
/// its other side.
constexpr double kLeans = 0.5;
/// Way that the sides of a bearing slide on each other until it is handed over, over the size of its face.
constexpr double kSlidBearing = 0.1;
/// Bound of a change of gaps, overlaps and cosines over the reach, while gridpoints go that far.
constexpr double kMargin = 5.0;
/// Distance from the origin, over the mean edge, beyond which nothing meets any more.
constexpr double kFarthest = 1e5;
/// Steps to the end of lists of far pairs over those to the end of lists of near ones.
constexpr double kFarOverNear = 20.0;
/// Share of the steps and of the way to the end of lists of near pairs: in space a step looks longer at each
/// pair than in the plane, so that searches pay sooner.
template <int Dim>
constexpr double kOfNear = Dim == 2 ? 1.0 : 0.3;
/// Longest such ways: for far pairs over the mean edge, for near ones over those for far pairs.
constexpr double kLongestFar = 0.25, kLongestNear = 0.2;
/// Bound of a gridpoint's share of critical damping over that of its block, the root of the ratio of their
/// masses.
constexpr double kGridpointDamping = 3.0;
/// Largest ratio between the sum of |stiffness| over a row of a contact's matrix and its larger stiffness,
/// whatever its direction: (1 + sqrt 2) / 2, where it has no shear stiffness.
constexpr double kOfAnyDirection = 1.2071067811865476;

/// Returns the internal variables of a broken point that was never touched.
std::vector<double> broken_internals(const LawTable& law, int dim) {
  std::vector<double> internals(law.internals(dim).size());
  for (const Remembers what : kCrackModes)
    if (const int place = place_of(law, what, dim); place >= 0)
      internals[static_cast<std::size_t>(place)] = 1.0;
  return internals;
}

/// Tells whether points of a law never break.
bool never_breaks(const LawTable& law, int dim) {
  return std::ranges::none_of(kCrackModes, [&](Remembers what) { return place_of(law, what, dim) >= 0; });
}

/// Tells whether a broken point of a law lets go of what it pulls.
bool lets_go(const ContactProperties& properties, int dim) {
  auto internals = broken_internals(*properties.law, dim);
  std::vector<double> losses(properties.law->losses.size());
  const double open[3] = {1e-3, 0.0, 0.0};
  return properties.law->update(dim)(properties.constants().data(), open, internals.data(), losses.data())
             .normal_traction == 0.0;
}

/// Returns the corners of a pair of triangles as the kernel has them.
Triangle triangle_of(const TriangleCorners& corners, int first) {
  return {corners[first], corners[first + 1], corners[first + 2]};
}

Overlap overlap_at(const TriangleCorners& corners) {
  return overlap_of(triangle_of(corners, 0), triangle_of(corners, 3));
}

/// Pair of facets as searches and hand-overs see it.
template <int Dim>
struct PairShape;

template <>
struct PairShape<2> {
  EdgePair<double> p;

  PairShape(const std::array<Vec<2>, 4>& at, const BlockFacet<2>& a, const BlockFacet<2>& b)
      : p(edge_pair<double>({at[0], at[1]}, {at[2], at[3]}, a.length, b.length)) {}
  bool overlaps() const { return p.face; }
  double overlap() const { return p.overlap; }
  int points() const { return 2; }
  double gap(int k) const { return p.gap[k]; }
  double least_length() const { return std::min(p.length_a, p.length_b); }
  double cosine() const { return p.cosine; }
};

template <>
struct PairShape<3> {
  Overlap names;
  TrianglePair<double> p;
  double least = 0.0;

  PairShape(const TriangleCorners& at, const BlockFacet<3>& a, const BlockFacet<3>& b)
      : names(overlap_at(at)), least(std::min(a.length, b.length)) {
    if (names.count > 0) p = triangle_pair(names, triangle_of(at, 0), triangle_of(at, 3));
  }
  bool overlaps() const { return names.count > 0; }
  double overlap() const { return p.overlap; }
  int points() const { return names.count; }
  double gap(int k) const { return p.gap[k]; }
  double least_length() const { return least; }
  double cosine() const { return p.cosine; }
};

}  // namespace

// The data

template <int Dim>
void FoundContacts<Dim>::make(Body<Dim>& body) {
  if (!body.parameters.found.is_on) return;
  if (Dim == 2 && body.parameters.kinematics != Kinematics::finite)
    throw Error("contacts = found: blocks that meet others turn, which needs kinematics = finite");
  if (body.model.part && body.model.part->zones_of_whole != body.model.zone_count())
    throw Error("contacts = found: each rank must hold all blocks");  // a fault of the program
  body.found = std::make_unique<FoundData<Dim>>();
  FoundData<Dim>& found = *body.found;
  found.parameters = body.parameters.found;
  const auto& model = body.model;

  std::vector<LawOfRows> laws;
  for (const LawTable* table : body.laws) {
    LawOfRows& law = laws.emplace_back();
    const auto infos = table->internals(Dim);
    law.internals = static_cast<int>(infos.size());
    law.losses = static_cast<int>(table->losses.size());
    law.constants = table->constant_count;
    if (std::max(law.internals, law.losses) > LawOfRows::kMost)
      throw Error(
          fmt::format("contacts = found: the law \"{}\" has more than {} internal variables or losses",
                      table->name, LawOfRows::kMost));
    for (int i = 0; i < law.internals; ++i)
      if (std::string_view(infos[i].name) == info::held_jump.name)
        law.held_jump = i;
      else if (law.slip < 0 && std::string_view(infos[i].name) == info::slip.name)
        law.slip = i;
    std::ranges::copy(broken_internals(*table, Dim), law.broken);
  }
  found.arrays.laws = FlatArray<LawOfRows>(laws);

  const std::vector<int> block_of = gridpoint_blocks(model);
  const auto add_facet = [&](const std::array<int, Dim>& gridpoints, int face) {
    found.facets.push_back({.block = block_of[gridpoints[0]], .gridpoints = gridpoints, .face = face});
    BlockFacet<Dim>& facet = found.facets.back();
    const auto at = [&](int i) -> const Vec<Dim>& { return model.position[gridpoints[i % Dim]]; };
    for (int i = 0; i < (Dim == 2 ? 1 : Dim); ++i)
      facet.length = std::max(facet.length, norm(at(i + 1) - at(i)));
    if constexpr (Dim == 2)
      facet.extent = facet.length;
    else
      facet.extent = 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
  };
  for (const auto& face :
       pyroclast::outline(model, body.geometry, std::vector<bool>(model.block_count(), true)))
    add_facet(face.gridpoints, -1);
  found.face_of_lane.assign(body.layout.faces.size() * kLanes, -1);
  for (int face = 0; face < model.face_count(); ++face) {
    found.first_of_face.push_back(static_cast<int>(found.facets.size()));
    const int first = model.face_contacts[face], points = model.face_contacts[face + 1] - first;
    if constexpr (Dim == 2) {
      const auto &begin = model.contacts[first], &end = model.contacts[first + 1];
      add_facet({begin.a, end.a}, face);
      add_facet({end.b, begin.b}, face);
    } else {
      // the triangles of the fan from the first corner, as the zones have them; side b runs the other way
      // round
      const auto corner = [&](int i) -> const Contact<Dim>& { return model.contacts[first + i]; };
      for (int i = 1; i + 1 < points; ++i) add_facet({corner(0).a, corner(i).a, corner(i + 1).a}, face);
      for (int i = 1; i + 1 < points; ++i) add_facet({corner(0).b, corner(i + 1).b, corner(i).b}, face);
    }
    const int slot = body.layout.contact_slot[first];
    found.face_of_lane[kLanes * body.layout.face_pack_of_point[slot / kLanes] + slot % kLanes] = face;
  }
  found.first_of_face.push_back(static_cast<int>(found.facets.size()));
  found.is_handed_over.assign(static_cast<std::size_t>(model.face_count()), false);

  found.at_gridpoint = gridpoint_contacts(model);
  const auto blocks = static_cast<std::size_t>(model.block_count());
  if (model.part)
    for (const int chunk : model.chunks().of_items())
      found.rank_of_block.push_back(model.part->rank_of_chunk[chunk]);
  std::vector<double> longest(blocks);
  double sum = 0.0;
  for (const BlockFacet<Dim>& facet : found.facets) {
    longest[facet.block] = std::max(longest[facet.block], facet.length);
    sum += facet.length;
  }
  const double mean_edge = sum / static_cast<double>(std::max<std::size_t>(found.facets.size(), 1));
  found.mean_edge = mean_edge;
  std::vector<double> width(blocks, std::numeric_limits<double>::infinity());
  if constexpr (Dim == 3)
    for (const BlockFacet<Dim>& facet : found.facets) {
      const auto at = [&](int i) -> const Vec<Dim>& { return model.position[facet.gridpoints[i]]; };
      const Vec<Dim> area = cross(at(1) - at(0), at(2) - at(0)), normal = area * (1.0 / norm(area));
      double across = 0.0;
      for (int g = model.block_gridpoints[facet.block]; g < model.block_gridpoints[facet.block + 1]; ++g)
        across = std::max(across, dot(normal, at(0) - model.position[g]));
      width[facet.block] = std::min(width[facet.block], across);
    }
  found.most_depth.resize(blocks);
  found.broadest.resize(blocks);
  for (int b = 0; b < model.block_count(); ++b) {
    double volume = 0.0;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
      volume += body.geometry.volume[z] / model.thickness;
    found.broadest[b] = Dim == 2 ? longest[b] * model.thickness : volume / width[b];
    found.most_depth[b] = kMostDepth * (Dim == 2 ? volume / longest[b] : width[b]);
  }

  found.contacts_of_block.resize(blocks);
  found.first_contact.assign(model.interface_names.size(), -1);
  const int materials = static_cast<int>(model.material_names.size());
  constexpr int kNone = -1, kSeveral = -2;
  found.interfaces.assign(static_cast<std::size_t>(materials * materials), kNone);
  for (int c = 0; c < model.contact_count(); ++c) {
    const Joint& contact = model.joint(c);
    const int a = block_of[contact.a], b = block_of[contact.b];
    for (const int block : {a, b}) found.contacts_of_block[block].push_back(c);
    if (found.first_contact[contact.interface] < 0) found.first_contact[contact.interface] = c;
    const int of_a = model.block_material[a], of_b = model.block_material[b];
    for (const int pair : {of_a * materials + of_b, of_b * materials + of_a}) {
      int& interface = found.interfaces[pair];
      if (interface == kNone) interface = contact.interface;
      if (interface != contact.interface) interface = kSeveral;
    }
  }
  std::vector<bool> serves(model.interface_names.size());
  for (int i = 0; i < std::ssize(serves); ++i)
    if (const int set = FoundContacts(body).set_of_interface(i); set >= 0)
      serves[i] = lets_go(body.properties.contacts[set], Dim);
  std::vector<bool> only_bears(blocks, true);
  for (int face = 0; face < model.face_count(); ++face) {
    const Joint& contact = model.contacts[model.face_contacts[face]];
    const int set = FoundContacts(body).set_of_interface(contact.interface);
    if (serves[contact.interface] && never_breaks(body.properties.contacts.law(set), Dim))
      found.bearings.push_back(face);
    else
      only_bears[block_of[contact.a]] = only_bears[block_of[contact.b]] = false;
  }
  for (BlockFacet<Dim>& facet : found.facets)
    facet.is_free = facet.begins_free = facet.face < 0 || only_bears[facet.block];
  found.of_body = interfaces_of_loose_bodies(model);
  const std::string& name = found.parameters.like;
  const int like = name.empty() ? 0 : place_in(model.interface_names, name);
  if (like >= std::ssize(serves))
    throw Error(fmt::format("contacts = found: there is no interface \"{}\"", name));
  for (int& interface : found.interfaces) {
    if (interface >= 0 && serves[interface]) continue;
    if (!serves[like])
      throw Error(fmt::format(
          "contacts = found: the law of the interface \"{}\" does not let go of what it pulls once "
          "it is broken, or none of its contacts is in the body",
          model.interface_names[like]));
    interface = like;
  }

  const auto slots = static_cast<std::size_t>(body.layout.gridpoint_packs) * kLanes;
  found.block_of_slot.resize(slots);
  for (int g = 0; g < model.gridpoint_count(); ++g)
    found.block_of_slot[body.layout.gridpoint_slot[g]] = block_of[g];
  found.arrays.searched = body.template made<Vec<Dim>>(slots);
  found.searched_far = body.template made<Vec<Dim>>(slots);
  body.state.found = &found.seen;
}

template <int Dim>
Vec<Dim> FoundContacts<Dim>::place(int gridpoint, const FlatArray<Vec<Dim>>& displacement) const {
  return body_.model.position[gridpoint] + displacement[body_.layout.gridpoint_slot[gridpoint]];
}

/// Returns the gridpoints of a pair: those of facet a, then those of facet b the other way round.
template <int Dim>
std::array<int, 2 * Dim> FoundContacts<Dim>::corners(const Key& key) const {
  const auto &a = found_.facets[key[0]].gridpoints, &b = found_.facets[key[1]].gridpoints;
  if constexpr (Dim == 2)
    return {a[0], a[1], b[1], b[0]};
  else
    return {a[0], a[1], a[2], b[0], b[2], b[1]};
}

/// \param place  returns the place of a gridpoint, m
template <int Dim>
template <class Place>
typename FoundContacts<Dim>::Corners FoundContacts<Dim>::places(const Key& key, Place place) const {
  const auto at = corners(key);
  Corners places;
  for (int i = 0; i < 2 * Dim; ++i) places[i] = place(at[i]);
  return places;
}

template <int Dim>
PairShape<Dim> shape_of(const FoundData<Dim>& found, const FoundPair<Dim>& pair,
                        const std::array<Vec<Dim>, 2 * Dim>& at) {
  return {at, found.facets[pair.facets[0]], found.facets[pair.facets[1]]};
}

template <int Dim>
double FoundContacts<Dim>::most_depth(const Key& key) const {
  return std::min(found_.most_depth[found_.facets[key[0]].block],
                  found_.most_depth[found_.facets[key[1]].block]);
}

/// Tells whether a contact that is not handed over joins two gridpoints.
template <int Dim>
bool FoundContacts<Dim>::holds_together(int a, int b) const {
  const GridpointContacts& at = found_.at_gridpoint;
  for (int i = at.begin[a]; i < at.begin[a + 1]; ++i) {
    const auto& contact = body_.model.contacts[at.contact_side[i] / 2];
    if ((contact.a == b || contact.b == b) && !found_.is_handed_over[contact.face]) return true;
  }
  return false;
}

/// Returns the bits of the corners of a pair that a contact still joins to a corner across, at the mouth of a
/// notch or the root of a crack: the contact presses there alone.
template <int Dim>
std::uint32_t FoundContacts<Dim>::joined_corners(const Key& key) const {
  if (face_of(key) >= 0) return 0;
  const auto at = corners(key);
  std::uint32_t joined = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = Dim; j < 2 * Dim; ++j)
      if ((Dim == 3 || j == i + Dim) && holds_together(at[i], at[j]))
        joined |= 1U << static_cast<unsigned>(i) | 1U << static_cast<unsigned>(j);
  return joined;
}

/// Returns the interface of a pair: that of its face; or that of a loose body, of two the one that the deck
/// names later; else that of the two materials.
template <int Dim>
int FoundContacts<Dim>::interface_of(const Key& key) const {
  if (const int face = face_of(key); face >= 0)
    return body_.model.contacts[body_.model.face_contacts[face]].interface;
  const auto of_body = [&](int facet) { return found_.of_body[found_.facets[facet].block]; };
  if (const int interface = std::max(of_body(key[0]), of_body(key[1])); interface >= 0) return interface;
  const auto material = [&](int facet) { return body_.model.block_material[found_.facets[facet].block]; };
  return found_
      .interfaces[material(key[0]) * static_cast<int>(body_.model.material_names.size()) + material(key[1])];
}

/// Returns the face whose two sides a pair is; -1 for other pairs.
template <int Dim>
int FoundContacts<Dim>::face_of(const Key& key) const {
  const int face = found_.facets[key[0]].face;
  return found_.facets[key[1]].face == face ? face : -1;
}

/// Tells whether no contact of the beginning joins the facets of a pair.
template <int Dim>
bool FoundContacts<Dim>::may_meet(const Key& key) const {
  const int face = face_of(key);
  return face < 0 || found_.is_handed_over[face];
}

/// Returns a set of parameters of a pair: that of a contact of its own face; else that of the nearest contact
/// of the interface, so that the pair has the temperature of its place.
///
/// \param contact  contact of the face
template <int Dim>
int FoundContacts<Dim>::set_of(const Pair& pair, int contact) const {
  const auto& model = body_.model;
  const auto& of_contact = body_.properties.of_contact;
  const BlockFacet<Dim>&first = found_.facets[pair.facets[0]], &second = found_.facets[pair.facets[1]];
  if (const int face = face_of(pair.facets); face >= 0)
    return of_contact[model.face_contacts[face] + contact];
  const int interface = pair.interface;
  for (const BlockFacet<Dim>& facet : {first, second})
    if (facet.face >= 0)
      if (const int c = model.face_contacts[facet.face]; model.contacts[c].interface == interface)
        return of_contact[c];
  for (const BlockFacet<Dim>& facet : {first, second})
    for (const int c : found_.contacts_of_block[facet.block])
      if (model.contacts[c].interface == interface) return of_contact[c];
  return set_of_interface(interface);
}

/// Returns the sets of parameters of a pair; in space of a face that is handed over that of the contact at
/// the second corner of the first facet.
template <int Dim>
std::array<int, kSetsOfPair<Dim>> FoundContacts<Dim>::sets_of(const Pair& pair) const {
  if constexpr (Dim == 2) {
    return {set_of(pair, 0), set_of(pair, 1)};
  } else {
    const int face = face_of(pair.facets);
    return {set_of(pair, face < 0 ? 0 : pair.facets[0] - found_.first_of_face[face] + 1)};
  }
}

/// Returns the set of an interface at no special place; -1 where the body has none.
template <int Dim>
int FoundContacts<Dim>::set_of_interface(int interface) const {
  if (!body_.properties.of_interface.empty()) return body_.properties.of_interface[interface];
  const int c = found_.first_contact[interface];
  return c < 0 ? -1 : body_.properties.of_contact[c];
}

template <int Dim>
const LawTable& FoundContacts<Dim>::law_of(const Pair& pair) const {
  return body_.properties.contacts.law(pair.sets[0]);
}

template <int Dim>
int FoundContacts<Dim>::law_index(const Pair& pair) const {
  return place_in(body_.laws, &law_of(pair));
}

template <int Dim>
FoundPair<Dim> FoundContacts<Dim>::new_pair(const Key& key) const {
  Pair pair;
  pair.facets = key;
  pair.interface = interface_of(key);
  pair.sets = sets_of(pair);
  pair.law = law_index(pair);
  const LawOfRows& law = found_.arrays.laws[pair.law];
  for (int point = 0; point < kPointsOfPair<Dim>; ++point)
    pair.internals.insert(pair.internals.end(), law.broken, law.broken + law.internals);
  pair.lost.resize(static_cast<std::size_t>(law.losses));
  return pair;
}

/// Returns the coefficient of damping of a pair, Pa s/m: the share of 2 sqrt(K_n m / A) that the parameters
/// ask for, with the mass of the smaller block over its longest facet.
template <int Dim>
double FoundContacts<Dim>::damping_of(const Pair& pair, double stiffness) const {
  if (found_.parameters.damping == 0.0) return 0.0;
  double mass_of_area = std::numeric_limits<double>::infinity();
  for (const int facet : pair.facets) {
    const int block = found_.facets[facet].block;
    double mass = 0.0;
    for (int g = body_.model.block_gridpoints[block]; g < body_.model.block_gridpoints[block + 1]; ++g)
      mass += body_.mass[g];
    mass_of_area = std::min(mass_of_area, mass / found_.broadest[block]);
  }
  return 2.0 * found_.parameters.damping * std::sqrt(stiffness * mass_of_area);
}

template <int Dim>
void FoundContacts<Dim>::add_stiffness(std::vector<double>& of_gridpoints) const {
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
  for (int c = 0; c < model.contact_count(); ++c) {
    double& most = of_interface[model.contacts[c].interface];
    most = std::max(most, stiffness_of_set(of_contact[c]));
  }
  for (int i = 0; i < std::ssize(of_interface); ++i)
    if (const int set = set_of_interface(i); set >= 0)
      of_interface[i] = std::max(of_interface[i], stiffness_of_set(set));
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

// The search

template <int Dim>
void FoundContacts<Dim>::begin() {
  search();
  leave_out_overlaps(std::vector<bool>(found_.facets.size(), true), kTouching);
  make_rows();
}

template <int Dim>
void FoundContacts<Dim>::take_from_owners() {
  Ranks& ranks = body_.model.ranks();
  if (ranks.count() == 1 || found_.knows_all) return;
  struct Moved {
    Vec<Dim> displacement, velocity;
  };
  const auto [first, last] = body_.layout.chunks.gridpoints.own();
  const Reader<Dim> read(body_);
  std::vector<Moved> own;
  for (int g = first; g < last; ++g) own.push_back({read.displacement(g), read.velocity(g)});
  const std::vector<Moved> all = ranks.collect(own);
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    body_.arrays.displacement[slot] = all[g].displacement;
    set_vector<Dim>(body_.state.velocity, slot, all[g].velocity);
  }
  found_.knows_all = true;
}

template <int Dim>
std::map<int, SharedGridpoints> FoundContacts<Dim>::shared_gridpoints() const {
  std::map<int, SharedGridpoints> shared;
  const int me = body_.model.ranks().me();
  for (const Pair& pair : found_.pairs) {
    if (pair.slot < 0) continue;
    const BlockFacet<Dim>&a = found_.facets[pair.facets[0]], &b = found_.facets[pair.facets[1]];
    const int of_a = found_.rank_of_block[a.block], of_b = found_.rank_of_block[b.block];
    if (of_a == of_b) continue;
    SharedGridpoints& with = shared[of_a == me ? of_b : of_a];
    (of_a == me ? with.own : with.foreign).insert(a.gridpoints.begin(), a.gridpoints.end());
    (of_b == me ? with.own : with.foreign).insert(b.gridpoints.begin(), b.gridpoints.end());
  }
  return shared;
}

/// Tells whether a pair touches a block of this rank.
template <int Dim>
bool FoundContacts<Dim>::is_own(const Key& key) const {
  if (found_.rank_of_block.empty()) return true;
  const int me = body_.model.ranks().me();
  return found_.rank_of_block[found_.facets[key[0]].block] == me ||
         found_.rank_of_block[found_.facets[key[1]].block] == me;
}

template <int Dim>
void FoundContacts<Dim>::search_where_needed() {
  const auto watched = static_cast<int>(found_.arrays.watched.size());
  found_.seen.way = found_.has_near ? body_.step.passes.way_of_found(body_.state, 0, watched) : 0.0;
  if (found_.has_near) found_.seen.way = body_.model.ranks().largest(found_.seen.way);
  if (!found_.has_near || !(found_.seen.way <= 1.0)) {
    search();
    found_.seen.way = 0.0;
  }
  if (!found_.has_rows) make_rows();
}

/// Finds the near pairs, and first the far ones where they are not known any more. Rows stay where they hold
/// the same pairs.
template <int Dim>
void FoundContacts<Dim>::search() {
  take_back();
  take_from_owners();
  for (std::size_t f = 0; found_.has_far && f < found_.facets.size(); ++f)
    for (const int g : found_.facets[f].gridpoints) {
      if (!found_.is_listed[f]) break;
      const int slot = body_.layout.gridpoint_slot[g];
      const Vec<Dim> way = body_.arrays.displacement[slot] - found_.searched_far[slot];
      const double most = 0.5 * found_.skin[found_.facets[f].block];
      found_.has_far = found_.has_far && dot(way, way) <= most * most;
    }
  if (!found_.has_far) find_far();
  if (find_near())
    found_.has_rows = false;
  else if (found_.has_rows)
    let_sleep();
  watch();
}

/// Returns twice the way that each block's fastest gridpoint goes in some steps, m.
/// \param least, most  bounds, m
template <int Dim>
std::vector<double> FoundContacts<Dim>::ways(double steps, double least, double most) const {
  std::vector<double> ways(found_.broadest.size(), least);
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    const double way = 2.0 * steps * body_.state.time_step * norm(vector_at<Dim>(body_.state.velocity, slot));
    double& of_block = ways[found_.block_of_slot[slot]];
    if (!(way <= of_block)) of_block = way < most ? way : most;
  }
  return ways;
}

/// Returns the box of a facet at the search for far pairs, grown by half of the largest distance of a pair
/// that counts before the next such search; none for a facet that has flown off, or has no number.
template <int Dim>
std::optional<typename FoundContacts<Dim>::Box> FoundContacts<Dim>::box_of(int index) const {
  const BlockFacet<Dim>& facet = found_.facets[index];
  Box box;
  double farthest = 0.0;
  for (int k = 0; k < Dim; ++k) {
    const Vec<Dim> at = place(facet.gridpoints[k], found_.searched_far);
    for (int i = 0; i < Dim; ++i) {
      box.low[i] = k == 0 ? at[i] : std::min(box.low[i], at[i]);
      box.high[i] = k == 0 ? at[i] : std::max(box.high[i], at[i]);
      if (!(std::abs(at[i]) <= farthest)) farthest = std::abs(at[i]);
    }
  }
  if (!(farthest < kFarthest * found_.mean_edge)) return {};
  const double grow =
      0.5 * ((1.0 + kMargin * kLongestNear) * found_.skin[facet.block] + found_.most_depth[facet.block]);
  for (int i = 0; i < Dim; ++i) {
    box.low[i] -= grow;
    box.high[i] += grow;
  }
  return box;
}

/// Lists a pair of free facets as far where their boxes meet and it may press before the next such search.
template <int Dim>
void FoundContacts<Dim>::list_if_far(int a, const Box& box_a, int b, const Box& box_b) {
  if (found_.facets[a].block == found_.facets[b].block || !may_meet({a, b}) || !is_own({a, b})) return;
  for (int k = 0; k < Dim; ++k)
    if (box_a.low[k] > box_b.high[k] || box_b.low[k] > box_a.high[k]) return;
  const Key key{std::min(a, b), std::max(a, b)};
  const Corners at = places(key, [&](int g) { return place(g, found_.searched_far); });
  const double skin = std::max(found_.skin[found_.facets[a].block], found_.skin[found_.facets[b].block]);
  const double within = kMargin * (1.0 + kLongestNear) * skin;
  const double way = way_to_press(key, at, within);
  if (way < within) found_.far.push_back({key, way / kMargin});
}

template <int Dim>
void FoundContacts<Dim>::sort_far() {
  std::sort(found_.far.begin(), found_.far.end());
  found_.far.erase(std::unique(found_.far.begin(), found_.far.end()), found_.far.end());
}

/// Lists the far pairs of free facets.
template <int Dim>
void FoundContacts<Dim>::find_far() {
  found_.skin = ways(kFarOverNear * found_.parameters.steps, found_.parameters.skin * found_.mean_edge,
                     std::max(kLongestFar, found_.parameters.skin) * found_.mean_edge);
  found_.searched_far = body_.arrays.displacement;
  std::vector<int> free;
  std::vector<Box> boxes;
  double sum = 0.0;
  found_.is_listed.assign(found_.facets.size(), false);
  for (int f = 0; f < std::ssize(found_.facets); ++f) {
    if (!found_.facets[f].is_free) continue;
    const auto box = box_of(f);
    if (!box) continue;
    found_.is_listed[f] = true;
    free.push_back(f);
    boxes.push_back(*box);
    sum += found_.facets[f].length;
  }
  // cells of a grid, with the facets whose boxes reach into them
  const double cell = free.empty() ? 1.0 : 2.0 * sum / static_cast<double>(free.size());
  struct Entry {
    std::array<int, Dim> cell;
    int facet;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  const auto cell_of = [&](double x) { return static_cast<int>(std::floor(x / cell)); };
  for (int i = 0; i < std::ssize(free); ++i) {
    std::array<int, Dim> first, last;
    for (int k = 0; k < Dim; ++k) {
      first[k] = cell_of(boxes[i].low[k]);
      last[k] = cell_of(boxes[i].high[k]);
    }
    for (std::array<int, Dim> at = first;;) {
      entries.push_back({at, i});
      int k = Dim - 1;
      while (k >= 0 && at[k] == last[k]) {
        at[k] = first[k];
        --k;
      }
      if (k < 0) break;
      ++at[k];
    }
  }
  std::sort(entries.begin(), entries.end());
  found_.far.clear();
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = i + 1; j < entries.size() && entries[i].cell == entries[j].cell; ++j) {
      const int a = entries[i].facet, b = entries[j].facet;
      list_if_far(free[a], boxes[a], free[b], boxes[b]);
    }
  sort_far();
  found_.has_far = true;
}

/// Adds facets that have just become free to the lists of far pairs that hold.
template <int Dim>
void FoundContacts<Dim>::add_to_far(const std::vector<int>& facets) {
  if (!found_.has_far) return;
  for (const int a : facets) {
    const auto box = box_of(a);
    if (!box) continue;
    found_.is_listed[a] = true;
    for (int b = 0; b < std::ssize(found_.facets); ++b)
      if (found_.is_listed[b]) list_if_far(a, *box, b, *box_of(b));
  }
  sort_far();
}

/// Lists the packs of gridpoints of free facets, and the ways that these may go.
template <int Dim>
void FoundContacts<Dim>::watch() {
  std::vector<WatchedPack> watched;
  std::vector<int> entry(static_cast<std::size_t>(body_.layout.gridpoint_packs), -1);
  std::vector<bool> is_watched(found_.block_of_slot.size());
  for (std::size_t f = 0; f < found_.facets.size(); ++f)
    if (found_.is_listed[f])
      for (const int g : found_.facets[f].gridpoints) is_watched[body_.layout.gridpoint_slot[g]] = true;
  const auto [first, last] = body_.layout.chunks.bundles.own();
  const auto begin = [&](int bundle) {
    return bundle < std::ssize(body_.layout.bundles) ? body_.layout.bundles[bundle].first_pack
                                                     : body_.layout.gridpoint_packs;
  };
  for (int pack = begin(first); pack < begin(last); ++pack) {
    WatchedPack of_pack{{}, pack};
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int slot = slot_of(pack, lane);
      if (!is_watched[slot]) continue;
      const double most = 0.5 * found_.reach[found_.block_of_slot[slot]];
      of_pack.over_way.number[lane] = 1.0 / (most * most);
      any = true;
    }
    if (any) watched.push_back(of_pack);
  }
  found_.arrays.watched = FlatArray<WatchedPack>(watched);
  see(found_.seen, found_.arrays);
}

/// Returns how far the corners of a pair that does not press must go at least until it may, m, but for
/// kMargin; 0 or less where it may at once.
/// \param within  largest way that is asked for, times kMargin, m
template <int Dim>
double FoundContacts<Dim>::way_to_press(const Key& key, const Corners& at, double within) const {
  if constexpr (Dim == 3) {
    return pyroclast::way_to_press(triangle_of(at, 0), triangle_of(at, 3), most_depth(key), within);
  } else {
    const EdgePair<double> p = PairShape<2>(at, found_.facets[key[0]], found_.facets[key[1]]).p;
    if (!(p.overlap > 0.0) || !(p.cosine > 0.0))
      return std::max(-p.overlap, -p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
    const auto [least, most] = std::minmax(p.gap[0], p.gap[1]);
    return std::max(least, -most_depth(key) - most);
  }
}

/// Returns the same of a pair that is handed over and rests: until a point goes through the law, or until its
/// facets may leave each other.
template <int Dim>
double FoundContacts<Dim>::way_to_change(const Pair& pair, const Corners& at, double within) const {
  if constexpr (Dim == 3) {
    // points of another overlap may take their rest from one and their offset from another
    double rest = 0.0, offset = 0.0;
    for (const PairPoint<Dim>& point : pair.points) {
      rest = std::max(rest, point.rest);
      offset = std::min(offset, point.offset);
    }
    return pyroclast::way_to_change(triangle_of(at, 0), triangle_of(at, 3), rest - offset, within);
  } else {
    const EdgePair<double> p = shape_of(found_, pair, at).p;
    double way = std::min(p.overlap, p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
    for (int k = 0; k < 2; ++k) way = std::min(way, p.gap[k] + pair.points[k].offset - pair.points[k].rest);
    return way;
  }
}

/// Returns FoundPair::wakes of a pair that does not press; 1 or more where it cannot before the next search.
/// \param handed_over  the pair where it is handed over, else null
template <int Dim>
double FoundContacts<Dim>::wakes(const Key& key, const Pair* handed_over) const {
  const Corners at = places(key, [&](int g) { return place(g, body_.arrays.displacement); });
  const double reach =
      std::max(found_.reach[found_.facets[key[0]].block], found_.reach[found_.facets[key[1]].block]);
  const double within = kMargin * reach;
  const double way = handed_over ? way_to_change(*handed_over, at, within) : way_to_press(key, at, within);
  const double share = way / within;
  return share > 0.0 ? share * share : 0.0;
}

/// Lets rows and gridpoints sleep while no pair of theirs can press.
template <int Dim>
void FoundContacts<Dim>::let_sleep() {
  auto& arrays = found_.arrays;
  for (FoundRow<Dim>& row : arrays.rows) row.wakes = std::numeric_limits<double>::max();
  for (const Pair& pair : found_.pairs)
    if (pair.slot >= 0) {
      double& wakes = arrays.rows[pair.slot / kLanes].wakes;
      wakes = std::min(wakes, pair.wakes);
    }
  for (LoadedGridpoint& gridpoint : arrays.loaded) {
    gridpoint.wakes = std::numeric_limits<double>::max();
    for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k)
      gridpoint.wakes = std::min(gridpoint.wakes, arrays.rows[arrays.acting[k] / (2 * Dim * kLanes)].wakes);
  }
}

/// Lists the pairs that are near, in rows or not, and those that remember something. Returns whether there
/// are near ones that stand in no row.
template <int Dim>
bool FoundContacts<Dim>::find_near() {
  const FoundParameters& p = found_.parameters;
  std::vector<double> reach =
      ways(kOfNear<Dim> * p.steps, kOfNear<Dim> * p.reach * found_.mean_edge, found_.mean_edge);
  for (std::size_t b = 0; b < reach.size(); ++b) reach[b] = std::min(reach[b], kLongestNear * found_.skin[b]);
  found_.reach = std::move(reach);
  std::vector<Pair> next;
  next.reserve(found_.pairs.size());
  bool others = false;
  auto old = found_.pairs.begin();
  std::vector<double> gone(found_.broadest.size());  // way of each block since the search for far pairs, m
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    double& of_block = gone[found_.block_of_slot[slot]];
    of_block = larger(of_block, norm(body_.arrays.displacement[slot] - found_.searched_far[slot]));
  }
  // Tells whether a pair that was far may be near.
  const auto may_be_near = [&](const FarPair& far) {
    double way = 0.0, reach_of_pair = 0.0;
    for (const int facet : far.facets) {
      way = larger(way, 2.0 * gone[found_.facets[facet].block]);
      reach_of_pair = larger(reach_of_pair, found_.reach[found_.facets[facet].block]);
    }
    return !(far.way >= way + reach_of_pair);
  };
  const auto keep_old = [&](bool is_far) {
    if (old->presses())
      old->wakes = 0.0;
    else if (old->is_handed_over || is_far)
      old->wakes = wakes(old->facets, old->is_handed_over ? &*old : nullptr);
    else
      old->wakes = 1.0;
    old->is_near = old->wakes < 1.0;
    others = others || (old->is_near && old->slot < 0);
    if (old->is_near || old->slot >= 0 || old->remembers() || old->has_lost())
      next.push_back(std::move(*old));
    ++old;
  };
  for (const FarPair& far : found_.far) {
    while (old != found_.pairs.end() && old->facets < far.facets) keep_old(false);
    if (old != found_.pairs.end() && old->facets == far.facets) {
      keep_old(may_be_near(far));
    } else if (!may_be_near(far)) {
      continue;
    } else if (const double share = wakes(far.facets, nullptr); share < 1.0) {
      next.push_back(new_pair(far.facets));
      next.back().wakes = share;
      others = true;
    }
  }
  while (old != found_.pairs.end()) keep_old(false);
  // All ranks make rows anew at the same time, so that two of them have the same pairs in rows.
  if (found_.has_rows) others = body_.model.ranks().any(others);
  // while no pair is to come into a row, those that are near no more sleep in theirs
  if (others)
    std::erase_if(next,
                  [](const Pair& pair) { return !pair.is_near && !pair.remembers() && !pair.has_lost(); });
  found_.pairs = std::move(next);
  found_.arrays.searched = body_.arrays.displacement;
  found_.has_near = true;
  ++found_.searches;
  return others;
}

// The rows

/// Puts near pairs into rows: those of one law and its choices side by side, and among them those for which a
/// step does as much: that bear, touch, are asked, or sleep. Rows of few such pairs take as long as full
/// ones.
template <int Dim>
void FoundContacts<Dim>::make_rows() {
  struct Group {
    int law, choices;
    int rest;      // 0 for pairs that bear; higher for those for which a step does less
    double wakes;  // those that sleep long stand together
    auto operator<=>(const Group&) const = default;
    bool goes_with(const Group& o) const { return law == o.law && choices == o.choices; }
  };
  std::vector<std::vector<int>> all_choices;
  std::vector<int> choices_of_set(static_cast<std::size_t>(body_.properties.contacts.size()), -1);
  const auto choices_of = [&](int set) {
    int& number = choices_of_set[set];
    if (number >= 0) return number;
    const auto& choices = body_.properties.contacts.choices(set);
    number = place_in(all_choices, choices);
    if (number == std::ssize(all_choices)) all_choices.push_back(choices);
    return number;
  };
  std::vector<std::pair<Group, int>> order;
  for (int i = 0; i < std::ssize(found_.pairs); ++i) {
    Pair& pair = found_.pairs[i];
    pair.slot = -1;
    if (!pair.is_near) continue;
    if (pair.sets[0] < 0) pair.sets = sets_of(pair);
    const int rest = pair.bears() ? 0 : pair.presses() ? 1 : pair.was_asked ? 2 : 3;
    order.push_back({{pair.law, choices_of(pair.sets[0]), rest, pair.wakes}, i});
  }
  std::sort(order.begin(), order.end());
  auto& arrays = found_.arrays;
  struct Begin {
    int law, internal, loss, constant, choice;
  };
  std::vector<Begin> rows;
  std::vector<std::size_t> firsts{0};  // entries of `order`
  int internals = 0, losses = 0, constants = 0, choices = 0;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && end < i + kLanes && order[end].first.goes_with(order[i].first)) ++end;
    const int of_law = order[i].first.law;
    const LawOfRows& law = arrays.laws[of_law];
    const int bytes = static_cast<int>((body_.laws[of_law]->constants_size + 63) / 64 * 64);
    rows.push_back({of_law, internals, losses, constants, choices});
    internals += kPointsOfPair<Dim> * law.internals;
    losses += law.losses;
    constants += kSetsOfPair<Dim> * law.constants;
    choices += bytes;
    i = end;
    firsts.push_back(end);
  }
  arrays.rows = FlatArray<FoundRow<Dim>>(rows.size());
  arrays.internals = FlatArray<Line>(static_cast<std::size_t>(internals));
  arrays.lost = FlatArray<Line>(static_cast<std::size_t>(losses));
  arrays.constants = FlatArray<Line>(static_cast<std::size_t>(constants));
  arrays.choices = FlatArray<std::byte>(static_cast<std::size_t>(choices));
  arrays.forces = FlatArray<Vec<Dim>>(2 * Dim * kLanes * rows.size());
  found_.constants.resize(static_cast<std::size_t>(body_.properties.contacts.size()));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    FoundRow<Dim>& row = arrays.rows[r];
    row.law = rows[r].law;
    row.first_internal = rows[r].internal;
    row.first_loss = rows[r].loss;
    row.first_constant = rows[r].constant;
    row.first_choice = rows[r].choice;
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = firsts[r] + static_cast<std::size_t>(lane);
      const bool idles = at >= firsts[r + 1];
      Pair& pair = found_.pairs[order[idles ? firsts[r] : at].second];
      if (!idles) pair.slot = slot_of(static_cast<int>(r), lane);
      // an idle lane is a new pair of the same facets, without thickness
      put_into_row(idles ? new_pair(pair.facets) : pair, static_cast<int>(r), lane);
      if (idles) row.thickness.number[lane] = 0.0;
    }
  }
  list_loads();
  let_sleep();
  see(found_.seen, arrays);
  found_.seen.is_damped = found_.parameters.damping > 0.0;
  found_.has_rows = found_.has_new_rows = true;
}

/// Returns the constants of a set of parameters, derived when they are first asked for.
template <int Dim>
const ConstantsOfSet& FoundContacts<Dim>::constants_of(int set) const {
  ConstantsOfSet& constants = found_.constants[set];
  if (!constants.bytes.empty()) return constants;
  const LawTable& law = body_.properties.contacts.law(set);
  constants.bytes.resize(law.constants_size);
  body_.properties.contacts.derive(set, constants.bytes.data());
  constants.numbers.resize(static_cast<std::size_t>(law.constant_count));
  law.numbers_of(constants.bytes.data(), constants.numbers.data(), 1);
  constants.stiffness = law.stiffness(constants.bytes.data());
  return constants;
}

template <int Dim>
void FoundContacts<Dim>::put_into_row(const Pair& pair, int index, int lane) {
  auto& arrays = found_.arrays;
  FoundRow<Dim>& row = arrays.rows[index];
  const LawOfRows& law = arrays.laws[row.law];
  const auto at = corners(pair.facets);
  for (int i = 0; i < 2 * Dim; ++i) row.corners[i][lane] = offset_of<Dim>(body_.layout.gridpoint_slot[at[i]]);
  const auto put = [&](Line& line, double number) { line.number[lane] = number; };
  put(row.thickness, body_.model.thickness * pair.ratio);
  put(row.most_depth, most_depth(pair.facets));
  put(row.not_counted, pair.not_counted);
  put(row.stored, pair.stored);
  put(row.applied, pair.applied);
  put(row.lost_area, pair.lost_area);
  put(row.lost_damping, pair.lost_damping);
  put(row.damping, damping_of(pair, constants_of(pair.sets[0]).stiffness.normal));
  const auto bit = 1U << static_cast<unsigned>(lane);
  if (pair.is_handed_over) row.handed_over |= bit;
  for (int set = 0; set < kSetsOfPair<Dim>; ++set) {
    const ConstantsOfSet& constants = constants_of(pair.sets[set]);
    if (lane == 0 && set == 0) std::ranges::copy(constants.bytes, arrays.choices.begin() + row.first_choice);
    for (int i = 0; i < law.constants; ++i)
      put(arrays.constants[row.first_constant + set * law.constants + i], constants.numbers[i]);
    put(row.shear_stiffness[set], constants.stiffness.shear);
  }
  for (int k = 0; k < kPointsOfPair<Dim>; ++k) {
    const PairPoint<Dim>& point = pair.points[k];
    put(row.area[k], point.area);
    for (int i = 0; i + 1 < Dim; ++i) {
      put(row.held[k][i], point.held[i]);
      put(row.shift[k][i], point.shift[i]);
    }
    put(row.offset[k], point.offset);
    put(row.rest[k], point.rest);
    put(row.damped[k], point.damped);
    for (int i = 0; i < law.internals; ++i)
      put(arrays.internals[row.first_internal + k * law.internals + i],
          pair.internals[k * law.internals + i]);
  }
  const std::uint32_t joined = joined_corners(pair.facets);
  if constexpr (Dim == 2) {
    put(row.unloaded_a, found_.facets[pair.facets[0]].length);
    put(row.unloaded_b, found_.facets[pair.facets[1]].length);
    for (int k = 0; k < 2; ++k)
      if ((joined >> static_cast<unsigned>(k) & 1U) == 0) row.counts[k] |= bit;
  } else {
    for (int i = 0; i < 2 * Dim; ++i) row.pressed_at[i][lane] = pair.pressed_at[i];
    row.overlap[lane] = pair.bears() || pair.is_handed_over ? overlap_at(pair.pressed_at) : Overlap{};
    if (row.overlap[lane].count > 0) row.had |= bit;
    row.joined[lane] = joined;
    row.sides.number[lane] = -1.0;
  }
  for (int i = 0; i < law.losses; ++i) put(arrays.lost[row.first_loss + i], pair.lost[i]);
}

/// Lists the forces of each gridpoint in the order of the pairs' keys.
template <int Dim>
void FoundContacts<Dim>::list_loads() {
  auto& arrays = found_.arrays;
  std::vector<std::array<int, 2>> forces;  // slot, and entry of the force
  for (const Pair& pair : found_.pairs) {
    if (pair.slot < 0) continue;
    const auto at = corners(pair.facets);
    for (int i = 0; i < 2 * Dim; ++i)
      forces.push_back({body_.layout.gridpoint_slot[at[i]],
                        (2 * Dim * (pair.slot / kLanes) + i) * kLanes + pair.slot % kLanes});
  }
  std::stable_sort(forces.begin(), forces.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  std::vector<LoadedGridpoint> loaded;
  std::vector<int> acting;
  for (const auto& [slot, entry] : forces) {
    if (loaded.empty() || loaded.back().slot != slot)
      loaded.push_back({slot, static_cast<int>(acting.size()), 0});
    acting.push_back(entry);
    loaded.back().last_force = static_cast<int>(acting.size());
  }
  arrays.loaded = FlatArray<LoadedGridpoint>(loaded);
  arrays.acting = FlatArray<int>(acting);
  std::vector<int> of_bundle;
  for (const Bundle& bundle : body_.layout.bundles) {
    const auto before = [](const LoadedGridpoint& g, int slot) { return g.slot < slot; };
    const auto first = std::lower_bound(loaded.begin(), loaded.end(), slot_of(bundle.first_pack, 0), before);
    of_bundle.push_back(static_cast<int>(first - loaded.begin()));
  }
  of_bundle.push_back(static_cast<int>(loaded.size()));
  arrays.loaded_of_bundle = FlatArray<int>(of_bundle);
}

/// Gives pairs the numbers that they have in rows.
template <int Dim>
void FoundContacts<Dim>::take_back() {
  for (Pair& pair : found_.pairs) take_from_row(found_, pair);
}

template <int Dim>
void FoundContacts<Dim>::forget_lists() {
  for (Pair& pair : found_.pairs) pair.slot = -1;
  found_.has_far = found_.has_near = found_.has_rows = false;
  found_.constants.clear();
}

template <int Dim>
void FoundContacts<Dim>::follow_properties() {
  take_back();
  for (Pair& pair : found_.pairs) {
    pair.sets = Pair::not_known();
    pair.slot = -1;
    for (PairPoint<Dim>& point : pair.points)
      if (pair.is_handed_over && point.area == 0.0) point.rest = std::numeric_limits<double>::max();
  }
  found_.constants.clear();
  found_.has_near = found_.has_rows = false;
}

template <int Dim>
void FoundContacts<Dim>::follow_masses() {
  take_back();
  found_.has_rows = false;
}

// Faces that are handed over

/// Tells whether the sides of a face have slid so far on each other that it is to be handed over, as a
/// bearing. Beyond that a contact of the beginning would press a side where it is no more.
template <int Dim>
bool FoundContacts<Dim>::has_slid(int face) const {
  double extent = 0.0;
  for (int c = body_.model.face_contacts[face]; c < body_.model.face_contacts[face + 1]; ++c)
    extent += body_.model.extent(c);
  return Reader<Dim>(body_).slide(face) > kSlidBearing * (Dim == 2 ? extent : std::sqrt(extent));
}

/// Returns the faces of the whole body that are to be handed over: a collective.
template <int Dim>
std::vector<int> FoundContacts<Dim>::faces_to_hand_over() const {
  std::vector<int> faces;
  const auto& s = body_.arrays;
  for (int pack = 0; pack < body_.layout.face_packs(); ++pack) {
    const LawTable& law = body_.law_of_pack(pack);
    const auto count = static_cast<int>(law.internals(Dim).size());
    const int points = body_.layout.first_point_of(pack + 1) - body_.layout.first_point_of(pack);
    unsigned broken = 0xffU & ~static_cast<unsigned>(body_.left_out.empty() ? 0 : body_.left_out[pack]);
    for (int point = 0; point < points; ++point) {
      unsigned of_point = 0;
      for (const Remembers what : kCrackModes)
        if (const int place = place_of(law, what, Dim); place >= 0)
          for (int lane = 0; lane < kLanes; ++lane)
            if (s.internals[s.first_internal[pack] + point * count + place].number[lane] >= 1.0)
              of_point |= 1U << static_cast<unsigned>(lane);
      broken &= of_point;
    }
    for (int lane = 0; broken != 0 && lane < kLanes; ++lane)
      if (const int face = found_.face_of_lane[kLanes * pack + lane];
          (broken >> static_cast<unsigned>(lane) & 1U) != 0 && face >= 0)
        faces.push_back(face);
  }
  for (int face = 0; face < std::ssize(body_.torn); ++face)
    if (body_.torn[face] && !found_.is_handed_over[face]) faces.push_back(face);
  const ChunkList::Items own = body_.model.gridpoint_chunks().own();
  for (const int face : found_.bearings) {
    const Joint& contact = body_.model.contacts[body_.model.face_contacts[face]];
    if (!found_.is_handed_over[face] && (own.contain(contact.a) || own.contain(contact.b)) && has_slid(face))
      faces.push_back(face);
  }
  faces = body_.model.ranks().collect(faces);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

template <int Dim>
void FoundContacts<Dim>::mark_handed_over(int face) {
  found_.is_handed_over[face] = true;
  for (int f = found_.first_of_face[face]; f < found_.first_of_face[face + 1]; ++f)
    found_.facets[f].is_free = true;
  body_.leave_out(face);
}

/// Returns the pairs of the two sides of a face, with the areas, jumps and history of its contact points at
/// the displacements of the last forces.
template <int Dim>
std::vector<FoundPair<Dim>> FoundContacts<Dim>::pairs_of_face(int face) const {
  const Reader<Dim> read(body_);
  const auto at = [&](int g) { return body_.model.position[g] + read.displacement_of_force(g); };
  const int begin = found_.first_of_face[face], end = found_.first_of_face[face + 1],
            middle = (begin + end) / 2;
  const int first = body_.model.face_contacts[face], last = body_.model.face_contacts[face + 1];
  std::vector<Pair> pairs;
  std::vector<PairShape<Dim>> shapes;
  double face_area = 0.0, stored = 0.0, overlap = 0.0;
  const auto goes_on = [&](const PairShape<Dim>& shape) {
    return shape.overlaps() && !(body_.is_torn(face) && shape.cosine() < kLeans);
  };
  for (int c = first; c < last; ++c) {
    face_area += body_.model.contacts[c].area;
    stored += read.contact(c).stored * body_.model.contacts[c].area;
  }
  for (int a = begin; a < middle; ++a)
    for (int b = middle; b < end; ++b) {
      pairs.push_back(new_pair({a, b}));
      shapes.push_back(shape_of(found_, pairs.back(), places(pairs.back().facets, at)));
      const auto& shape = shapes.back();
      if (goes_on(shape)) overlap += shape.cosine() * shape.cosine() * shape.overlap();
    }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!goes_on(shapes[i])) continue;  // they have left each other already, or never met
    Pair& pair = pairs[i];
    pair.is_handed_over = true;
    if constexpr (Dim == 2) {
      const EdgePair<double>& p = shapes[i].p;
      const double area = body_.model.contacts[first].area;
      pair.internals.clear();
      pair.ratio = area / (p.cosine * p.cosine * 0.5 * p.overlap * body_.model.thickness);
      for (int k = 0; k < 2; ++k) {
        const ContactState state = read.contact(first + k);
        pair.points[k] = {area,
                          {{state.shear_traction[0] / shear_stiffness_of(first + k)}},
                          {{state.tangential_jump[0] - p.slide[k]}},
                          state.opening - p.gap[k],
                          0.0,
                          0.0};
        pair.internals.insert(pair.internals.end(), state.internals.begin(), state.internals.end());
        pair.stored += state.stored * area;
      }
    } else {
      pair.ratio = face_area / overlap;
      pair.pressed_at = places(pair.facets, at);
      take_history(shapes[i].p, shapes[i].points(), first, last, pair);
    }
    stored -= pair.stored;
  }
  // in space points of pairs are others than those of the face, and so is their energy, a little; and what
  // sides held that have left each other is lost
  pairs.front().lost_area = stored;
  return pairs;
}

template <int Dim>
double FoundContacts<Dim>::shear_stiffness_of(int contact) const {
  return body_.properties.contacts[body_.properties.of_contact[contact]].stiffness().shear;
}

/// Gives the points of a pair of triangles the state of the nearest contacts of their face.
/// \param first, last  contacts of the face
template <int Dim>
void FoundContacts<Dim>::take_history(const TrianglePair<double>& p, int points, int first, int last,
                                      Pair& pair) const {
  if constexpr (Dim == 3) {
    const Reader<Dim> read(body_);
    const LawOfRows& law = found_.arrays.laws[pair.law];
    const auto tangents = tangents_of(p.a, p.normal);
    for (int k = 0; k < points; ++k) {
      const Vec<3> place = p.on_a(k);
      int nearest = first;
      double least = std::numeric_limits<double>::infinity();
      for (int c = first; c < last; ++c) {
        const int g = body_.model.contacts[c].a;
        const Vec<3> way = body_.model.position[g] + read.displacement_of_force(g) - place;
        if (dot(way, way) < least) {
          least = dot(way, way);
          nearest = c;
        }
      }
      const ContactState state = read.contact(nearest);
      const auto frame = read.frame_of_forces(nearest);
      const auto turned = [&](const Vec<2>& v) {
        const Vec<3> in_space = frame.tangents[0] * v[0] + frame.tangents[1] * v[1];
        return Vec<2>{{dot(in_space, tangents[0]), dot(in_space, tangents[1])}};
      };
      PairPoint<Dim>& point = pair.points[k];
      point.area = pair.ratio * p.cosine * p.cosine * p.part[k];
      point.held = turned(state.shear_traction * (1.0 / shear_stiffness_of(nearest)));
      point.shift = turned(state.tangential_jump);
      point.offset = state.opening - p.gap[k];
      double* const internals = &pair.internals[static_cast<std::size_t>(k * law.internals)];
      std::ranges::copy(state.internals, internals);
      if (law.slip >= 0) {
        const Vec<2> slip = turned({{internals[law.slip], internals[law.slip + 1]}});
        internals[law.slip] = slip[0];
        internals[law.slip + 1] = slip[1];
      }
      pair.stored += state.stored * point.area;
    }
  }
}

template <int Dim>
void FoundContacts<Dim>::hand_over() {
  const std::vector<int> faces = faces_to_hand_over();
  if (faces.empty()) return;
  take_back();
  take_from_owners();
  // facets beside the face are fresh too: where it held them together they may press from now on
  std::vector<bool> ends(body_.model.position.size()), fresh(found_.facets.size());
  const std::ptrdiff_t known = std::ssize(found_.pairs);
  for (const int face : faces) {
    if (is_own({found_.first_of_face[face], found_.first_of_face[face + 1] - 1}))
      for (Pair& pair : pairs_of_face(face))
        if (Dim == 2 || pair.is_handed_over || pair.has_lost()) found_.pairs.push_back(std::move(pair));
    for (int contact = body_.model.face_contacts[face]; contact < body_.model.face_contacts[face + 1];
         ++contact)
      ends[body_.model.contacts[contact].a] = ends[body_.model.contacts[contact].b] = true;
  }
  for (std::size_t f = 0; f < fresh.size(); ++f)
    for (const int g : found_.facets[f].gridpoints) fresh[f] = fresh[f] || ends[g];
  std::vector<int> sides;
  for (const int face : faces) {
    mark_handed_over(face);
    for (int f = found_.first_of_face[face]; f < found_.first_of_face[face + 1]; ++f) sides.push_back(f);
  }
  const auto by_key = [](const Pair& a, const Pair& b) { return a.facets < b.facets; };
  std::sort(found_.pairs.begin() + known, found_.pairs.end(), by_key);
  std::inplace_merge(found_.pairs.begin(), found_.pairs.begin() + known, found_.pairs.end(), by_key);
  add_to_far(sides);
  search();
  leave_out_overlaps(fresh, 0.0);
  make_rows();
}

template <int Dim>
void FoundContacts<Dim>::forget_gone() {
  take_back();
  const auto is_gone = [&](int facet) { return body_.is_gone(found_.facets[facet].block); };
  for (Pair& pair : found_.pairs) {
    if (!is_gone(pair.facets[0]) && !is_gone(pair.facets[1])) continue;
    Pair lost = new_pair(pair.facets);
    lost.is_near = false;
    lost.lost = pair.lost;
    lost.lost_area = pair.lost_area;
    lost.lost_damping = pair.lost_damping;
    pair = std::move(lost);
  }
  std::vector<bool> fresh(found_.facets.size());
  for (int face = 0; face < body_.model.face_count(); ++face) {
    const int begin = found_.first_of_face[face], end = found_.first_of_face[face + 1];
    if (found_.is_handed_over[face] || (!is_gone(begin) && !is_gone(end - 1))) continue;
    mark_handed_over(face);
    std::fill(fresh.begin() + begin, fresh.begin() + end, true);
  }
  bury_gone();
  forget_lists();
  search();
  leave_out_overlaps(fresh, 0.0);
  make_rows();
}

/// Takes the facets of gone blocks out of all searches.
template <int Dim>
void FoundContacts<Dim>::bury_gone() {
  for (BlockFacet<Dim>& facet : found_.facets)
    if (body_.is_gone(facet.block)) facet.is_free = false;
}

/// Leaves out the present overlap of pairs that lie in each other as they begin.
/// \param fresh      true for facets that begin
/// \param tolerance  depth over the length of an edge that is none
template <int Dim>
void FoundContacts<Dim>::leave_out_overlaps(const std::vector<bool>& fresh, double tolerance) {
  const Reader<Dim> read(body_);
  for (Pair& pair : found_.pairs) {
    if (!pair.is_near || pair.remembers() || !(fresh[pair.facets[0]] || fresh[pair.facets[1]])) continue;
    const auto shape = shape_of(found_, pair, places(pair.facets, [&](int g) {
                                  return body_.model.position[g] + read.displacement_of_force(g);
                                }));
    if (!shape.overlaps()) continue;
    const double least = -tolerance * shape.least_length(), most = -most_depth(pair.facets);
    bool lies_in = false;
    for (int k = 0; k < shape.points(); ++k)
      lies_in = lies_in || (shape.gap(k) < least && shape.gap(k) > most);
    if (!lies_in) continue;
    pair.not_counted = shape.overlap();
    pair.wakes = 0.0;
  }
}

// Sums and states

template <int Dim>
void take_from_row(const FoundData<Dim>& found, FoundPair<Dim>& pair) {
  if (pair.slot < 0) return;
  const auto& arrays = found.arrays;
  const FoundRow<Dim>& row = arrays.rows[pair.slot / kLanes];
  const LawOfRows& law = arrays.laws[row.law];
  const int lane = pair.slot % kLanes;
  const bool was_handed_over = pair.is_handed_over;
  pair.is_handed_over = (row.handed_over >> static_cast<unsigned>(lane) & 1U) != 0;
  pair.not_counted = row.not_counted.number[lane];
  pair.stored = row.stored.number[lane];
  pair.applied = row.applied.number[lane];
  pair.lost_area = row.lost_area.number[lane];
  pair.lost_damping = row.lost_damping.number[lane];
  if constexpr (Dim == 3) {
    pair.pressed_at = corners_in(row.pressed_at, lane);
    pair.was_asked = (row.asked >> static_cast<unsigned>(lane) & 1U) != 0;
  }
  for (int k = 0; k < kPointsOfPair<Dim>; ++k) {
    PairPoint<Dim>& point = pair.points[k];
    point.area = row.area[k].number[lane];
    for (int i = 0; i + 1 < Dim; ++i) {
      point.held[i] = row.held[k][i].number[lane];
      point.shift[i] = row.shift[k][i].number[lane];
    }
    point.offset = row.offset[k].number[lane];
    point.rest = row.rest[k].number[lane];
    point.damped = row.damped[k].number[lane];
    for (int i = 0; i < law.internals; ++i)
      pair.internals[k * law.internals + i] =
          arrays.internals[row.first_internal + k * law.internals + i].number[lane];
  }
  for (int i = 0; i < law.losses; ++i) pair.lost[i] = arrays.lost[row.first_loss + i].number[lane];
  // the sides have left each other: what follows is a new pair
  if (was_handed_over && !pair.is_handed_over) pair.ratio = 1.0;
}

/// Returns the sum of a number of pairs over the whole body: a collective.
/// \param in_pair, in_row  places of the number
template <int Dim>
double sum_of_pairs(const Body<Dim>& body, double FoundPair<Dim>::*in_pair, Line FoundRow<Dim>::*in_row) {
  const auto give = [&](const FoundPair<Dim>& pair, auto add) {
    const double number =
        pair.slot < 0 ? pair.*in_pair
                      : (body.found->arrays.rows[pair.slot / kLanes].*in_row).number[pair.slot % kLanes];
    if (number != 0.0) add(number);
  };
  double sum = 0.0;
  for (const double number : of_all_pairs<double>(body, give)) sum += number;
  return sum;
}

template <int Dim>
double stored_by(const Body<Dim>& body) {
  return sum_of_pairs(body, &FoundPair<Dim>::stored, &FoundRow<Dim>::stored);
}

template <int Dim>
double applied_by(const Body<Dim>& body) {
  return sum_of_pairs(body, &FoundPair<Dim>::applied, &FoundRow<Dim>::applied);
}

template <int Dim>
std::vector<LossesOfPair> losses_of_pairs(const Body<Dim>& body) {
  const auto& arrays = body.found->arrays;
  return of_all_pairs<LossesOfPair>(body, [&](const FoundPair<Dim>& pair, auto add) {
    LossesOfPair lost{pair.law, {}, pair.lost_area, pair.lost_damping};
    std::ranges::copy(pair.lost, lost.of_law.begin());
    if (pair.slot >= 0) {
      const FoundRow<Dim>& row = arrays.rows[pair.slot / kLanes];
      const int lane = pair.slot % kLanes;
      for (std::size_t i = 0; i < pair.lost.size(); ++i)
        lost.of_law[i] = arrays.lost[row.first_loss + static_cast<int>(i)].number[lane];
      lost.area = row.lost_area.number[lane];
      lost.damping = row.lost_damping.number[lane];
    }
    const auto is_lost = [](double energy) { return energy != 0.0; };
    if (is_lost(lost.area) || is_lost(lost.damping) || std::ranges::any_of(lost.of_law, is_lost)) add(lost);
  });
}

template <int Dim>
void FoundContacts<Dim>::visit_state(StateVisitor& visitor) {
  const StateVisitor::Scope scope(visitor, "found");
  std::vector<int> faces, keys;
  std::vector<double> numbers;
  const auto each_number = [](auto& pair, auto f) {
    f(pair.ratio), f(pair.not_counted), f(pair.stored), f(pair.applied), f(pair.lost_area),
        f(pair.lost_damping);
    for (auto& point : pair.points) {
      f(point.area);
      for (auto& number : point.held.c) f(number);
      for (auto& number : point.shift.c) f(number);
      f(point.offset), f(point.rest), f(point.damped);
    }
    for (auto& corner : pair.pressed_at)
      for (auto& number : corner.c) f(number);
    for (auto& number : pair.internals) f(number);
    for (auto& number : pair.lost) f(number);
  };
  const auto is_kept = [](const Pair& pair) { return pair.remembers() || pair.has_lost(); };
  if (!visitor.replaces()) {
    take_back();
    for (int face = 0; face < std::ssize(found_.is_handed_over); ++face)
      if (found_.is_handed_over[face]) faces.push_back(face);
    keys = of_all_pairs<int>(body_, [&](const Pair& pair, auto add) {
      if (!is_kept(pair)) return;
      for (const int part_of_key : {pair.facets[0], pair.facets[1], pair.is_handed_over ? 1 : 0})
        add(part_of_key);
    });
    numbers = of_all_pairs<double>(body_, [&](const Pair& pair, auto add) {
      if (is_kept(pair)) each_number(pair, add);
    });
  }
  visitor.visit("handed_over", faces, state::index(found_.is_handed_over.size()));
  visitor.visit("pairs", keys, state::index(found_.facets.size()));
  visitor.visit("numbers", numbers);
  if (!visitor.replaces()) return;

  std::fill(found_.is_handed_over.begin(), found_.is_handed_over.end(), false);
  for (BlockFacet<Dim>& facet : found_.facets) facet.is_free = facet.begins_free;
  for (const int face : faces) mark_handed_over(face);
  found_.pairs.clear();
  visitor.require(keys.size() % 3 == 0, "pairs", "is cut off");
  std::size_t taken = 0;
  for (std::size_t i = 0; i + 2 < keys.size(); i += 3) {
    const Key key{keys[i], keys[i + 1]};
    visitor.require(key[0] < key[1] && (i == 0 || Key{keys[i - 3], keys[i - 2]} < key), "pairs",
                    "are not in order");
    visitor.require(found_.facets[key[0]].block != found_.facets[key[1]].block, "pairs", "are of one block");
    visitor.require(found_.facets[key[0]].is_free && found_.facets[key[1]].is_free && may_meet(key), "pairs",
                    "names a facet that is not free");
    const bool is_handed_over = keys[i + 2] != 0;
    visitor.require(!is_handed_over || face_of(key) >= 0, "pairs", "hands over facets of two faces");
    Pair pair = new_pair(key);
    pair.is_handed_over = is_handed_over;
    each_number(pair, [&](double& number) {
      visitor.require(taken < numbers.size(), "numbers", "are fewer than the pairs have");
      number = numbers[taken++];
    });
    if (is_own(key)) found_.pairs.push_back(std::move(pair));
  }
  visitor.require(taken == numbers.size(), "numbers", "are more than the pairs have");
  bury_gone();
  forget_lists();
  found_.knows_all = false;
}

template class FoundContacts<2>;
template class FoundContacts<3>;
template void take_from_row(const FoundData<2>&, FoundPair<2>&);
template void take_from_row(const FoundData<3>&, FoundPair<3>&);
template double stored_by(const Body<2>&);
template double stored_by(const Body<3>&);
template double applied_by(const Body<2>&);
template double applied_by(const Body<3>&);
template std::vector<LossesOfPair> losses_of_pairs(const Body<2>&);
template std::vector<LossesOfPair> losses_of_pairs(const Body<3>&);

}  // namespace pyroclast
