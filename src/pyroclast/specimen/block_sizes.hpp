#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/region.hpp"

namespace pyroclast::specimen {

/// Growth of the block size over the distance: each block is larger than the one before by a fifth at most.
inline constexpr double kBlockGrowth = 0.2;

/// Part of a body near which blocks are finer.
struct FinerPart {
  std::vector<std::array<Vec<2>, 2>> pieces =
      {};                       ///< straight pieces from end to end, m; a point has no length
  std::optional<Box> box = {};  ///< box that belongs to it, with all within
  double size = 0.0;            ///< size of blocks there, m
  double distance = 0.0;        ///< distance up to which blocks have this size, m
  std::string name = {};        ///< name in the deck; may be empty
};

/// Sizes that blocks have over a body: at each place the root of the area of a block, m.
class BlockSizes {
 public:
  /// Makes blocks alike.
  explicit BlockSizes(double size) : mean_(size), largest_(size) {}
  /// Makes blocks finer near some parts.
  /// \param mean     root of the body's area over the number of its blocks, m
  /// \param largest  size far from all parts, m
  BlockSizes(double mean, double largest, std::vector<FinerPart> finer)
      : mean_(mean), largest_(largest), finer_(std::move(finer)) {}

  bool is_even() const { return finer_.empty(); }
  double mean() const { return mean_; }        ///< Returns the root of the mean area of a block, m.
  double at(const Vec<2>& place) const;        ///< Returns the size of blocks at a place, m.
  double relative(const Vec<2>& place) const;  ///< Returns the size at a place over the mean.
  double smallest() const;                     ///< Returns the size in the finest part, m.
  double largest() const { return largest_; }  ///< Returns the size far from all parts, m.
  BlockSizes scaled_to(double mean) const;     ///< Returns the sizes in proportion, with another mean, m.

 private:
  double mean_, largest_;
  double scale_ = 1.0;  ///< factor of the sizes that the parts ask for
  std::vector<FinerPart> finer_;
};

/// Area of a region in boxes that are no larger than the blocks there.
class SizedArea {
 public:
  SizedArea(const Region& region, const std::vector<FinerPart>& finer);

  /// Returns how many blocks the region has: the integral of 1 / size².
  /// \param largest  size far from all parts, m
  double blocks(double largest) const;
  /// Returns the size far from all parts with which the region has so many blocks, m; none where the finer
  /// parts and their surroundings take more.
  std::optional<double> largest_for(double count) const;

 private:
  struct Piece {
    double area, size;
  };
  std::vector<Piece> pieces_;
};

/// Draws places in a region at random, in each area as many as it has blocks.
class PlaceDraw {
 public:
  PlaceDraw(const Region& region, const BlockSizes& sizes);
  /// Returns a place of the region's box; at the outline it may lie a block outside of the region.
  Vec<2> draw(Random& random) const;

 private:
  const BlockSizes& sizes_;
  struct Part {
    Box box;
    double least;  ///< lower bound of the size, m
  };
  std::vector<Part> parts_;
  std::vector<double> up_to_;  ///< blocks in all parts up to each one
};

}  // namespace pyroclast::specimen
