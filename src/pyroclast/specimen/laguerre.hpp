#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Seeds of a Laguerre (power) tessellation: a point belongs to the seed with the least
/// |x - position|^2 - radius^2.
struct Seeds {
  std::vector<Vec<2>> position;  ///< m
  std::vector<double> radius;    ///< radius of each seed, m; all equal: a Voronoi tessellation
};

/// Tessellation, or the seeds that prevent it.
struct LaguerreResult {
  Tessellation tessellation;  ///< cell i belongs to seed i; complete only when `broken` is empty
  /// Seeds with an empty cell or one that does not match its neighbours, ascending.
  std::vector<int> broken;
};

/// Returns the Laguerre tessellation of a region, by Voro++ (Rycroft, Chaos 19, 041111, 2009). Vertices are
/// shared: those closer than 1e-8 mean spacings are one. Vertices on the outline of a rectangle, and on
/// corners of any region, lie exactly there. The result is bitwise the same for any number of threads.
/// \param team  team that shares the cells out; without a team the calling thread works alone
LaguerreResult laguerre_tessellation(const Seeds& seeds, const Region& region, Team* team = nullptr);

/// Takes Lloyd's step: every seed but the first `kept` moves to the centroid of its cell in the region's box,
/// where the centroid lies in the region; a seed with an empty cell stays. The team is as above.
/// \param sizes  sizes of blocks: where they are not alike, the area counts as size^-4, which keeps a graded
///               tessellation graded (Du, Faber and Gunzburger, SIAM Review 41, 637, 1999), and radii follow
void relax(Seeds& seeds, const Region& region, std::size_t kept = 0, Team* team = nullptr,
           const BlockSizes& sizes = BlockSizes(1.0));

}  // namespace pyroclast::specimen
