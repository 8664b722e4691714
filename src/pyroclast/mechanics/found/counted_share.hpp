#pragma once

#include "pyroclast/base/lanes.hpp"

namespace pyroclast {

/// Share of a contact point's part of the overlap that counts, and its slope by `depth`. All of it counts
/// while the facets are less deep in each other than their overlap is wide, nothing where they are thrice as
/// deep: facets that pass a corner do not begin to press at once. Where the overlap is wide a third of the
/// largest depth stands in its place: the far sides of two blocks that touch face each other too.
template <class Real>
struct CountedShare {
  Real depth = 0.0;  ///< depth over the width of the overlap, or over a third of the largest depth
  Real share = 0.0, slope = 0.0;
  static constexpr double kMost = 3.0;  ///< depth from which on nothing counts

  CountedShare() = default;
  explicit CountedShare(const Real& of) : depth(of) {
    const Real y = smaller(larger((depth - Real(1.0)) * Real(1.0 / (kMost - 1.0)), Real(0.0)), Real(1.0));
    share = Real(1.0) - y * y * (Real(3.0) - Real(2.0) * y);
    slope = Real(6.0 / (kMost - 1.0)) * y * (y - Real(1.0));
  }
};

}  // namespace pyroclast
