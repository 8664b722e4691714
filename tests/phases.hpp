#pragma once

#include "pyroclast/model/concrete_model.hpp"

/// Phases of a specimen of aggregate and mortar, and the interfaces between them, for tests.
namespace pyroclast {

enum MaterialIndex : int { aggregate_material, mortar_material };
enum InterfaceIndex : int { aggregate_aggregate, aggregate_mortar, mortar_mortar };

}  // namespace pyroclast
