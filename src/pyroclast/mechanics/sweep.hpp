#pragma once

#include <vector>

#include "pyroclast/mechanics/layout.hpp"

namespace pyroclast {

struct IndexRange {
  int first = 0, last = 0;  ///< [first, last)
};

/// What one thread does in a step.
///
/// Threads share the bundles out along the body. Faces between bundles of two threads are done first; once
/// they all are, each thread sweeps through its own: packs of faces, then the bundles whose faces are all
/// done, while they are still near in the cache.
struct Share {
  struct Stride {
    IndexRange faces, bundles;
  };
  std::vector<IndexRange> crossing;  ///< packs of faces at other threads' bundles
  std::vector<Stride> strides;
};

/// \param threads  at least 1
template <int Dim>
std::vector<Share> share_out(const Layout<Dim>& layout, int threads);

}  // namespace pyroclast
