#pragma once

#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// A block beside the specimen by which it is loaded or held: a platen, a roller's bearing, a glued end. It
/// follows the outline, and its face there is zoned to meet the specimen's gridpoints.
struct Bearing {
  std::string name;
  std::string side;        ///< or patch of the specimen that it covers
  double thickness = 0.0;  ///< m
  std::string material;    ///< as in [materials]
  std::string interface;   ///< see BearingInterface
  bool has_pivot = true;   ///< with a gridpoint in the very middle of its outer face, about which it may turn
};

/// Two bearings, `bottom_platen` and `top_platen`, over these sides of a rectangle.
std::vector<Bearing> platens(double thickness);

/// A specimen as a model, with what bears on it. Materials are the phases of the specimen, then those of the
/// bearings; interfaces those between phases, then those of the bearings. Sets of gridpoints:
///
/// | set | holds |
/// |---|---|
/// | `specimen` | all of the specimen |
/// | by the name of a phase | all blocks of it |
/// | by the name of a side or patch | of the specimen, `left` or `notch_1`: each edge's two gridpoints |
/// | by the name of a bearing | all of the bearing |
/// | `<bearing>_face` | its face at the specimen, from left to right, or upwards where it stands |
/// | `<bearing>_support` | its outer face, likewise |
/// | `<bearing>_pivot` | the gridpoint nearest to the middle of its outer face |
/// | `<notch>_left`, `<notch>_right` | the two sides of a notch without width, seen from its mouth |
///
/// Sets of contacts: by the name of a notch that has no width, those that it parts.
///
/// \param thickness   of the specimen, out of plane, m
/// \param interfaces  of the deck, see InterfaceTable
/// Throws Error, naming the bearing, when it has no side to lie on.
Model<2> make_concrete_model(const specimen::Specimen& specimen, double thickness,
                             const std::vector<InterfaceParameters>& interfaces = {},
                             const std::vector<Bearing>& bearings = {});

}  // namespace pyroclast
