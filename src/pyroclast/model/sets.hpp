#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/model/outline.hpp"

namespace pyroclast {

/// Box, in the reference configuration, as the other places; bounds belong to a place. Lengths in m.
template <int Dim>
struct InBox {
  Vec<Dim> low, high;
};
template <int Dim>
struct InBall {  ///< ball; a disc in 2D
  Vec<Dim> centre;
  double radius = 0.0;
};
template <int Dim>
struct OnLine {  ///< straight line, from end to end
  Vec<Dim> from, to;
};
template <int Dim>
struct NearestTo {
  Vec<Dim> point;
};
struct Everywhere {};
template <int Dim>
using Place = std::variant<Everywhere, InBox<Dim>, InBall<Dim>, OnLine<Dim>, NearestTo<Dim>>;

/// Kind of things from which a set is chosen. A contact lies where its gridpoint on side a lies.
enum class SetOf : std::uint8_t {
  gridpoints,
  faces,   ///< gridpoints of the faces that meet no other block and lie wholly in the place
  blocks,  ///< gridpoints of the blocks whose centroids lie in the place
  contacts,
};

/// Named set of a model that is asked for. The nearest face or block to a point is the one with the nearest
/// middle.
template <int Dim>
struct SetParameters {
  std::string name;
  SetOf of = SetOf::gridpoints;
  std::string within = "";  ///< set of contacts for contacts, else set of gridpoints; empty: all of the model
  Place<Dim> place;
  std::string deck_place = "";  ///< place in the deck that asks for the set, for messages
};

/// Adds the sets to the model, in turn. Throws Error, naming the set and its place in the deck, when a set is
/// empty, has the name of another set, lies within a set that does not exist, or is nearest to a place that
/// lies farther from the body than a block is wide.
template <int Dim>
void add_sets(Model<Dim>& model, const std::vector<SetParameters<Dim>>& sets);

using NamedSets = decltype(Model<2>::sets);

/// Returns, for messages, the names of the sets that are not empty, "outline, specimen"; "none" where all are
/// empty.
std::string names_of(const NamedSets& sets);

/// Returns the faces that meet no other block and lie wholly in a set.
template <int Dim>
std::vector<OutlineFace<Dim>> faces_in(const Model<Dim>& model, const std::vector<int>& set);

/// Returns the area, m², that each gridpoint of a set has of the faces in the set: half of an edge times the
/// thickness in 2D, a third of a triangle in 3D. All are zero where the set has no face.
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
