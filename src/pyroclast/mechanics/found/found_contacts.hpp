#pragma once

#include <map>
#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/found.hpp"
#include "pyroclast/mechanics/found/handed_faces.hpp"
#include "pyroclast/mechanics/found/make_found.hpp"
#include "pyroclast/mechanics/found/pair_rows.hpp"
#include "pyroclast/mechanics/found/pair_search.hpp"
#include "pyroclast/model/part.hpp"

namespace pyroclast {

/// Found contacts of a body: lets rows, search and handed-over faces follow the run, each in its turn. The
/// step works on rows of pairs, see FoundContactForces.
template <int Dim>
class FoundContacts {
 public:
  explicit FoundContacts(Body<Dim>& body)
      : body_(body), found_(*body.found), rows_(body), search_(body), faces_(body) {}

  /// See make_found.
  static void make(Body<Dim>& body) { make_found(body); }

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
  /// See PairFacts.
  void add_stiffness(std::vector<double>& of_gridpoints) const {
    PairFacts<Dim>(body_).add_stiffness(of_gridpoints);
  }
  void visit_state(StateVisitor& visitor);

 private:
  using Pair = FoundPair<Dim>;
  void search();
  void begin_with(const std::vector<bool>& fresh, double tolerance);
  void leave_rows();

  Body<Dim>& body_;
  FoundData<Dim>& found_;
  PairRows<Dim> rows_;
  PairSearch<Dim> search_;
  HandedFaces<Dim> faces_;
};

extern template class FoundContacts<2>;
extern template class FoundContacts<3>;

}  // namespace pyroclast
