#pragma once

#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cells, or the seeds that prevent them.
template <int Dim>
struct Laguerre {
  Cells<Dim> cells;  ///< cell i belongs to seed i; complete only when `broken` is empty
  /// Seeds with an empty cell or one that does not match its neighbours, ascending.
  std::vector<int> broken = {};
  std::vector<int> plane = {};  ///< plane of the body on which each face in space lies; -1 within it
};

/// Returns the Laguerre tessellation of a region, by Voro++ (Rycroft, Chaos 19, 041111, 2009). Vertices are
/// shared: those closer than 1e-8 mean spacings are one. Vertices on the outline of a rectangle, and on
/// corners of any region, lie exactly there. The result is bitwise the same for any number of threads.
/// \param team  team that shares the cells out; without a team the calling thread works alone
Laguerre<2> laguerre_cells(const Seeds<2>& seeds, const Region& region, Team* team = nullptr);

/// Returns the Laguerre tessellation of a body. Vertices closer than 1e-7 mean spacings are one.
Laguerre<3> laguerre_cells(const Seeds<3>& seeds, const Prism& body, Team* team = nullptr);

/// Takes Lloyd's step: every seed but the first `kept` moves to the centroid of its cell in the region's box,
/// where the centroid lies in the region; a seed with an empty cell stays. The team is as above.
/// \param sizes  sizes of blocks: where they are not alike, the area counts as size^-4, which keeps a graded
///               tessellation graded (Du, Faber and Gunzburger, SIAM Review 41, 637, 1999), and radii follow
void relax(Seeds<2>& seeds, const Region& region, std::size_t kept = 0, Team* team = nullptr,
           const BlockSizes& sizes = BlockSizes(1.0));

}  // namespace pyroclast::specimen
