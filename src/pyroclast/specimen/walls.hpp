#pragma once

#include <vector>

#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/cells.hpp"

namespace pyroclast::specimen {

/// Seeds in pairs on both sides of the walls of a prism's holes and notches, so that facets lie on the walls.
/// The cells within holes and notches are taken out afterwards.
struct WallSeeds {
  std::vector<Vec<3>> positions;  ///< m
  std::vector<double> radii;      ///< Laguerre radii, m
  std::vector<char> are_within;   ///< 1 for seeds within a hole or notch
};

/// Places the seeds along the walls of a body.
/// \param sizes  sizes of blocks: mean distances of seeds
WallSeeds wall_seeds(const Prism& body, const BlockSizes& sizes);

/// Returns the side of the wall that is nearest to a face, index into the sides of the body.
int nearest_wall(const Facet<3>& face, const Cells<3>& cells, const Prism& body);

/// Takes cells out. Their faces to cells that stay come to lie on the wall of the body that is nearest.
/// \param is_out  1 for each cell to be taken out
void take_out(Cells<3>& cells, const std::vector<char>& is_out, const Prism& body);

/// Throws Error where the cells of a body with holes or notches fill it badly: blocks are too large for them.
void require_filled(const Cells<3>& cells, const Prism& body, const std::string& what);

}  // namespace pyroclast::specimen
