#pragma once

#include <optional>

#include "pyroclast/mechanics/mechanics.hpp"
#include "textbook.hpp"

/// All that the bench asks of a body beyond loading and moving it.
namespace bench {

/// What one step of a body costs at least.
struct StepCost {
  double flops = 0.0;        ///< floating point operations
  double bytes = 0.0;        ///< read and written, each array once per pass
  double working_set = 0.0;  ///< of all arrays that the step touches, bytes
};

/// Share of contact points with damage.
double damaged_share(const pyroclast::Mechanics<2>& body);
double damaged_share(const textbook::Body& body);

/// Counted, not estimated; nothing where the library does not count. The report then leaves out the roofline.
std::optional<StepCost> step_cost(const pyroclast::Mechanics<2>& body);

}  // namespace bench
