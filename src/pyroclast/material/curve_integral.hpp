#pragma once

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Integral of a curve from a to b (a <= b, within its range) to about 1e-13 of the integral of its
/// magnitude; kinks and jumps between are found. For intervals short enough that three points on each half
/// see what the curve does.
double integral(const Curve& curve, double a, double b);

}  // namespace pyroclast
