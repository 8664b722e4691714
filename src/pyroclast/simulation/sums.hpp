#pragma once

#include "pyroclast/base/chunked_sum.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

namespace pyroclast {

/// Returns the mean of one component of the positions of a set in the reference configuration, m.
template <int Dim>
double mean_position(const Model<Dim>& model, const GridpointSet& set, int axis) {
  const double sum = chunked_sum(set.chunks, [&](int i) { return model.position[set.gridpoints[i]][axis]; });
  return sum / set.chunks.own_items();
}

}  // namespace pyroclast
