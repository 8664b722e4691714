#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/cells.hpp"
#include "pyroclast/specimen/stone_grid.hpp"

namespace pyroclast::specimen {

/// Draws seeds in a body that keep their distance: balls that may touch.
class SpacedSeedDraw {
 public:
  /// Tells whether a seed may stand at a place, from the place and the number of places tried before.
  using Allows = std::function<bool(const Vec<3>& place, int tried)>;

  /// \param sizes   sizes of blocks, which must outlive it, as the body and `random` must
  /// \param allows  further condition; empty: none
  SpacedSeedDraw(const Prism& body, const BlockSizes& sizes, Random& random, Allows allows = {});

  void add(const Vec<3>& point);  ///< Adds a seed that stands already.
  /// Draws a seed at a place with room. Throws Error where none is found.
  Vec<3> draw();

 private:
  Vec<3> anywhere();

  const Prism& body_;
  const BlockSizes& sizes_;
  Random& random_;
  Allows allows_;
  std::optional<PlaceDraw<3>> places_;  ///< where blocks are not alike
  StoneGrid<3> grid_;
};

/// Returns the numbers of places in the order in which Morton's curve through the body's box meets them.
std::vector<std::size_t> order_along_curve(const std::vector<Vec<3>>& places, const Prism& body);

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
