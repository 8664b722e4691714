#pragma once

#include <string>

namespace pyroclast {

/// Choice of the contacts of a body.
struct FoundParameters {
  bool is_on =
      false;  ///< true where blocks that part may meet others; else contacts join the faces of the start
  /// Interface that gives blocks their law where none or several interfaces join their materials; empty: the
  /// first one.
  std::string like;
  /// Share of critical damping while pairs press: that of a block on its contact. It never pulls.
  double damping = 0.0;
  // The parameters from here on change speed, not results.
  double skin = 0.02;    ///< least distance beyond which pairs are not listed as far, over the mean edge
  double reach = 0.001;  ///< likewise of near pairs
  /// Steps that the fastest gridpoint of a block takes to the end of that block's lists of near pairs; more
  /// steps mean fewer searches, and more pairs in each.
  double steps = 250.0;
};

}  // namespace pyroclast
