#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast::specimen {

/// Lines of a region on which a point lies, ascending: pieces of the outline, then notches without a width,
/// then tips of these notches.
struct LineSet {
  static constexpr int kMost = 4;
  std::array<int, kMost> line;
  int count = 0;

  void insert(int number);
  friend bool operator==(const LineSet& a, const LineSet& b) {
    return std::equal(a.line.begin(), a.line.begin() + a.count, b.line.begin(), b.line.begin() + b.count);
  }
};

/// Returns the first line from `begin` to before `end` that both sets have; -1 where there is none.
int shared_line(const LineSet& a, const LineSet& b, int begin, int end);

/// Returns all lines of both sets; empty where they are more than a set holds.
std::optional<LineSet> both(const LineSet& a, const LineSet& b);

/// Smallest box along the axes around an object, m.
struct Box {
  Vec<2> low, high;

  double width() const { return high[0] - low[0]; }
  double height() const { return high[1] - low[1]; }
  bool touches(const Box& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
           other.low[1] <= high[1];
  }
};

Box box_of(std::span<const Vec<2>> points);

/// Part of an outline that has a name: a straight side, all of a circle, the walls of a notch.
struct Side {
  std::string name;
  bool is_round = false;  ///< true where the side's pieces stand for an arc
  bool is_cut = false;    ///< true for a side of a notch
  int part_of = -1;       ///< side of which it is a stretch, see Patch
};

/// Returns the names of sides.
std::vector<std::string> names_of(std::span<const Side> sides);
/// Returns the place of the side of a name; -1 where there is none.
int find_side(std::span<const Side> sides, std::string_view name);

/// Straight piece of an outline, walked with the body on its left.
struct Piece {
  Vec<2> from, to;  ///< m
  int side;         ///< index into Region::sides
};

/// Returns the unit vector across a piece, out of the body.
Vec<2> out_of(const Piece& piece);

/// Flat part of an outline: a piece in the plane, a face in space.
struct FlatPart {
  std::vector<Vec<3>> corners;  ///< m
  Vec<3> normal;                ///< unit vector, out of the body
  int side;                     ///< index into the sides of the outline
};

/// Closed line without crossings, walked with the body on its left: counter-clockwise around a body,
/// clockwise around a hole.
struct Loop {
  std::vector<Vec<2>> corners;  ///< m
  std::vector<int> side;        ///< side of the piece from each corner to the next
};

/// Notch. A notch without width is a slit: the blocks on both of its sides are parted from the start.
struct Notch {
  std::string name;
  Vec<2> mouth;            ///< mouth on the outline, m
  Vec<2> tip;              ///< tip in the body, m
  double width = 0.0;      ///< width, m; 0: a slit; else a slot that ends in a point
  double point = 0.0;      ///< length over which the walls of a slot run together, m; all of it: a wedge
  std::string place = {};  ///< place in a deck, which begins messages: "deck.toml:12: specimen.notches[0]"

  double length() const { return norm(tip - mouth); }
};

/// Stretch of a side with a name of its own, on which a bearing may lie. Its ends are corners of blocks.
struct Patch {
  std::string name;
  Vec<2> from,
      to;  ///< ends on the outline, walked with the body on the left; of a round side two of its corners, m
};

/// Hole that is asked for.
struct Hole {
  std::string name;
  std::vector<Vec<2>> corners;  ///< corners in either sense, m
  bool is_round = false;        ///< true where the corners stand for a circle
};

/// Body in the plane: its outline, the holes in it, and the notches cut into it.
class Region {
 public:
  Region() = default;
  /// Returns [0, width] x [0, height] (m), with the sides `bottom`, `right`, `top`, `left`.
  static Region rectangle(double width, double height);
  /// Returns a polygon (corners in either sense, m). Throws Error when corners are too few, sides cross or
  /// meet, or have no length.
  /// \param names  names of the sides, from each corner to the next; one name for all where the corners are
  ///               round
  static Region polygon(std::vector<Vec<2>> corners, const std::vector<std::string>& names,
                        bool is_round = false);

  /// Takes holes out. Throws Error, naming the hole, when one does not lie within the body, or holes meet.
  Region with_holes(std::span<const Hole> holes) const;
  /// Cuts notches. Throws Error, naming the notch, when one does not begin on the outline, its tip is not in
  /// the body, or it parts the body.
  Region with_notches(std::span<const Notch> notches) const;
  /// Names stretches of sides. Call it last, for notches and holes move no patch. Throws Error, naming the
  /// patch, when an end is not on the outline, or a patch goes over more than one side or meets another.
  Region with_patches(std::span<const Patch> patches) const;

  const std::vector<Side>& sides() const { return sides_; }
  const std::vector<Loop>& loops() const { return loops_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  std::vector<FlatPart> flat_parts() const;  ///< Returns the pieces as parts of an outline.
  const std::vector<Notch>& notches() const { return notches_; }
  const Box& box() const { return box_; }
  const Vec<2>& low() const { return box_.low; }    ///< Returns the lower corner of the box, m.
  const Vec<2>& high() const { return box_.high; }  ///< Returns the upper corner, m.
  double extent() const { return area_; }           ///< Returns the area, m².
  /// Tells whether the region is a rectangle along the axes without holes or notches, with its lower left
  /// corner at 0.
  bool is_rectangle() const { return is_rectangle_; }

  /// Returns the lines on which a point lies.
  LineSet lines_at(const Vec<2>& point) const;
  /// Tells whether an edge between two points lies on the outline.
  bool is_outline(const LineSet& from, const LineSet& to) const {
    return shared_line(from, to, 0, static_cast<int>(pieces_.size())) >= 0;
  }
  /// Returns the side or patch on which an edge lies, index into `sides`; empty inside of the body.
  std::optional<int> side_of(const Vec<2>& from, const Vec<2>& to) const;
  /// Returns the notch without a width on which an edge lies, index into `notches`.
  std::optional<int> slit_of(const Vec<2>& from, const Vec<2>& to) const;

  /// Returns the distance from the outline, m: negative inside of the body, positive outside. Slits do not
  /// count.
  double distance(const Vec<2>& point) const;
  /// Returns the distance as if no notch had been cut: aggregates may lie there, for a saw goes through them.
  double distance_before_cuts(const Vec<2>& point) const;
  /// Returns the pieces of the outline as if no notch had been cut.
  const std::vector<Piece>& pieces_before_cuts() const {
    return before_cuts_.empty() ? pieces_ : before_cuts_;
  }

 private:
  void list_pieces();
  std::pair<std::size_t, std::size_t> corner_at(const Patch& patch, const Vec<2>& point);

  std::vector<Side> sides_;
  std::vector<Loop> loops_;
  std::vector<Piece> pieces_;  ///< pieces of all loops, in turn
  std::vector<Notch> notches_;
  std::vector<Piece> before_cuts_;  ///< pieces before cuts; empty where they are the same
  Box box_{};
  double area_ = 0.0;
  bool is_rectangle_ = false;
};

/// Returns the corners of a polygon that has the area of a circle, counter-clockwise.
/// \param side    length of a side, approximately, m; 12 sides at least
/// \param angles  angles at which the polygon must have corners, radians
std::vector<Vec<2>> circle_corners(const Vec<2>& centre, double diameter, double side,
                                   std::vector<double> angles = {0.0});

/// The same with sides whose length changes from place to place.
/// \param side  length of a side at a place, approximately, m
std::vector<Vec<2>> circle_corners(const Vec<2>& centre, double diameter,
                                   const std::function<double(const Vec<2>&)>& side,
                                   std::vector<double> angles = {0.0});

/// Returns the distance of a point from the segment between two others, which may be one, m.
template <int Dim>
double distance_from_segment(const Vec<Dim>& point, const Vec<Dim>& from, const Vec<Dim>& to) {
  const Vec<Dim> along = to - from;
  const double squared = dot(along, along);
  const double share = squared > 0.0 ? std::clamp(dot(point - from, along) / squared, 0.0, 1.0) : 0.0;
  return norm(point - (from + along * share));
}

/// Returns the distance of the segment from a to b from that from c to d, m; 0 where they cross.
double distance_of_segments(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d);

}  // namespace pyroclast::specimen
