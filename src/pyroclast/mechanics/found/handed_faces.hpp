#pragma once

#include <vector>

#include "pyroclast/mechanics/body.hpp"
#include "pyroclast/mechanics/found/pair_facts.hpp"

namespace pyroclast {

/// Faces that are handed over: tells which are due, and puts pairs of their two sides in the places of their
/// contacts.
template <int Dim>
class HandedFaces {
 public:
  explicit HandedFaces(Body<Dim>& body) : body_(body), found_(*body.found), facts_(body) {}

  /// Returns the faces of the whole body that are to be handed over, those whose contact points are all
  /// broken and bearings whose sides have slid: a collective.
  std::vector<int> due() const;
  /// Hands faces over to pairs, with all that the contact points remember. Returns which facets may press
  /// from now on.
  std::vector<bool> hand_over(const std::vector<int>& faces);
  /// Forgets the pairs of blocks that are gone, but for what they lost, and frees what such blocks covered.
  /// Returns which facets may press from now on.
  std::vector<bool> forget_gone();
  /// Frees the facets of a face and leaves its contacts out.
  void mark(int face);
  /// Takes the facets of gone blocks out of all searches.
  void bury_gone();

 private:
  std::vector<FoundPair<Dim>> pairs_of(int face) const;

  Body<Dim>& body_;
  FoundData<Dim>& found_;
  PairFacts<Dim> facts_;
};

extern template class HandedFaces<2>;
extern template class HandedFaces<3>;

}  // namespace pyroclast
