#pragma once

#include <optional>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/model/model.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Materials of a concrete model are the phases of the specimen and last the platens' steel; interfaces are
/// those between phases and last that of the platens.
inline int platen_material(const Model<2>& model) {
  return static_cast<int>(model.material_names.size()) - 1;
}
inline int platen_interface(const Model<2>& model) {
  return static_cast<int>(model.interface_names.size()) - 1;
}

/// A specimen as a model, between two platens or without. Its sets of gridpoints:
///
/// | set | holds |
/// |---|---|
/// | `bottom_support`, `top_support` | outer faces of the platens, left to right |
/// | `bottom_face`, `top_face` | inner faces of the platens, left to right |
/// | `top_platen` | all of the upper platen |
/// | `bottom`, `top`, `left`, `right` | sides of the specimen: each edge's two gridpoints |
/// | `specimen` | all of the specimen |
///
/// \param platen_thickness  m; without one there are no platens, and the sets of them are empty
/// \param thickness         of the specimen, out of plane, m
/// \param interfaces        of the deck, see InterfaceTable
///
/// Each platen is one block as wide as the specimen, its inner face zoned to meet the specimen's gridpoints.
Model<2> make_concrete_model(const specimen::Specimen& specimen, std::optional<double> platen_thickness,
                             double thickness, const std::vector<InterfaceParameters>& interfaces = {});

}  // namespace pyroclast
