#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Box, in the reference configuration, as the other places; bounds belong to a place. Lengths in m.
struct InBox {
  Vec<3> low, high;
};
struct InBall {  ///< ball; a disc in 2D
  Vec<3> centre;
  double radius = 0.0;
};
struct OnLine {  ///< straight line, from end to end
  Vec<3> from, to;
};
struct NearestTo {
  Vec<3> point;
};
struct Everywhere {};
using Place = std::variant<Everywhere, InBox, InBall, OnLine, NearestTo>;

/// Kind of things from which a set is chosen. A contact lies where its gridpoint on side a lies.
enum class SetOf : std::uint8_t {
  gridpoints,
  faces,   ///< gridpoints of the faces that meet no other block and lie wholly in the place
  blocks,  ///< gridpoints of the blocks whose centroids lie in the place
  contacts,
};

/// Named set of a model that is asked for. The nearest face or block to a point is the one with the nearest
/// middle.
struct SetParameters {
  std::string name;
  SetOf of = SetOf::gridpoints;
  std::string within = "";  ///< set of contacts for contacts, else set of gridpoints; empty: all of the model
  Place place;
  /// True for a place that is meant for all z: the third coordinates of the place and of the body are not
  /// read.
  bool is_along_z = false;
  std::string deck_place = "";  ///< place in the deck that asks for the set, for messages
};

/// Adds the sets to the model, in turn. Throws Error, naming the set and its place in the deck, when a set is
/// empty, has the name of another set, lies within a set that does not exist, or is nearest to a place that
/// lies farther from the body than a block is wide.
void add_sets(Model& model, const std::vector<SetParameters>& sets);

/// Makes sides of the specimen planes of symmetry, each with its set of gridpoints, see PlaneOfSymmetry.
void add_symmetry(Model& model, const std::vector<PlaneOfSymmetry>& planes);

using NamedSets = decltype(Model::sets);

/// Returns, for messages, the names of the sets that are not empty, "outline, specimen"; "none" where all are
/// empty.
std::string names_of(const NamedSets& sets);

/// Face of the outline of a body, whatever its dimension.
struct Face {
  std::array<int, 3> corner{};  ///< gridpoints in the order that makes the normal right-handed
  int corners = 0;              ///< number of gridpoints: 2 in 2D, 3 in 3D
  Vec<3> centre;                ///< m
  Vec<3> normal;                ///< unit normal, outward
  double area = 0.0;            ///< m² (2D: length times thickness)

  std::span<const int> gridpoints() const { return {corner.data(), static_cast<std::size_t>(corners)}; }
};

/// Returns the faces that meet no other block, in the order of their zones.
std::vector<Face> faces_of(const Model& model);
/// Returns those of these faces that lie wholly in a set.
std::vector<Face> faces_in(const Model& model, const std::vector<int>& set);

/// Returns the area, m², that each gridpoint of a set has of the faces in the set: half of an edge times the
/// thickness in 2D, a third of a triangle in 3D. All are zero where the set has no face.
std::vector<double> tributary_areas(const std::vector<int>& set, const std::vector<Face>& faces);

/// Returns the centroid of each block, m; in 2D the third component is 0.
std::vector<Vec<3>> block_centroids(const Model& model);

}  // namespace pyroclast
