#pragma once

#include "pyroclast/material/curve_catalogue.hpp"

namespace pyroclast {

/// Returns standard fires by name: gas temperature in degC as a function of the time since ignition in s.
/// Each entry states source and range. `fire_curves().at("iso834").curve`.
const CurveCatalogue& fire_curves();

}  // namespace pyroclast
