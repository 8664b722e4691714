#pragma once

#include <vector>

#include "pyroclast/mechanics/layout.hpp"

namespace pyroclast {

/// Work of one thread in a step.
///
/// Threads share the bundles out along the body. Faces between bundles of two threads are done first, and
/// the corner forces of large blocks, which threads share evenly. Then each thread sweeps through its own
/// part: packs of faces, then the bundles whose faces are all done, while they are still in the cache. It
/// sweeps twice: first through the bundles that lead, then through the others.
struct Share {
  struct Stride {
    IndexRange faces, bundles;
  };
  IndexRange bundles;                ///< bundles of the thread
  std::vector<IndexRange> crossing;  ///< packs of faces that touch bundles of other threads
  IndexRange corner_parts;           ///< entries of `parts` whose corner forces the thread computes
  std::vector<Stride> leading, strides;
  IndexRange moved_parts;  ///< entries of `parts` among the thread's bundles
};

/// Shares a step out to threads. Parts of large blocks lead, so that ties can end their step.
/// \param threads  at least 1
/// \param leading  other bundles that lead
template <int Dim>
std::vector<Share> share_out(const Layout<Dim>& layout, int threads, const std::vector<int>& leading = {});

}  // namespace pyroclast
