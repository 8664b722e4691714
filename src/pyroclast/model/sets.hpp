#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Where something may lie, in the reference configuration; bounds belong to it. Lengths in m.
template <int Dim>
struct InBox {
  Vec<Dim> low, high;
};
template <int Dim>
struct InBall {  ///< a disc in 2D
  Vec<Dim> centre;
  double radius = 0.0;
};
template <int Dim>
struct OnLine {  ///< straight, from end to end
  Vec<Dim> from, to;
};
template <int Dim>
struct NearestTo {
  Vec<Dim> point;
};
struct Everywhere {};
template <int Dim>
using Place = std::variant<Everywhere, InBox<Dim>, InBall<Dim>, OnLine<Dim>, NearestTo<Dim>>;

/// A named set of a model that is asked for.
template <int Dim>
struct SetParameters {
  std::string name;
  bool of_contacts = false;     ///< of contacts, else of gridpoints
  std::string within = "";      ///< another set of the same kind; empty: all of the model
  Place<Dim> place;             ///< of a contact: of its gridpoint on side a
  std::string deck_place = "";  ///< where it is asked for, for messages
};

/// Adds the sets to the model, in turn. Throws Error, naming the set and its place, when one is empty, has
/// the name of another, or lies within one that there is not.
template <int Dim>
void add_sets(Model<Dim>& model, const std::vector<SetParameters<Dim>>& sets);

/// What belongs to each gridpoint of a set of the faces of its blocks that lie wholly in the set and meet no
/// other block: half of an edge times the thickness in 2D, a third of a triangle in 3D, m². All zero where
/// the set has no such face.
template <int Dim>
std::vector<double> tributary_areas(const Model<Dim>& model, const std::vector<int>& set);

extern template void add_sets(Model<2>&, const std::vector<SetParameters<2>>&);
extern template void add_sets(Model<3>&, const std::vector<SetParameters<3>>&);
extern template std::vector<double> tributary_areas(const Model<2>&, const std::vector<int>&);
extern template std::vector<double> tributary_areas(const Model<3>&, const std::vector<int>&);

}  // namespace pyroclast
