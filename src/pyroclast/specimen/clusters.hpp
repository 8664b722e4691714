#pragma once

#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Blocks of one phase that hang together by edges.
struct Cluster {
  int phase = -1;      ///< index into Specimen::phases; -1: there is none
  double area = 0.0;   ///< m²
  double share = 0.0;  ///< of the area of all blocks of the phase
};

/// The one that holds the largest share of its phase; the matrix does not count, for it is one anyhow.
Cluster largest_cluster(const Specimen& specimen);

/// A line that says so where stones form a skeleton: a cluster of a quarter of the aggregate or more that is
/// twice as large as the largest stone; empty where none does.
std::string skeleton(const Specimen& specimen);

}  // namespace pyroclast::specimen
