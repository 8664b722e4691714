#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/random.hpp"
#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/room.hpp"

namespace pyroclast::specimen {

/// Growth of the block size over the distance: each block is larger than the one before by a fifth at most.
inline constexpr double kBlockGrowth = 0.2;

/// Piece of a body by its corners, m: a point, the two ends of a straight line, or the corners around a plane
/// face that is convex. In the plane z is 0.
using FinerPiece = std::vector<Vec<3>>;

/// Part of a body near which blocks are finer.
struct FinerPart {
  std::vector<FinerPiece> pieces = {};
  /// Lower and upper corner of a box that belongs to it, with all within, m.
  std::optional<std::array<Vec<3>, 2>> box = {};
  bool is_along_z = false;  ///< true where it goes along all z of a solid; then no z counts
  double size = 0.0;        ///< size of blocks there, m
  double distance = 0.0;    ///< distance up to which blocks have this size, m
  std::string name = {};    ///< name in the deck; may be empty
};

/// Sizes that blocks have over a body: at each place the root of the area of a block, in a solid the cube
/// root of its volume, m.
class BlockSizes {
 public:
  /// Makes blocks alike.
  explicit BlockSizes(double size) : mean_(size), largest_(size) {}
  /// Makes blocks finer near some parts; without any, blocks are alike.
  /// \param mean     root of the body's extent over the number of its blocks, m
  /// \param largest  size far from all parts, m
  BlockSizes(double mean, double largest, std::vector<FinerPart> finer)
      : mean_(mean), largest_(finer.empty() ? mean : largest), finer_(std::move(finer)) {}

  bool is_even() const { return finer_.empty(); }
  double mean() const { return mean_; }  ///< Returns the root of the mean extent of a block, m.
  /// Returns the size of blocks at a place, m.
  double at(const Vec<3>& place) const;
  double at(const Vec<2>& place) const { return at(resized<3>(place)); }
  /// Returns the size at a place over the mean.
  template <int Dim>
  double relative(const Vec<Dim>& place) const {
    return is_even() ? 1.0 : at(place) / mean_;
  }
  double smallest() const;                     ///< Returns the size in the finest part, m.
  double largest() const { return largest_; }  ///< Returns the size far from all parts, m.
  BlockSizes scaled_to(double mean) const;     ///< Returns the sizes in proportion, with another mean, m.

 private:
  double mean_, largest_;
  double scale_ = 1.0;  ///< factor of the sizes that the parts ask for
  std::vector<FinerPart> finer_;
};

/// Extent of a body, its area or volume, in boxes that are no larger than the blocks there.
template <int Dim>
class SizedExtent {
 public:
  SizedExtent(const Room<Dim>& body, const std::vector<FinerPart>& finer);

  /// Returns how many blocks the body has: the integral of 1 / size^Dim.
  /// \param largest  size far from all parts, m
  double blocks(double largest) const;
  /// Returns the size far from all parts with which the body has so many blocks, m; none where the finer
  /// parts and their surroundings take more.
  std::optional<double> largest_for(double count) const;

 private:
  struct Piece {
    double extent, size;
  };
  std::vector<Piece> pieces_;
};

/// Draws places in a body at random, in each part of it as many as it has blocks.
template <int Dim>
class PlaceDraw {
 public:
  /// \param sizes  sizes of blocks, which must outlive it
  PlaceDraw(const Room<Dim>& body, const BlockSizes& sizes);
  /// Returns a place of the body's box; at the surface it may lie a block outside of the body.
  Vec<Dim> draw(Random& random) const;

 private:
  const BlockSizes& sizes_;
  struct Part {
    Vec<Dim> low, high;
    double least;  ///< lower bound of the size, m
  };
  std::vector<Part> parts_;
  std::vector<double> up_to_;  ///< blocks in all parts up to each one
};

}  // namespace pyroclast::specimen
