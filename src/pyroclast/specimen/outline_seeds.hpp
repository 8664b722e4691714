#pragma once

#include <vector>

#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/region.hpp"

namespace pyroclast::specimen {

/// Returns the length that the point of a slot (Notch::point) must have for blocks of a size, m; all of the
/// slot's length where it is short.
double slot_point(double length, double width, double spacing);

/// Seeds of a tessellation that make its edges follow an outline.
///
/// Cells are clipped at the outline. Clipping alone is not enough. It leaves a corner that juts into the body
/// (above 180 degrees) within a cell, which would not be convex. A cell would reach through a hole or a
/// notch, and nothing would part the body at a slit. So seeds stand at the same distance from such a corner,
/// so that an edge runs into it, and in mirrored pairs along the walls of notches and slits; an arc has one
/// seed at each of its pieces. All other seeds keep away from these.
class OutlineSeeds {
 public:
  /// Places the seeds. Throws Error, naming the side, where the outline is too fine for blocks of that size.
  /// \param sizes  sizes of blocks: mean distances of seeds
  OutlineSeeds(const Region& region, const BlockSizes& sizes);

  const std::vector<Vec<2>>& positions() const { return positions_; }
  const std::vector<double>& radii() const { return radii_; }  ///< Returns the Laguerre radii, m.
  /// Tells whether another seed may stand at a point: in the body, and not so near to these seeds that it
  /// would take their place.
  bool leave_room_at(const Vec<2>& point) const;

 private:
  void add(const Vec<2>& point, double radius);
  void add_at_corner(const Vec<2>& corner, const Vec<2>& before, const Vec<2>& after, double foot);
  void add_along_notch(const Notch& notch);
  void add_at_arc(const Piece& piece, double least);
  std::vector<double> places_along(const Vec<2>& from, const Vec<2>& along, double begin, double end) const;

  const Region& region_;
  const BlockSizes& sizes_;
  std::vector<Vec<2>> positions_;
  std::vector<double> radii_;
  struct Guarded {
    Vec<2> from, to;
  };
  std::vector<Guarded> guarded_;  ///< lines from which other seeds keep away
};

}  // namespace pyroclast::specimen
