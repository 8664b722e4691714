#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/specimen/stone_grid.hpp"

namespace pyroclast::specimen {

/// Way to follow a stone.
struct WayToFollow {
  double size = 1.0;            ///< factor by which it is followed larger
  bool is_of_one_seed = false;  ///< true where a small stone must have one seed
};

/// Seeds of a tessellation that make its facets follow the surfaces of stones.
///
/// Seeds stand in pairs on both sides of a surface, so the facet between the two cells is a tangent. Each
/// stone is first drawn smaller, by the factor by which the polygon of its tangents, or the polyhedron, is
/// larger than the stone. A small stone is one cell. Where two stones are so near to each other that two rows
/// of seeds do not fit between them, they share one row in the middle of the gap. Where the outline of the
/// body cuts a stone, the stone's cells end at the outline, and no seeds stand beyond its surface.
///
/// All seeds near a surface have the same power there: r² = h² + constant, with the radius r of the seed and
/// its distance h from the surface. So the facet between two of them is where the surface is, whatever h.
template <int Dim>
class StoneSeeds {
 public:
  using Way = WayToFollow;

  /// Places the seeds.
  /// \param stones   stones as they lie, without overlaps
  /// \param ways     ways of each stone
  /// \param outline  seeds that the outline asks for: the others keep away from them; none in space
  /// \param sizes    mean distances of seeds: sizes of blocks
  StoneSeeds(std::span<const Stone<Dim>> stones, std::span<const Way> ways, const OutlineOf<Dim>& region,
             const OutlineSeeds* outline, const BlockSizes& sizes);

  const std::vector<Vec<Dim>>& positions() const { return positions_; }
  const std::vector<double>& radii() const { return radii_; }  ///< Returns the Laguerre radii, m.
  /// Returns the stone of each seed, index into the stones; -1: the seed stands between stones.
  const std::vector<int>& owners() const { return owners_; }
  /// Tells whether a stone is so small that its cells become one.
  bool is_one_cell(int stone) const { return stones_[stone].is_one_cell; }
  /// Returns the stone in which a place lies, index into the stones; -1: it lies between them.
  int stone_at(const Vec<Dim>& place) const;
  /// Tells whether another seed may stand at a place: not so near to a surface that its cell would reach
  /// across.
  /// \param clear  least distance from surfaces, in spacings
  bool leave_room_at(const Vec<Dim>& place, double clear) const;

 private:
  struct Foot {
    Vec<Dim> at, normal;
  };
  /// Stone as its surface is followed.
  struct Followed {
    Vec<Dim> centre;
    std::shared_ptr<const Surface<Dim>> shape;  ///< drawn smaller
    bool is_one_cell;
    double spacing;  ///< size of blocks at the centre, m
    /// Square of the radius of the one seed, m²; 0: each place of the surface has its own.
    double power = 0.0;
    double along = 0.0;               ///< distance from foot to foot where blocks are as large as there, m
    double drawn = 1.0;               ///< size of the shape over that of the stone
    std::vector<Vec<Dim>> feet = {};  ///< places on the surface that have their seeds, m
  };
  /// Seed between stones that a surface asks for.
  struct Gap {
    double half;  ///< distance of the seed from the surface, m
    int other;    ///< stone at the other side, for which the seed stands too; -1: none
  };

  Followed followed(const Stone<Dim>& stone, const Way& way) const;
  typename Surface<Dim>::Relative spacing_over(const Followed& stone) const;
  void follow(int number);
  Gap gap_from(int number, const Foot& foot) const;
  Foot nearest(int number, const Vec<Dim>& place) const;
  void add_between(const Vec<Dim>& place, double square);
  void add_within(int number, const Foot& foot);
  bool add(const Vec<Dim>& place, double square, int owner);
  double distance(int number, const Vec<Dim>& place) const;
  bool is_surely_farther(int number, const Vec<Dim>& place, double distance) const;
  std::vector<int> near(const Vec<Dim>& place, double distance) const;

  const OutlineOf<Dim>& region_;
  const OutlineSeeds* outline_;
  BlockSizes sizes_;
  StoneGrid<Dim> grid_;
  StoneGrid<Dim> between_;  ///< seeds of no stone, without extent
  std::vector<Followed> stones_;
  std::vector<Vec<Dim>> positions_;
  std::vector<double> radii_;
  std::vector<int> owners_;
};

}  // namespace pyroclast::specimen
