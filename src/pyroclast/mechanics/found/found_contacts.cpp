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
/// Bound of a change of gaps, overlaps and cosines over the reach, while gridpoints go that far.
constexpr double kMargin = 5.0;
/// Distance from the origin, over the mean edge, beyond which nothing meets any more.
constexpr double kFarthest = 1e5;
/// Steps to the end of lists of far pairs over those to the end of lists of near ones.
constexpr double kFarOverNear = 20.0;
/// Longest such ways: for far pairs over the mean edge, for near ones over those for far pairs.
constexpr double kLongestFar = 0.25, kLongestNear = 0.2;
/// Bound of a gridpoint's share of critical damping over that of its block, the root of the ratio of their
/// masses.
constexpr double kGridpointDamping = 3.0;
/// Largest ratio between the sum of |stiffness| over a row of a contact's matrix and its larger stiffness,
/// whatever its direction: (1 + sqrt 2) / 2, where it has no shear stiffness.
constexpr double kOfAnyDirection = 1.2071067811865476;

constexpr Remembers kDamages[] = {Remembers::tension_damage, Remembers::shear_damage,
                                  Remembers::mixed_damage};

/// Returns the internal variables of a broken point that was never touched.
std::vector<double> broken_internals(const LawTable& law) {
  std::vector<double> internals(law.internals(2).size());
  for (const Remembers what : kDamages)
    if (const int place = place_of(law, what, 2); place >= 0)
      internals[static_cast<std::size_t>(place)] = 1.0;
  return internals;
}

/// Tells whether a broken point of a law lets go of what it pulls.
bool lets_go(const ContactProperties& properties) {
  auto internals = broken_internals(*properties.law);
  std::vector<double> losses(properties.law->losses.size());
  const double open[2] = {1e-3, 0.0};
  return properties.law->update(2)(properties.constants().data(), open, internals.data(), losses.data())
             .normal_traction == 0.0;
}

}  // namespace

// The data

void FoundContacts::make(Body<2>& body) {
  if (!body.parameters.found.is_on) return;
  if (body.parameters.kinematics != Kinematics::finite)
    throw Error("contacts = found: blocks that meet others turn, which needs kinematics = finite");
  if (body.model.part) throw Error("contacts = found: one rank alone must hold the body");
  body.found = std::make_unique<FoundData>();
  FoundData& found = *body.found;
  found.parameters = body.parameters.found;
  const auto& model = body.model;

  std::vector<LawOfRows> laws;
  for (const LawTable* table : body.laws) {
    LawOfRows& law = laws.emplace_back();
    const auto infos = table->internals(2);
    law.internals = static_cast<int>(infos.size());
    law.losses = static_cast<int>(table->losses.size());
    law.constants = table->constant_count;
    if (std::max(law.internals, law.losses) > LawOfRows::kMost)
      throw Error(
          fmt::format("contacts = found: the law \"{}\" has more than {} internal variables or losses",
                      table->name, LawOfRows::kMost));
    for (int i = 0; i < law.internals; ++i)
      if (std::string_view(infos[i].name) == info::held_jump.name) law.held_jump = i;
    std::ranges::copy(broken_internals(*table), law.broken);
  }
  found.arrays.laws = FlatArray<LawOfRows>(laws);

  const std::vector<int> block_of = gridpoint_blocks(model);
  const auto add_facet = [&](std::array<int, 2> gridpoints, int face) {
    const double length = norm(model.position[gridpoints[1]] - model.position[gridpoints[0]]);
    found.facets.push_back({block_of[gridpoints[0]], gridpoints, face, face < 0, length});
  };
  for (const auto& face :
       pyroclast::outline(model, body.geometry, std::vector<bool>(model.block_count(), true)))
    add_facet(face.gridpoints, -1);
  found.outline = static_cast<int>(found.facets.size());
  found.face_of_lane.assign(body.layout.faces.size() * kLanes, -1);
  for (int face = 0; face < model.face_count(); ++face) {
    const int first = model.face_contacts[face];
    const auto &begin = model.contacts[first], &end = model.contacts[first + 1];
    add_facet({begin.a, end.a}, face);
    add_facet({end.b, begin.b}, face);
    const int slot = body.layout.contact_slot[first];
    found.face_of_lane[kLanes * body.layout.face_pack_of_point[slot / kLanes] + slot % kLanes] = face;
  }
  found.is_handed_over.assign(static_cast<std::size_t>(model.face_count()), false);

  found.at_gridpoint = gridpoint_contacts(model);
  const auto blocks = static_cast<std::size_t>(model.block_count());
  std::vector<double>& longest = found.longest;
  longest.resize(blocks);
  double sum = 0.0;
  for (const BlockFacet& facet : found.facets) {
    longest[facet.block] = std::max(longest[facet.block], facet.length);
    sum += facet.length;
  }
  const double mean_edge = sum / static_cast<double>(std::max<std::size_t>(found.facets.size(), 1));
  found.mean_edge = mean_edge;
  found.most_depth.resize(blocks);
  for (int b = 0; b < model.block_count(); ++b) {
    double area = 0.0;
    for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
      area += body.geometry.volume[z] / model.thickness;
    found.most_depth[b] = kMostDepth * area / longest[b];
  }

  found.contacts_of_block.resize(blocks);
  found.first_contact.assign(model.interface_names.size(), -1);
  const int materials = static_cast<int>(model.material_names.size());
  constexpr int kNone = -1, kSeveral = -2;
  found.interfaces.assign(static_cast<std::size_t>(materials * materials), kNone);
  for (int c = 0; c < model.contact_count(); ++c) {
    const auto& contact = model.contacts[c];
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
      serves[i] = lets_go(body.properties.contacts[set]);
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
  found.arrays.searched = body.made<Vec<2>>(slots);
  found.searched_far = body.made<Vec<2>>(slots);
  body.state.found = &found.seen;
}

Vec<2> FoundContacts::place(int gridpoint, const FlatArray<Vec<2>>& displacement) const {
  return body_.model.position[gridpoint] + displacement[body_.layout.gridpoint_slot[gridpoint]];
}

/// Returns the gridpoints of a pair: the ends of edge a, then those of edge b.
std::array<int, 4> FoundContacts::corners(const Key& key) const {
  const auto &a = found_.facets[key[0]].gridpoints, &b = found_.facets[key[1]].gridpoints;
  return {a[0], a[1], b[1], b[0]};
}

/// \param place  returns the place of a gridpoint, m
template <class Place>
EdgePair<double> FoundContacts::pair_at(const Key& key, Place place) const {
  const auto at = corners(key);
  return edge_pair<double>({place(at[0]), place(at[1])}, {place(at[2]), place(at[3])},
                           found_.facets[key[0]].length, found_.facets[key[1]].length);
}

double FoundContacts::most_depth(const Key& key) const {
  return std::min(found_.most_depth[found_.facets[key[0]].block],
                  found_.most_depth[found_.facets[key[1]].block]);
}

/// Tells whether a contact that is not handed over joins two gridpoints.
bool FoundContacts::holds_together(int a, int b) const {
  const GridpointContacts& at = found_.at_gridpoint;
  for (int i = at.begin[a]; i < at.begin[a + 1]; ++i) {
    const auto& contact = body_.model.contacts[at.contact_side[i] / 2];
    if ((contact.a == b || contact.b == b) && !found_.is_handed_over[contact.face]) return true;
  }
  return false;
}

/// Returns the bits of the ends that may press: at the mouth of a notch or the root of a crack, where a
/// contact still joins both corners, it presses alone.
std::uint32_t FoundContacts::ends_that_count(const FoundPair& pair) const {
  if (face_of(pair.facets) >= 0) return 3;
  const auto at = corners(pair.facets);
  return (holds_together(at[0], at[2]) ? 0U : 1U) | (holds_together(at[1], at[3]) ? 0U : 2U);
}

/// Returns the interface of a pair: that of its face; or that of a loose body, of two the one that the deck
/// names later; else that of the two materials.
int FoundContacts::interface_of(const Key& key) const {
  if (const int face = face_of(key); face >= 0)
    return body_.model.contacts[body_.model.face_contacts[face]].interface;
  const auto of_body = [&](int facet) { return found_.of_body[found_.facets[facet].block]; };
  if (const int interface = std::max(of_body(key[0]), of_body(key[1])); interface >= 0) return interface;
  const auto material = [&](int facet) { return body_.model.block_material[found_.facets[facet].block]; };
  return found_
      .interfaces[material(key[0]) * static_cast<int>(body_.model.material_names.size()) + material(key[1])];
}

/// Returns the face whose two sides a pair is; -1 for other pairs.
int FoundContacts::face_of(const Key& key) const {
  const int face = found_.facets[key[0]].face;
  return found_.facets[key[1]].face == face ? face : -1;
}

/// Returns the set of parameters of an end of a pair: that of the face's own contact; else that of the
/// nearest contact of the interface, so that the pair has the temperature of its place.
int FoundContacts::set_of(const FoundPair& pair, int end) const {
  const auto& model = body_.model;
  const auto& of_contact = body_.properties.of_contact;
  const BlockFacet &first = found_.facets[pair.facets[0]], &second = found_.facets[pair.facets[1]];
  if (const int face = face_of(pair.facets); face >= 0) return of_contact[model.face_contacts[face] + end];
  const int interface = pair.interface;
  for (const BlockFacet& facet : {first, second})
    if (facet.face >= 0)
      if (const int c = model.face_contacts[facet.face]; model.contacts[c].interface == interface)
        return of_contact[c];
  for (const BlockFacet& facet : {first, second})
    for (const int c : found_.contacts_of_block[facet.block])
      if (model.contacts[c].interface == interface) return of_contact[c];
  return set_of_interface(interface);
}

/// Returns the set of an interface at no special place; -1 where the body has none.
int FoundContacts::set_of_interface(int interface) const {
  if (!body_.properties.of_interface.empty()) return body_.properties.of_interface[interface];
  const int c = found_.first_contact[interface];
  return c < 0 ? -1 : body_.properties.of_contact[c];
}

const LawTable& FoundContacts::law_of(const FoundPair& pair) const {
  return body_.properties.contacts.law(pair.sets[0]);
}

int FoundContacts::law_index(const FoundPair& pair) const {
  return place_in(body_.laws, &law_of(pair));
}

FoundPair FoundContacts::new_pair(const Key& key) const {
  FoundPair pair;
  pair.facets = key;
  pair.interface = interface_of(key);
  pair.sets = {set_of(pair, 0), set_of(pair, 1)};
  pair.law = law_index(pair);
  const LawOfRows& law = found_.arrays.laws[pair.law];
  for (int end = 0; end < 2; ++end)
    pair.internals.insert(pair.internals.end(), law.broken, law.broken + law.internals);
  pair.lost.resize(static_cast<std::size_t>(law.losses));
  return pair;
}

/// Returns the coefficient of damping of a pair, Pa s/m: the share of 2 sqrt(K_n m / A) that the parameters
/// ask for, with the mass of the smaller block over its longest facet.
double FoundContacts::damping_of(const FoundPair& pair, double stiffness) const {
  if (found_.parameters.damping == 0.0) return 0.0;
  double mass_of_area = std::numeric_limits<double>::infinity();
  for (const int facet : pair.facets) {
    const int block = found_.facets[facet].block;
    double mass = 0.0;
    for (int g = body_.model.block_gridpoints[block]; g < body_.model.block_gridpoints[block + 1]; ++g)
      mass += body_.mass[g];
    mass_of_area = std::min(mass_of_area, mass / (found_.longest[block] * body_.model.thickness));
  }
  return 2.0 * found_.parameters.damping * std::sqrt(stiffness * mass_of_area);
}

void FoundContacts::add_stiffness(std::vector<double>& of_gridpoints) const {
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
  for (const BlockFacet& facet : found_.facets) {
    // any block may meet any body
    double needed = of_bodies;
    for (int other = 0; other < materials; ++other)
      needed = std::max(
          needed, of_interface[found_.interfaces[model.block_material[facet.block] * materials + other]]);
    needed *= grown * grown;
    if (facet.face >= 0) needed -= stiffness_of_set(of_contact[model.face_contacts[facet.face]]);
    // the factor 2 counts the gridpoint itself and those across; half of the edge acts on each end
    if (needed > 0.0)
      for (const int g : facet.gridpoints)
        of_gridpoints[g] += 2.0 * needed * 0.5 * facet.length * model.thickness;
  }
}

// The search

void FoundContacts::begin() {
  search();
  leave_out_overlaps(std::vector<bool>(found_.facets.size(), true), kTouching);
  make_rows();
}

void FoundContacts::search_where_needed() {
  const auto watched = static_cast<int>(found_.arrays.watched.size());
  found_.seen.way = found_.has_near ? body_.step.passes.way_of_found(body_.state, 0, watched) : 0.0;
  if (!found_.has_near || !(found_.seen.way <= 1.0)) {
    search();
    found_.seen.way = 0.0;
  }
  if (!found_.has_rows) make_rows();
}

/// Finds the near pairs, and first the far ones where they are not known any more. Rows stay where they hold
/// the same pairs.
void FoundContacts::search() {
  take_back();
  for (std::size_t f = 0; found_.has_far && f < found_.facets.size(); ++f)
    for (const int g : found_.facets[f].gridpoints) {
      if (!found_.is_listed[f]) break;
      const int slot = body_.layout.gridpoint_slot[g];
      const Vec<2> way = body_.arrays.displacement[slot] - found_.searched_far[slot];
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
std::vector<double> FoundContacts::ways(double steps, double least, double most) const {
  std::vector<double> ways(found_.longest.size(), least);
  for (int g = 0; g < body_.model.gridpoint_count(); ++g) {
    const int slot = body_.layout.gridpoint_slot[g];
    const double way = 2.0 * steps * body_.state.time_step * norm(vector_at<2>(body_.state.velocity, slot));
    double& of_block = ways[found_.block_of_slot[slot]];
    if (!(way <= of_block)) of_block = way < most ? way : most;
  }
  return ways;
}

/// Returns the box of a facet at the search for far pairs, grown by half of the largest distance of a pair
/// that counts before the next such search; none for a facet that has flown off, or has no number.
std::optional<FoundContacts::Box> FoundContacts::box_of(int index) const {
  const BlockFacet& facet = found_.facets[index];
  const Vec<2> a = place(facet.gridpoints[0], found_.searched_far),
               b = place(facet.gridpoints[1], found_.searched_far);
  const double farthest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(b[0]), std::abs(b[1])});
  if (!(farthest < kFarthest * found_.mean_edge)) return {};
  const double grow =
      0.5 * ((1.0 + kMargin * kLongestNear) * found_.skin[facet.block] + found_.most_depth[facet.block]);
  Box box;
  for (int i = 0; i < 2; ++i) {
    box.low[i] = std::min(a[i], b[i]) - grow;
    box.high[i] = std::max(a[i], b[i]) + grow;
  }
  return box;
}

/// Lists a pair of free facets as far where their boxes meet and it may press before the next such search.
void FoundContacts::list_if_far(int a, const Box& box_a, int b, const Box& box_b) {
  if (found_.facets[a].block == found_.facets[b].block) return;
  for (int k = 0; k < 2; ++k)
    if (box_a.low[k] > box_b.high[k] || box_b.low[k] > box_a.high[k]) return;
  const Key key{std::min(a, b), std::max(a, b)};
  const auto p = pair_at(key, [&](int g) { return place(g, found_.searched_far); });
  const double skin = std::max(found_.skin[found_.facets[a].block], found_.skin[found_.facets[b].block]);
  if (way_to_press(key, p) < kMargin * (1.0 + kLongestNear) * skin) found_.far.push_back(key);
}

void FoundContacts::sort_far() {
  std::sort(found_.far.begin(), found_.far.end());
  found_.far.erase(std::unique(found_.far.begin(), found_.far.end()), found_.far.end());
}

/// Lists the far pairs of free facets.
void FoundContacts::find_far() {
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
  std::vector<std::array<int, 3>> entries;
  const auto cell_of = [&](double x) { return static_cast<int>(std::floor(x / cell)); };
  for (int i = 0; i < std::ssize(free); ++i)
    for (int x = cell_of(boxes[i].low[0]); x <= cell_of(boxes[i].high[0]); ++x)
      for (int y = cell_of(boxes[i].low[1]); y <= cell_of(boxes[i].high[1]); ++y)
        entries.push_back({x, y, i});
  std::sort(entries.begin(), entries.end());
  found_.far.clear();
  const auto same_cell = [](const auto& a, const auto& b) { return a[0] == b[0] && a[1] == b[1]; };
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = i + 1; j < entries.size() && same_cell(entries[i], entries[j]); ++j) {
      const int a = entries[i][2], b = entries[j][2];
      list_if_far(free[a], boxes[a], free[b], boxes[b]);
    }
  sort_far();
  found_.has_far = true;
}

/// Adds facets that have just become free to the lists of far pairs that hold.
void FoundContacts::add_to_far(const std::vector<int>& facets) {
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
void FoundContacts::watch() {
  std::vector<WatchedPack> watched;
  std::vector<int> entry(static_cast<std::size_t>(body_.layout.gridpoint_packs), -1);
  std::vector<bool> is_watched(found_.block_of_slot.size());
  for (std::size_t f = 0; f < found_.facets.size(); ++f)
    if (found_.is_listed[f])
      for (const int g : found_.facets[f].gridpoints) is_watched[body_.layout.gridpoint_slot[g]] = true;
  for (int pack = 0; pack < body_.layout.gridpoint_packs; ++pack) {
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
double FoundContacts::way_to_press(const Key& key, const EdgePair<double>& p) const {
  if (!(p.overlap > 0.0) || !(p.cosine > 0.0))
    return std::max(-p.overlap, -p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
  const auto [least, most] = std::minmax(p.gap[0], p.gap[1]);
  return std::max(least, -most_depth(key) - most);
}

/// Returns the same of a pair that is handed over and rests: until an end goes through the law, or until its
/// edges may leave each other.
double FoundContacts::way_to_change(const FoundPair& pair, const EdgePair<double>& p) const {
  double way = std::min(p.overlap, p.cosine / (1.0 / p.length_a + 1.0 / p.length_b));
  for (int k = 0; k < 2; ++k) way = std::min(way, p.gap[k] + pair.ends[k].offset - pair.ends[k].rest);
  return way;
}

/// Returns FoundPair::wakes of a pair that does not press; 1 or more where it cannot before the next search.
/// \param handed_over  the pair where it is handed over, else null
double FoundContacts::wakes(const Key& key, const FoundPair* handed_over) const {
  const auto p = pair_at(key, [&](int g) { return place(g, body_.arrays.displacement); });
  const double way = handed_over ? way_to_change(*handed_over, p) : way_to_press(key, p);
  const double reach =
      std::max(found_.reach[found_.facets[key[0]].block], found_.reach[found_.facets[key[1]].block]);
  const double share = way / (kMargin * reach);
  return share > 0.0 ? share * share : 0.0;
}

/// Lets rows and gridpoints sleep while no pair of theirs can press.
void FoundContacts::let_sleep() {
  auto& arrays = found_.arrays;
  for (FoundRow& row : arrays.rows) row.wakes = std::numeric_limits<double>::max();
  for (const FoundPair& pair : found_.pairs)
    if (pair.slot >= 0) {
      double& wakes = arrays.rows[pair.slot / kLanes].wakes;
      wakes = std::min(wakes, pair.wakes);
    }
  for (LoadedGridpoint& gridpoint : arrays.loaded) {
    gridpoint.wakes = std::numeric_limits<double>::max();
    for (int k = gridpoint.first_force; k < gridpoint.last_force; ++k)
      gridpoint.wakes = std::min(gridpoint.wakes, arrays.rows[arrays.acting[k] / (4 * kLanes)].wakes);
  }
}

/// Lists the pairs that are near, in rows or not, and those that remember something. Returns whether the near
/// ones are others than before.
bool FoundContacts::find_near() {
  std::vector<double> reach =
      ways(found_.parameters.steps, found_.parameters.reach * found_.mean_edge, found_.mean_edge);
  for (std::size_t b = 0; b < reach.size(); ++b) reach[b] = std::min(reach[b], kLongestNear * found_.skin[b]);
  found_.reach = std::move(reach);
  std::vector<FoundPair> next;
  next.reserve(found_.pairs.size());
  bool others = false;
  auto old = found_.pairs.begin();
  const auto keep_old = [&](bool is_far) {
    if (old->presses())
      old->wakes = 0.0;
    else if (old->is_handed_over || is_far)
      old->wakes = wakes(old->facets, old->is_handed_over ? &*old : nullptr);
    else
      old->wakes = 1.0;
    old->is_near = old->wakes < 1.0;
    others = others || old->is_near != (old->slot >= 0);
    if (old->is_near || old->remembers() || old->has_lost()) next.push_back(std::move(*old));
    ++old;
  };
  for (const Key& key : found_.far) {
    while (old != found_.pairs.end() && old->facets < key) keep_old(false);
    if (old != found_.pairs.end() && old->facets == key) {
      keep_old(true);
    } else if (const double share = wakes(key, nullptr); share < 1.0) {
      next.push_back(new_pair(key));
      next.back().wakes = share;
      others = true;
    }
  }
  while (old != found_.pairs.end()) keep_old(false);
  found_.pairs = std::move(next);
  found_.arrays.searched = body_.arrays.displacement;
  found_.has_near = true;
  ++found_.searches;
  return others;
}

// The rows

/// Puts near pairs into rows: those of one law and its choices side by side, first those that press, and then
/// those that wake sooner.
void FoundContacts::make_rows() {
  struct Group {
    int law;
    std::vector<int> choices;
    double wakes;  // those that sleep long stand together
    auto operator<=>(const Group&) const = default;
    bool goes_with(const Group& o) const { return law == o.law && choices == o.choices; }
  };
  std::vector<std::pair<Group, int>> order;
  for (int i = 0; i < std::ssize(found_.pairs); ++i) {
    FoundPair& pair = found_.pairs[i];
    pair.slot = -1;
    if (!pair.is_near) continue;
    if (pair.sets[0] < 0) pair.sets = {set_of(pair, 0), set_of(pair, 1)};
    order.push_back({{pair.law, body_.properties.contacts.choices(pair.sets[0]), pair.wakes}, i});
  }
  std::sort(order.begin(), order.end());
  auto& arrays = found_.arrays;
  std::vector<FoundRow> rows;
  std::vector<std::size_t> firsts{0};  // entries of `order`
  int internals = 0, losses = 0, constants = 0, choices = 0;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && end < i + kLanes && order[end].first.goes_with(order[i].first)) ++end;
    FoundRow& row = rows.emplace_back();
    row.law = order[i].first.law;
    const LawOfRows& law = arrays.laws[row.law];
    row.first_internal = std::exchange(internals, internals + 2 * law.internals);
    row.first_loss = std::exchange(losses, losses + law.losses);
    row.first_constant = std::exchange(constants, constants + 2 * law.constants);
    const int bytes = static_cast<int>((body_.laws[row.law]->constants_size + 63) / 64 * 64);
    row.first_choice = std::exchange(choices, choices + bytes);
    i = end;
    firsts.push_back(end);
  }
  arrays.rows = FlatArray<FoundRow>(rows);
  arrays.internals = FlatArray<Line>(static_cast<std::size_t>(internals));
  arrays.lost = FlatArray<Line>(static_cast<std::size_t>(losses));
  arrays.constants = FlatArray<Line>(static_cast<std::size_t>(constants));
  arrays.choices = FlatArray<std::byte>(static_cast<std::size_t>(choices));
  arrays.forces = FlatArray<Vec<2>>(4 * kLanes * rows.size());
  found_.constants.resize(static_cast<std::size_t>(body_.properties.contacts.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = firsts[r] + static_cast<std::size_t>(lane);
      const bool idles = at >= firsts[r + 1];
      FoundPair& pair = found_.pairs[order[idles ? firsts[r] : at].second];
      if (!idles) pair.slot = slot_of(static_cast<int>(r), lane);
      // an idle lane is a new pair of the same facets, without thickness
      put_into_row(idles ? new_pair(pair.facets) : pair, static_cast<int>(r), lane);
      if (idles) arrays.rows[r].thickness.number[lane] = 0.0;
    }
  list_loads();
  let_sleep();
  see(found_.seen, arrays);
  found_.seen.is_damped = found_.parameters.damping > 0.0;
  found_.has_rows = true;
}

/// Returns the constants of a set of parameters, derived when they are first asked for.
const ConstantsOfSet& FoundContacts::constants_of(int set) const {
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

void FoundContacts::put_into_row(const FoundPair& pair, int index, int lane) {
  auto& arrays = found_.arrays;
  FoundRow& row = arrays.rows[index];
  const LawOfRows& law = arrays.laws[row.law];
  const auto at = corners(pair.facets);
  for (int i = 0; i < 4; ++i) row.corners[i][lane] = offset_of<2>(body_.layout.gridpoint_slot[at[i]]);
  const auto put = [&](Line& line, double number) { line.number[lane] = number; };
  put(row.unloaded_a, found_.facets[pair.facets[0]].length);
  put(row.unloaded_b, found_.facets[pair.facets[1]].length);
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
  const auto ends = ends_that_count(pair);
  for (int k = 0; k < 2; ++k) {
    if ((ends >> static_cast<unsigned>(k) & 1U) != 0) row.counts[k] |= bit;
    put(row.area[k], pair.ends[k].area);
    put(row.held[k], pair.ends[k].held);
    put(row.shift[k], pair.ends[k].shift);
    put(row.offset[k], pair.ends[k].offset);
    put(row.rest[k], pair.ends[k].rest);
    put(row.damped[k], pair.ends[k].damped);
    const ConstantsOfSet& constants = constants_of(pair.sets[k]);
    if (lane == 0 && k == 0) std::ranges::copy(constants.bytes, arrays.choices.begin() + row.first_choice);
    for (int i = 0; i < law.constants; ++i)
      put(arrays.constants[row.first_constant + k * law.constants + i], constants.numbers[i]);
    put(row.shear_stiffness[k], constants.stiffness.shear);
    for (int i = 0; i < law.internals; ++i)
      put(arrays.internals[row.first_internal + k * law.internals + i],
          pair.internals[k * law.internals + i]);
  }
  for (int i = 0; i < law.losses; ++i) put(arrays.lost[row.first_loss + i], pair.lost[i]);
}

/// Lists the forces of each gridpoint in the order of the pairs' keys.
void FoundContacts::list_loads() {
  auto& arrays = found_.arrays;
  std::vector<std::array<int, 2>> forces;  // slot, and entry of the force
  for (const FoundPair& pair : found_.pairs) {
    if (pair.slot < 0) continue;
    const auto at = corners(pair.facets);
    for (int i = 0; i < 4; ++i)
      forces.push_back(
          {body_.layout.gridpoint_slot[at[i]], (4 * (pair.slot / kLanes) + i) * kLanes + pair.slot % kLanes});
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
void FoundContacts::take_back() {
  for (FoundPair& pair : found_.pairs) take_from_row(found_, pair);
}

void FoundContacts::forget_lists() {
  for (FoundPair& pair : found_.pairs) pair.slot = -1;
  found_.has_far = found_.has_near = found_.has_rows = false;
  found_.constants.clear();
}

void FoundContacts::follow_properties() {
  take_back();
  for (FoundPair& pair : found_.pairs) {
    pair.sets = {-1, -1};
    pair.slot = -1;
    for (PairEnd& end : pair.ends)
      if (pair.is_handed_over && end.area == 0.0) end.rest = std::numeric_limits<double>::max();
  }
  found_.constants.clear();
  found_.has_near = found_.has_rows = false;
}

void FoundContacts::follow_masses() {
  take_back();
  found_.has_rows = false;
}

// Faces that are handed over

std::vector<int> FoundContacts::broken_faces() const {
  std::vector<int> faces;
  const auto& s = body_.arrays;
  for (int pack = 0; pack < body_.layout.face_packs(); ++pack) {
    const LawTable& law = body_.law_of_pack(pack);
    const auto count = static_cast<int>(law.internals(2).size());
    unsigned broken = 0xffU & ~static_cast<unsigned>(body_.left_out.empty() ? 0 : body_.left_out[pack]);
    for (int point = 0; point < 2; ++point) {
      unsigned of_point = 0;
      for (const Remembers what : kDamages)
        if (const int place = place_of(law, what, 2); place >= 0)
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
  std::sort(faces.begin(), faces.end());
  return faces;
}

void FoundContacts::mark_handed_over(int face) {
  found_.is_handed_over[face] = true;
  for (int side = 0; side < 2; ++side) found_.facets[found_.outline + 2 * face + side].is_free = true;
  body_.leave_out(face);
}

/// Returns the pair of the two sides of a face, with the areas, jumps and history of its contact points at
/// the displacements of the last forces.
FoundPair FoundContacts::pair_of_face(int face) const {
  const Reader<2> read(body_);
  FoundPair pair = new_pair({found_.outline + 2 * face, found_.outline + 2 * face + 1});
  const auto p =
      pair_at(pair.facets, [&](int g) { return body_.model.position[g] + read.displacement_of_force(g); });
  if (!p.face) return pair;  // the sides have left each other already
  pair.is_handed_over = true;
  pair.internals.clear();
  const int first = body_.model.face_contacts[face];
  const double area = body_.model.contacts[first].area;
  pair.ratio = area / (p.cosine * p.cosine * 0.5 * p.overlap * body_.model.thickness);
  for (int k = 0; k < 2; ++k) {
    const ContactState state = read.contact(first + k);
    const double stiffness =
        body_.properties.contacts[body_.properties.of_contact[first + k]].stiffness().shear;
    pair.ends[k] = {area,
                    state.shear_traction[0] / stiffness,
                    state.tangential_jump[0] - p.slide[k],
                    state.opening - p.gap[k],
                    0.0,
                    0.0};
    pair.internals.insert(pair.internals.end(), state.internals.begin(), state.internals.end());
    pair.stored += state.stored * area;
  }
  return pair;
}

void FoundContacts::hand_over() {
  const std::vector<int> faces = broken_faces();
  if (faces.empty()) return;
  take_back();
  // facets beside the face are fresh too: where it held them together they may press from now on
  std::vector<bool> ends(body_.model.position.size()), fresh(found_.facets.size());
  for (const int face : faces) {
    found_.pairs.push_back(pair_of_face(face));
    for (const int contact : {body_.model.face_contacts[face], body_.model.face_contacts[face] + 1})
      ends[body_.model.contacts[contact].a] = ends[body_.model.contacts[contact].b] = true;
  }
  for (std::size_t f = 0; f < fresh.size(); ++f)
    fresh[f] = ends[found_.facets[f].gridpoints[0]] || ends[found_.facets[f].gridpoints[1]];
  std::vector<int> sides;
  for (const int face : faces) {
    mark_handed_over(face);
    for (int side = 0; side < 2; ++side) sides.push_back(found_.outline + 2 * face + side);
  }
  std::sort(found_.pairs.begin(), found_.pairs.end(),
            [](const FoundPair& a, const FoundPair& b) { return a.facets < b.facets; });
  add_to_far(sides);
  search();
  leave_out_overlaps(fresh, 0.0);
  make_rows();
}

void FoundContacts::forget_gone() {
  take_back();
  const auto is_gone = [&](int facet) { return body_.is_gone(found_.facets[facet].block); };
  for (FoundPair& pair : found_.pairs) {
    if (!is_gone(pair.facets[0]) && !is_gone(pair.facets[1])) continue;
    FoundPair lost = new_pair(pair.facets);
    lost.is_near = false;
    lost.lost = pair.lost;
    lost.lost_area = pair.lost_area;
    lost.lost_damping = pair.lost_damping;
    pair = std::move(lost);
  }
  std::vector<bool> fresh(found_.facets.size());
  for (int face = 0; face < body_.model.face_count(); ++face) {
    const int side = found_.outline + 2 * face;
    if (found_.is_handed_over[face] || (!is_gone(side) && !is_gone(side + 1))) continue;
    mark_handed_over(face);
    fresh[side] = fresh[side + 1] = true;
  }
  bury_gone();
  forget_lists();
  search();
  leave_out_overlaps(fresh, 0.0);
  make_rows();
}

/// Takes the facets of gone blocks out of all searches.
void FoundContacts::bury_gone() {
  for (BlockFacet& facet : found_.facets)
    if (body_.is_gone(facet.block)) facet.is_free = false;
}

/// Leaves out the present overlap of pairs that lie in each other as they begin.
/// \param fresh      true for facets that begin
/// \param tolerance  depth over the length of an edge that is none
void FoundContacts::leave_out_overlaps(const std::vector<bool>& fresh, double tolerance) {
  const Reader<2> read(body_);
  for (FoundPair& pair : found_.pairs) {
    if (!pair.is_near || pair.remembers() || !(fresh[pair.facets[0]] || fresh[pair.facets[1]])) continue;
    const auto p =
        pair_at(pair.facets, [&](int g) { return body_.model.position[g] + read.displacement_of_force(g); });
    if (!p.face) continue;
    const double least = -tolerance * std::min(p.length_a, p.length_b), most = -most_depth(pair.facets);
    const auto lies_in = [&](double gap) { return gap < least && gap > most; };
    if (lies_in(p.gap[0]) || lies_in(p.gap[1])) {
      pair.not_counted = p.overlap;
      pair.wakes = 0.0;
    }
  }
}

// Sums and states

void take_from_row(const FoundData& found, FoundPair& pair) {
  if (pair.slot < 0) return;
  const auto& arrays = found.arrays;
  const FoundRow& row = arrays.rows[pair.slot / kLanes];
  const LawOfRows& law = arrays.laws[row.law];
  const int lane = pair.slot % kLanes;
  const bool was_handed_over = pair.is_handed_over;
  pair.is_handed_over = (row.handed_over >> static_cast<unsigned>(lane) & 1U) != 0;
  pair.not_counted = row.not_counted.number[lane];
  pair.stored = row.stored.number[lane];
  pair.applied = row.applied.number[lane];
  pair.lost_area = row.lost_area.number[lane];
  pair.lost_damping = row.lost_damping.number[lane];
  for (int k = 0; k < 2; ++k) {
    PairEnd& end = pair.ends[k];
    end.area = row.area[k].number[lane];
    end.held = row.held[k].number[lane];
    end.shift = row.shift[k].number[lane];
    end.rest = row.rest[k].number[lane];
    end.damped = row.damped[k].number[lane];
    for (int i = 0; i < law.internals; ++i)
      pair.internals[k * law.internals + i] =
          arrays.internals[row.first_internal + k * law.internals + i].number[lane];
  }
  for (int i = 0; i < law.losses; ++i) pair.lost[i] = arrays.lost[row.first_loss + i].number[lane];
  if (was_handed_over &&
      !pair.is_handed_over) {  // the sides have left each other: what follows is a new pair
    pair.ratio = 1.0;
    for (PairEnd& end : pair.ends) end.offset = 0.0;
  }
}

double stored_by(const FoundData& found) {
  double sum = 0.0;
  for (const FoundPair& pair : found.pairs)
    sum +=
        pair.slot < 0 ? pair.stored : found.arrays.rows[pair.slot / kLanes].stored.number[pair.slot % kLanes];
  return sum;
}

double applied_by(const FoundData& found) {
  double sum = 0.0;
  for (const FoundPair& pair : found.pairs)
    sum += pair.slot < 0 ? pair.applied
                         : found.arrays.rows[pair.slot / kLanes].applied.number[pair.slot % kLanes];
  return sum;
}

void FoundContacts::visit_state(StateVisitor& visitor) {
  const StateVisitor::Scope scope(visitor, "found");
  std::vector<int> faces, keys;
  std::vector<double> numbers;
  const auto each_number = [](FoundPair& pair, auto f) {
    f(pair.ratio), f(pair.not_counted), f(pair.stored), f(pair.applied), f(pair.lost_area),
        f(pair.lost_damping);
    for (PairEnd& end : pair.ends)
      f(end.area), f(end.held), f(end.shift), f(end.offset), f(end.rest), f(end.damped);
    for (double& number : pair.internals) f(number);
    for (double& number : pair.lost) f(number);
  };
  if (!visitor.replaces()) {
    take_back();
    for (int face = 0; face < std::ssize(found_.is_handed_over); ++face)
      if (found_.is_handed_over[face]) faces.push_back(face);
    for (FoundPair& pair : found_.pairs) {
      if (!pair.remembers() && !pair.has_lost()) continue;
      keys.insert(keys.end(), {pair.facets[0], pair.facets[1], pair.is_handed_over ? 1 : 0});
      each_number(pair, [&](double& number) { numbers.push_back(number); });
    }
  }
  visitor.visit("handed_over", faces, state::index(found_.is_handed_over.size()));
  visitor.visit("pairs", keys, state::index(found_.facets.size()));
  visitor.visit("numbers", numbers);
  if (!visitor.replaces()) return;

  std::fill(found_.is_handed_over.begin(), found_.is_handed_over.end(), false);
  for (BlockFacet& facet : found_.facets) facet.is_free = facet.face < 0;
  for (const int face : faces) mark_handed_over(face);
  found_.pairs.clear();
  visitor.require(keys.size() % 3 == 0, "pairs", "is cut off");
  std::size_t taken = 0;
  for (std::size_t i = 0; i + 2 < keys.size(); i += 3) {
    const Key key{keys[i], keys[i + 1]};
    visitor.require(key[0] < key[1] && (found_.pairs.empty() || found_.pairs.back().facets < key), "pairs",
                    "are not in order");
    visitor.require(found_.facets[key[0]].block != found_.facets[key[1]].block, "pairs", "are of one block");
    visitor.require(found_.facets[key[0]].is_free && found_.facets[key[1]].is_free, "pairs",
                    "names a facet that is not free");
    const bool is_handed_over = keys[i + 2] != 0;
    visitor.require(!is_handed_over || face_of(key) >= 0, "pairs", "hands over facets of two faces");
    FoundPair pair = new_pair(key);
    pair.is_handed_over = is_handed_over;
    each_number(pair, [&](double& number) {
      visitor.require(taken < numbers.size(), "numbers", "are fewer than the pairs have");
      number = numbers[taken++];
    });
    found_.pairs.push_back(std::move(pair));
  }
  visitor.require(taken == numbers.size(), "numbers", "are more than the pairs have");
  bury_gone();
  forget_lists();
}

}  // namespace pyroclast
