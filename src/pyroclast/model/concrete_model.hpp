#pragma once

#include <optional>
#include <vector>

#include "pyroclast/model/model.hpp"
#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast {

/// Materials of a concrete model; indices into Model::material_names.
enum MaterialIndex : int { aggregate_material, mortar_material, platen_material };

/// Interfaces of a concrete model; indices into Model::interface_names.
enum InterfaceIndex : int { aggregate_aggregate, aggregate_mortar, mortar_mortar, platen_interface };

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
///
/// Each platen is one block as wide as the specimen, its inner face zoned to meet the specimen's gridpoints.
Model<2> make_concrete_model(const specimen::Specimen& specimen, std::optional<double> platen_thickness,
                             double thickness);

}  // namespace pyroclast
