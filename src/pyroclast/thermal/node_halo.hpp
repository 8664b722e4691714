#pragma once

#include "pyroclast/model/item_halo.hpp"
#include "pyroclast/thermal/thermal_mesh.hpp"

namespace pyroclast {

/// Returns the halo of the thermal nodes of a part of a body: a collective. A node is known by any of its
/// gridpoints: the owner has them all, and the first that another part has need not be the first of the
/// whole.
/// \param chunks  chunks of the nodes
ItemHalo node_halo(const Model& model, const ThermalNodes& nodes, const ChunkList& chunks);

}  // namespace pyroclast
