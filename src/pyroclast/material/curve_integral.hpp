#pragma once

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Returns the integral of a curve from a to b (a <= b, within its range) to about 1e-13 of the integral of
/// its magnitude; kinks and jumps in between are found. The interval must be so short that three points on
/// each half show how the curve runs.
double integral(const Curve& curve, double a, double b);

}  // namespace pyroclast
