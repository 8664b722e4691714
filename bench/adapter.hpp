#pragma once

#include "pyroclast/mechanics/mechanics.hpp"
#include "textbook.hpp"

/// All that the bench asks of a body beyond loading and moving it.
namespace bench {

/// What one step of a body costs at least, counted.
struct StepCost {
  double flops = 0.0;        ///< floating point operations in lanes that are in use
  double bytes = 0.0;        ///< each array read once and written once, see traffic() in counting.hpp
  double working_set = 0.0;  ///< of all arrays that the step touches, bytes
  double memory = 0.0;       ///< of all arrays of state and layout, bytes
};

/// Share of contact points with damage.
template <int Dim>
double damaged_share(const pyroclast::Mechanics<Dim>& body);
template <int Dim>
double damaged_share(const textbook::Body<Dim>& body);

/// Takes two steps of the body with numbers that count; the first, which is not measured, gives the
/// operations. They are counted as written: a negation is a subtraction, and a compiler may leave some out.
/// Idle lanes do what the others do and are taken off by their share among contact points and among zones.
template <int Dim>
StepCost step_cost(pyroclast::Mechanics<Dim>& body);

}  // namespace bench
