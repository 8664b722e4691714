#include "pyroclast/mechanics/found/found_contacts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "pyroclast/mechanics/found/of_all_pairs.hpp"
#include "pyroclast/mechanics/reader.hpp"

namespace pyroclast {

namespace {

/// Depth over the length of an edge that counts as touching where blocks are placed.
constexpr double kTouching = 1e-6;

}  // namespace

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

/// Finds the near pairs. Rows stay where they hold the same pairs.
template <int Dim>
void FoundContacts<Dim>::search() {
  rows_.take_back();
  take_from_owners();
  if (search_.find())
    found_.has_rows = false;
  else if (found_.has_rows)
    rows_.let_sleep();
}

/// Searches where facets may press that could not before.
/// \param fresh, tolerance  see PairSearch::leave_out_overlaps
template <int Dim>
void FoundContacts<Dim>::begin_with(const std::vector<bool>& fresh, double tolerance) {
  search();
  search_.leave_out_overlaps(fresh, tolerance);
  rows_.make();
}

template <int Dim>
void FoundContacts<Dim>::begin() {
  begin_with(std::vector<bool>(found_.facets.size(), true), kTouching);
}

template <int Dim>
void FoundContacts<Dim>::search_where_needed() {
  const auto watched = static_cast<int>(found_.arrays.watched.size());
  Ranks& ranks = body_.model.ranks();
  if (found_.has_near)
    found_.seen.way = ranks.largest(body_.step.passes.way_of_found(body_.state, 0, watched));
  if (!found_.has_near || !(found_.seen.way <= 1.0)) {
    search();
    found_.seen.way = 0.0;
  }
  if (!found_.has_rows) rows_.make();
}

template <int Dim>
void FoundContacts<Dim>::hand_over() {
  const std::vector<int> faces = faces_.due();
  if (faces.empty()) return;
  rows_.take_back();
  take_from_owners();
  const std::vector<bool> fresh = faces_.hand_over(faces);
  search_.add_to_far(faces);
  begin_with(fresh, 0.0);
}

template <int Dim>
void FoundContacts<Dim>::forget_gone() {
  rows_.take_back();
  const std::vector<bool> fresh = faces_.forget_gone();
  leave_rows();
  found_.has_far = false;
  begin_with(fresh, 0.0);
}

/// Takes all pairs out of the rows; near ones are to be found anew.
template <int Dim>
void FoundContacts<Dim>::leave_rows() {
  for (Pair& pair : found_.pairs) pair.slot = -1;
  found_.has_near = found_.has_rows = false;
  found_.constants.clear();
}

template <int Dim>
void FoundContacts<Dim>::follow_properties() {
  rows_.take_back();
  leave_rows();
  for (Pair& pair : found_.pairs) {
    pair.sets = Pair::not_known();
    for (PairPoint<Dim>& point : pair.points)
      if (pair.is_handed_over && point.area == 0.0) point.rest = std::numeric_limits<double>::max();
  }
}

template <int Dim>
void FoundContacts<Dim>::follow_masses() {
  rows_.take_back();
  found_.has_rows = false;
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
    rows_.take_back();
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
  for (const int face : faces) faces_.mark(face);
  found_.pairs.clear();
  visitor.require(keys.size() % 3 == 0, "pairs", "is cut off");
  const PairFacts<Dim> facts(body_);
  std::size_t taken = 0;
  for (std::size_t i = 0; i + 2 < keys.size(); i += 3) {
    const PairKey key{keys[i], keys[i + 1]};
    visitor.require(key[0] < key[1] && (i == 0 || PairKey{keys[i - 3], keys[i - 2]} < key), "pairs",
                    "are not in order");
    visitor.require(found_.facets[key[0]].block != found_.facets[key[1]].block, "pairs", "are of one block");
    visitor.require(found_.facets[key[0]].is_free && found_.facets[key[1]].is_free && found_.may_meet(key),
                    "pairs", "names a facet that is not free");
    const bool is_handed_over = keys[i + 2] != 0;
    visitor.require(!is_handed_over || found_.face_of(key) >= 0, "pairs", "hands over facets of two faces");
    Pair pair = facts.new_pair(key);
    pair.is_handed_over = is_handed_over;
    each_number(pair, [&](double& number) {
      visitor.require(taken < numbers.size(), "numbers", "are fewer than the pairs have");
      number = numbers[taken++];
    });
    if (found_.is_of_rank(body_.model.ranks().me(), key)) found_.pairs.push_back(std::move(pair));
  }
  visitor.require(taken == numbers.size(), "numbers", "are more than the pairs have");
  faces_.bury_gone();
  leave_rows();
  found_.has_far = found_.knows_all = false;
}

template class FoundContacts<2>;
template class FoundContacts<3>;

}  // namespace pyroclast
