#pragma once

#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/cells.hpp"

namespace pyroclast::specimen {

/// Draws seeds at random that keep a distance of 0.62 of the size of blocks there, so that no cell dies out,
/// and numbers them along Morton's curve, so that cells with near numbers lie near each other. Throws Error
/// when there is no place for so many blocks of these sizes.
/// \param count   number of seeds, 1 or more
/// \param spread  spread of the radii, which are uniform in [1 - spread, 1 + spread] x size / 2
Seeds<3> spaced_seeds(const Prism& body, const BlockSizes& sizes, int count, double spread, Random& random);
/// The same for blocks alike.
Seeds<3> spaced_seeds(const Prism& body, int count, double spread, Random& random);

/// Draws some of the seeds anew, which keep their distance from all others, and their radii over the size of
/// blocks there.
void redraw(Seeds<3>& seeds, const std::vector<int>& which, const Prism& body, const BlockSizes& sizes,
            Random& random);

}  // namespace pyroclast::specimen
