#pragma once

#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Faces whose sides no longer face each other, with finite kinematics: sides that have turned against each
/// other by more than 90 degrees, and broken ones that have slid past each other. The frame of a face is the
/// mean of both sides, which vanishes at half a turn: no law holds through that. Such a face is torn for
/// good: its contact points are broken, it bears nothing, and no water presses in it. Faces of laws that lose
/// no energy hold what is broken, and are never torn.
template <int Dim>
class TornFaces {
 public:
  explicit TornFaces(Body<Dim>& body) : body_(body) {}

  /// Returns the faces that are to be torn at the present displacements.
  std::vector<int> faces_to_tear() const;
  /// Breaks the points of faces by their laws. What they held counts as the first energy that their law
  /// loses. Where contacts are found, broken points go on to bear what they bear until they are handed over.
  void tear(const std::vector<int>& faces);
  /// Takes the pressure of water off the contacts of torn faces.
  void drain(BodyProperties& properties) const;
  /// Shows the torn faces to a visitor.
  void visit_state(StateVisitor& visitor);

 private:
  bool have_turned_apart(int face) const;
  bool have_slid_past(int face) const;
  void break_points(int face);
  void mark(int face);

  Body<Dim>& body_;
};

extern template class TornFaces<2>;
extern template class TornFaces<3>;

}  // namespace pyroclast
