#pragma once

#include <string>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/region.hpp"
#include "pyroclast/specimen/room.hpp"

namespace pyroclast::specimen {

/// Plane that bounds a body: the body lies where dot(normal, x) <= offset.
struct Plane {
  /// Returns the distance of a point from the plane, m, negative on the side of the body.
  double distance(const Vec<3>& point) const { return dot(normal, point) - offset; }

  Vec<3> normal;  ///< unit vector, out of the body
  double offset;  ///< m
  int side;       ///< index into Prism::sides
};

/// Body in space: a prism. Its section is a region of the plane, its axis runs along z or y. Holes and
/// notches of the section go through all of its length.
class Prism {
 public:
  enum class Axis { y, z };

  Prism() = default;
  /// Makes a prism from 0 to `length`, m, along its axis. Along z the section lies in x and y; its ends are
  /// the sides `front`, z = 0, and `back`. Along y the first coordinate of the section is z, the second is x;
  /// its ends are `bottom`, y = 0, and `top`. Throws Error unless the section is convex but for its holes and
  /// notches, or where a notch has no width, or a side has the name of an end.
  Prism(Region section, Axis axis, double length);

  const std::vector<Side>& sides() const { return sides_; }
  /// Returns the planes around the body, as if nothing had been cut.
  const std::vector<Plane>& planes() const { return planes_; }
  /// Returns the pieces around the section, as if nothing had been cut.
  const std::vector<Piece>& around() const { return around_; }
  /// Returns the walls of holes and notches in the section, walked with the body on their left.
  const std::vector<Piece>& walls() const { return walls_; }
  const Vec<3>& low() const { return low_; }    ///< Returns the lower corner of the box around the body, m.
  const Vec<3>& high() const { return high_; }  ///< Returns the upper corner, m.
  std::vector<FlatPart> flat_parts() const;     ///< Returns the flat faces.
  double length() const { return planes_.back().offset; }  ///< Returns the length along the axis, m.
  double extent() const { return volume_; }                ///< Returns the volume, m³.
  double extent_before_cuts() const { return whole_; }  ///< Returns the volume with holes and notches, m³.
  const Region& section() const { return section_; }
  Axis axis() const { return axis_; }
  /// Returns a place seen along the axis.
  Vec<2> in_section(const Vec<3>& place) const;
  /// Returns the distance from the surface, m, negative within the body.
  double distance(const Vec<3>& point) const;
  /// Returns the distance as if no notch had been cut, see Region::distance_before_cuts.
  double distance_before_cuts(const Vec<3>& point) const;
  /// Returns the distance from the nearest wall of a hole or notch, m, not negative; infinity without walls.
  double distance_from_walls(const Vec<3>& point) const;

 private:
  double distance_from_planes(const Vec<3>& point) const;

  Region section_;
  Axis axis_ = Axis::z;
  std::vector<Side> sides_;
  std::vector<Plane> planes_;
  std::vector<Piece> around_, walls_;
  Vec<3> low_{}, high_{};
  double volume_ = 0.0, whole_ = 0.0;
};

/// Returns a place of a section in space.
/// \param along  place along the axis, m
Vec<3> in_space(const Vec<2>& of_section, Prism::Axis axis, double along);

/// Returns the room of balls in a body, which must outlive it, as it was before notches were cut.
Room<3> room_in(const Prism& body);
/// Returns the room of blocks in a body, which must outlive it. Stones with a shape lie there too.
Room<3> room_of_blocks(const Prism& body);

}  // namespace pyroclast::specimen
