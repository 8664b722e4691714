#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Seeds of a Laguerre (power) tessellation: a point belongs to the seed with the least |x - position|^2 -
/// radius^2.
struct Seeds {
  std::vector<Vec<2>> position;  ///< m
  std::vector<double> radius;    ///< m, per seed; all equal: a Voronoi tessellation
};

/// A tessellation, or the seeds that stand in its way.
struct LaguerreResult {
  Tessellation tessellation;  ///< cell i belongs to seed i; complete only when `broken` is empty
  std::vector<int> broken;  ///< ascending: seeds with an empty cell or one that does not match its neighbours
};

/// The Laguerre tessellation of a region, by Voro++ (Rycroft, Chaos 19, 041111, 2009). Vertices are shared:
/// those closer than 1e-8 mean spacings are one. Those on the outline of a rectangle, and on corners of any
/// region, lie exactly there. The result is bitwise the same for any number of threads.
/// \param team  shares the cells out; one thread alone where there is none
LaguerreResult laguerre_tessellation(const Seeds& seeds, const Region& region, Team* team = nullptr);

/// Lloyd's step: every seed but the first `kept` moves to the centroid of its cell in the region's box, where
/// that lies in the region; a seed with an empty cell stays. Threads as above.
void relax(Seeds& seeds, const Region& region, std::size_t kept = 0, Team* team = nullptr);

}  // namespace pyroclast::specimen
