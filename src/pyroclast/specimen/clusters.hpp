#pragma once

#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Blocks of one phase that are joined by edges.
struct Cluster {
  int phase = -1;      ///< index into Specimen::phases; -1: there is none
  double area = 0.0;   ///< m²
  double share = 0.0;  ///< share of the area of all blocks of the phase
};

/// Returns the cluster that holds the largest share of its phase. The matrix does not count, for it is one
/// cluster anyhow.
Cluster largest_cluster(const Specimen& specimen);

/// Returns a line that says where stones form a skeleton: a cluster of a quarter of the aggregate or more
/// that is twice as large as the largest stone. Empty where there is none.
std::string skeleton(const Specimen& specimen);

}  // namespace pyroclast::specimen
