#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/edge_pair.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/model/part.hpp"

namespace pyroclast {

/// Finder of contacts of a body: makes the data, searches for pairs, hands broken faces over to pairs,
/// and keeps the pairs' history. The step works on rows of pairs, see FoundContactForces.
template <int Dim>
class FoundContacts {
 public:
  explicit FoundContacts(Body<Dim>& body) : body_(body), found_(*body.found) {}

  /// Makes the data of a body whose parameters say so. Throws Error where its kinematics or the laws of its
  /// interfaces do not allow it.
  static void make(Body<Dim>& body);

  /// Searches for the pairs at the beginning of a run; where blocks lie in each other already, that part of
  /// their overlap does not count.
  void begin();
  /// Searches for pairs where gridpoints have gone too far since the last search: a collective, but where
  /// the properties have just changed and `take_from_owners` came before.
  void search_where_needed();
  /// Gives all foreign gridpoints the displacements and velocities that their owners have: a collective.
  void take_from_owners();
  /// Returns the gridpoints that pairs in rows share with each of the other ranks.
  std::map<int, SharedGridpoints> shared_gridpoints() const;
  /// Hands faces over to pairs whose contact points are all broken, and bearings whose sides have slid, with
  /// all that the points remember.
  void hand_over();
  /// Forgets the pairs of blocks that are gone, but for what they lost, and frees what such blocks covered.
  void forget_gone();
  /// Lets the rows follow new properties: every end goes through its law in the next step.
  void follow_properties();
  /// Lets the damping follow new masses.
  void follow_masses();
  /// Adds the stiffness that free facets may meet to that of their gridpoints, and that of faces beyond their
  /// own contacts', N/m.
  void add_stiffness(std::vector<double>& of_gridpoints) const;
  void visit_state(StateVisitor& visitor);

 private:
  using Key = std::array<int, 2>;
  using Pair = FoundPair<Dim>;
  /// Places of the corners of a pair: those of a, then of b, m.
  using Corners = std::array<Vec<Dim>, 2 * Dim>;
  Vec<Dim> place(int gridpoint, const FlatArray<Vec<Dim>>& displacement) const;
  template <class Place>
  Corners places(const Key& key, Place place) const;
  double most_depth(const Key& key) const;
  std::array<int, 2 * Dim> corners(const Key& key) const;
  std::uint32_t joined_corners(const Key& key) const;
  void place_shape(const Pair& pair, int row, int lane);
  bool holds_together(int a, int b) const;
  int interface_of(const Key& key) const;
  int face_of(const Key& key) const;
  int set_of(const Pair& pair, int place) const;
  std::array<int, kSetsOfPair<Dim>> sets_of(const Pair& pair) const;
  int set_of_interface(int interface) const;
  const LawTable& law_of(const Pair& pair) const;
  int law_index(const Pair& pair) const;
  double damping_of(const Pair& pair, double stiffness) const;
  const ConstantsOfSet& constants_of(int set) const;
  Pair new_pair(const Key& key) const;

  bool is_own(const Key& key) const;

  struct Box {
    Vec<Dim> low, high;
  };
  void find_far();
  std::optional<Box> box_of(int facet) const;
  void list_if_far(int a, const Box& box_a, int b, const Box& box_b);
  void add_to_far(const std::vector<int>& facets);
  void sort_far();
  void watch();
  std::vector<double> ways(double steps, double least, double most) const;
  bool find_near();
  double way_to_press(const Key& key, const Corners& at, double within) const;
  double way_to_change(const Pair& pair, const Corners& at, double within) const;
  double wakes(const Key& key, const Pair* handed_over) const;
  void let_sleep();
  void search();
  void make_rows();
  void put_into_row(const Pair& pair, int row, int lane);
  void list_loads();
  void take_back();
  void mark_handed_over(int face);
  void bury_gone();
  std::vector<int> faces_to_hand_over() const;
  bool has_slid(int face) const;
  bool may_meet(const Key& key) const;
  std::vector<Pair> pairs_of_face(int face) const;
  double shear_stiffness_of(int contact) const;
  void take_history(const TrianglePair<double>& p, int points, int first, int last, Pair& pair) const;
  void leave_out_overlaps(const std::vector<bool>& fresh, double tolerance);
  void forget_lists();

  Body<Dim>& body_;
  FoundData<Dim>& found_;
};

extern template class FoundContacts<2>;
extern template class FoundContacts<3>;

/// Gives a pair the numbers that it has in its row; does nothing where it stands in none.
template <int Dim>
void take_from_row(const FoundData<Dim>& found, FoundPair<Dim>& pair);
/// Returns what pairs of the whole body give, in the order of their keys: a collective. So sums over pairs
/// depend neither on ranks nor on chunks. A pair counts for the owner of the block of its first facet.
/// \tparam Given  plain data
/// \param give     `give(pair, add)` calls `add` with what an own pair gives, any number of times
/// \param to_all  false: the first rank alone gets it
template <class Given, int Dim, class Give>
std::vector<Given> of_all_pairs(const Body<Dim>& body, Give give, bool to_all = true,
                                CallPlace at = CallPlace::here()) {
  struct OfPair {
    std::array<int, 2> key;
    Given given;
  };
  const FoundData<Dim>& found = *body.found;
  Ranks& ranks = body.model.ranks();
  const auto own = [&] {
    std::vector<OfPair> given;
    for (const FoundPair<Dim>& pair : found.pairs)
      if (found.rank_of_block.empty() ||
          found.rank_of_block[found.facets[pair.facets[0]].block] == ranks.me())
        give(pair, [&](const Given& one) { given.push_back({pair.facets, one}); });
    return given;
  };
  auto all = to_all ? ranks.collect_made<OfPair>(own, at) : ranks.collect_at_first(own(), at);
  if (ranks.count() > 1) std::ranges::stable_sort(all, {}, &OfPair::key);
  std::vector<Given> result;
  result.reserve(all.size());
  for (const OfPair& one : all) result.push_back(one.given);
  return result;
}

/// Returns the energy that found pairs store, J: a collective.
template <int Dim>
double stored_by(const Body<Dim>& body);
/// Returns the sum of the magnitudes of the forces of found pairs, N: a collective.
template <int Dim>
double applied_by(const Body<Dim>& body);

/// Energies that a pair has lost, J.
struct LossesOfPair {
  int law = 0;                                       ///< entry of State::laws
  std::array<double, LawOfRows::kMost> of_law = {};  ///< those of its law, in the law's order
  double area = 0.0, damping = 0.0;                  ///< lost where the area changes, and to damping
};
/// Returns the losses of the pairs that have lost something, in the order of their keys: a collective.
template <int Dim>
std::vector<LossesOfPair> losses_of_pairs(const Body<Dim>& body);

}  // namespace pyroclast
