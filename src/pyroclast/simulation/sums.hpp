#pragma once

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/model/model.hpp"

namespace pyroclast {

/// Returns the mean of one component of the positions of a set in the reference configuration, m.
inline double mean_position(const Model& model, const GridpointSet& set, int axis) {
  const double sum = chunked_sum(set.chunks, [&](int i) { return model.place(set.gridpoints[i])[axis]; });
  return sum / set.whole_count;
}

}  // namespace pyroclast
