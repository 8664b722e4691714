#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pyroclast/specimen/grain_grid.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"

namespace pyroclast::specimen {

/// Way to follow a grain.
struct WayToFollow {
  double size = 1.0;            ///< factor by which it is followed larger
  bool is_of_one_seed = false;  ///< true where a small grain must have one seed
};

/// Seeds of a tessellation that make its facets follow the surfaces of grains.
///
/// Seeds stand in pairs on both sides of a surface, so the facet between the two cells is a tangent. Each
/// grain is first drawn smaller, by the factor by which the polygon of its tangents, or the polyhedron, is
/// larger than the grain. A small grain is one cell. Where two grains are so near to each other that two rows
/// of seeds do not fit between them, they share one row in the middle of the gap. Where the outline of the
/// body cuts a grain, the grain's cells end at the outline, and no seeds stand beyond its surface.
///
/// All seeds near a surface have the same power there: r² = h² + constant, with the radius r of the seed and
/// its distance h from the surface. So the facet between two of them is where the surface is, whatever h.
template <int Dim>
class GrainSeeds {
 public:
  using Way = WayToFollow;

  /// Places the seeds.
  /// \param grains   grains as they lie, without overlaps
  /// \param ways     ways of each grain
  /// \param outline  seeds that the outline asks for: the others keep away from them; none in space
  /// \param sizes    mean distances of seeds: sizes of blocks
  GrainSeeds(std::span<const Grain<Dim>> grains, std::span<const Way> ways, const OutlineOf<Dim>& region,
             const OutlineSeeds* outline, const BlockSizes& sizes);

  const std::vector<Vec<Dim>>& positions() const { return positions_; }
  const std::vector<double>& radii() const { return radii_; }  ///< Returns the Laguerre radii, m.
  /// Returns the grain of each seed, index into the grains; -1: the seed stands between grains.
  const std::vector<int>& owners() const { return owners_; }
  /// Tells whether a grain is so small that its cells become one.
  bool is_one_cell(int grain) const { return grains_[grain].is_one_cell; }
  /// Returns the grain in which a place lies, index into the grains; -1: it lies between them.
  int grain_at(const Vec<Dim>& place) const;
  /// Tells whether another seed may stand at a place: not so near to a surface that its cell would reach
  /// across.
  /// \param clear  least distance from surfaces, in spacings
  bool leave_room_at(const Vec<Dim>& place, double clear) const;

 private:
  struct Foot {
    Vec<Dim> at, normal;
  };
  /// Grain as its surface is followed.
  struct Followed {
    Vec<Dim> centre;
    std::shared_ptr<const Surface<Dim>> shape;  ///< drawn smaller
    bool is_one_cell;
    double spacing;  ///< size of blocks at the centre, m
    /// Square of the radius of the one seed, m²; 0: each place of the surface has its own.
    double power = 0.0;
    double along = 0.0;               ///< distance from foot to foot where blocks are as large as there, m
    double drawn = 1.0;               ///< size of the shape over that of the grain
    std::vector<Vec<Dim>> feet = {};  ///< places on the surface that have their seeds, m
  };
  /// Seed between grains that a surface asks for.
  struct Gap {
    double half;  ///< distance of the seed from the surface, m
    int other;    ///< grain at the other side, for which the seed stands too; -1: none
  };

  Followed followed(const Grain<Dim>& grain, const Way& way) const;
  typename Surface<Dim>::Relative spacing_over(const Followed& grain) const;
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
  GrainGrid<Dim> grid_;
  GrainGrid<Dim> between_;  ///< seeds of no grain, without extent
  std::vector<Followed> grains_;
  std::vector<Vec<Dim>> positions_;
  std::vector<double> radii_;
  std::vector<int> owners_;
};

}  // namespace pyroclast::specimen
