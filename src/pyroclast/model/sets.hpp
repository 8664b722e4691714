#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/model/outline.hpp"

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

/// What a set is chosen from. A contact is where its gridpoint on side a is.
enum class SetOf : std::uint8_t {
  gridpoints,
  faces,   ///< gridpoints of the faces that meet no other block and lie wholly in the place
  blocks,  ///< gridpoints of the blocks whose centroids lie in the place
  contacts,
};

/// A named set of a model that is asked for. What is nearest to a point is so by its middle.
template <int Dim>
struct SetParameters {
  std::string name;
  SetOf of = SetOf::gridpoints;
  std::string within = "";  ///< a set of contacts for contacts, else of gridpoints; empty: all of the model
  Place<Dim> place;
  std::string deck_place = "";  ///< where it is asked for, for messages
};

/// Adds the sets to the model, in turn. Throws Error, naming the set and its place, when one is empty, has
/// the name of another, or lies within one that there is not.
template <int Dim>
void add_sets(Model<Dim>& model, const std::vector<SetParameters<Dim>>& sets);

using NamedSets = decltype(Model<2>::sets);

/// For messages: the names of those that are not empty, "outline, specimen"; "none" where all are.
std::string names_of(const NamedSets& sets);

/// Faces that meet no other block and lie wholly in a set.
template <int Dim>
std::vector<OutlineFace<Dim>> faces_in(const Model<Dim>& model, const std::vector<int>& set);

/// What belongs to each gridpoint of a set of the faces in it: half of an edge times the thickness in 2D, a
/// third of a triangle in 3D, m². All zero where the set has no face.
template <int Dim>
std::vector<double> tributary_areas(const std::vector<int>& set, const std::vector<OutlineFace<Dim>>& faces);

extern template void add_sets(Model<2>&, const std::vector<SetParameters<2>>&);
extern template void add_sets(Model<3>&, const std::vector<SetParameters<3>>&);
extern template std::vector<OutlineFace<2>> faces_in(const Model<2>&, const std::vector<int>&);
extern template std::vector<OutlineFace<3>> faces_in(const Model<3>&, const std::vector<int>&);
extern template std::vector<double> tributary_areas(const std::vector<int>&,
                                                    const std::vector<OutlineFace<2>>&);
extern template std::vector<double> tributary_areas(const std::vector<int>&,
                                                    const std::vector<OutlineFace<3>>&);

}  // namespace pyroclast
