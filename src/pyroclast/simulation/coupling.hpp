#pragma once

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/mechanics/mechanics.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Parameters of every zone and contact at the field's temperatures. Throws Error when a property is not
/// defined at one of them.
BodyProperties properties_at(const Model<2>& model, const ConcreteMaterials& materials,
                             const TemperatureField& field);

}  // namespace pyroclast
