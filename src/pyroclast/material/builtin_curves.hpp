#pragma once

#include "pyroclast/material/curve.hpp"
#include "pyroclast/material/curve_catalogue.hpp"

namespace pyroclast {

/// Returns the property curves by name, as functions of the temperature in degC; ratios are to the value at
/// 20 degC. Each entry states source, unit and range.
/// `builtin_curves().at("en1992_siliceous_strength").curve`.
const CurveCatalogue& builtin_curves();

/// Returns the specific heat of concrete [J/(kg K)], 20 to 1200 degC, for a moisture content of 0 to 3 % of
/// the concrete's weight (a percentage, not a fraction): EN 1992-1-2:2004 3.3.2(1)-(2). The peak is constant
/// from 100 to 115 degC and falls linearly to 200 degC. It is 900, 1470 and 2020 J/(kg K) at 0, 1.5 and 3 %,
/// linear in between, and never below the dry value. Throws Error outside 0 to 3 %.
Curve en1992_specific_heat(double moisture_percent);

}  // namespace pyroclast
