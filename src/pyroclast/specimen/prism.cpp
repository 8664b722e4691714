#include "pyroclast/specimen/prism.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {

namespace {

/// Sine of the angle by which a corner may jut into the body by rounding.
constexpr double kStraight = 1e-9;

/// Returns the pieces around a section as if nothing had been cut.
std::vector<Piece> pieces_around(const Region& section) {
  const auto& all = section.pieces_before_cuts();  // of the outer line first
  std::size_t n = 1;
  while (!(all[n - 1].to == all.front().from)) ++n;
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n)};
}

/// Throws Error unless a section is convex but for its holes and notches, and these have walls.
void require_convex(const Region& section, const std::vector<Piece>& pieces) {
  for (const Notch& notch : section.notches()) {
    if (notch.width == 0.0)
      throw Error(fmt::format("{}: a notch of a solid must have a width yet", notch.name));
    if (std::ranges::any_of(section.sides(), [](const Side& side) { return side.part_of >= 0; }))
      throw Error(fmt::format("{}: a solid with bearings on its rim cannot have notches yet", notch.name));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [from, corner, side] = pieces[i];
    const Vec<2> before = corner - from, after = pieces[(i + 1) % pieces.size()].to - corner;
    if (cross(before, after) < -kStraight * norm(before) * norm(after))
      throw Error(fmt::format(
          "the outline of a solid must be convex yet, but at ({:g}, {:g}) m a corner juts into the body",
          corner[0], corner[1]));
  }
}

}  // namespace

Prism::Prism(Region section, Axis axis, double length) : section_(std::move(section)), axis_(axis) {
  around_ = pieces_around(section_);
  require_convex(section_, around_);
  sides_ = section_.sides();
  for (const Loop& loop : section_.loops())
    for (std::size_t i = 0; i < loop.corners.size(); ++i)
      if (&loop != &section_.loops().front() || sides_[loop.side[i]].is_cut)
        walls_.push_back({loop.corners[i], loop.corners[(i + 1) % loop.corners.size()], loop.side[i]});
  for (const Piece& piece : around_) {
    const Vec<2> out = out_of(piece);
    planes_.push_back({in_space(out, axis_, 0.0), dot(out, piece.from), piece.side});
  }
  const int first_end = static_cast<int>(sides_.size());
  for (const char* const end : axis == Axis::z ? std::array{"front", "back"} : std::array{"bottom", "top"}) {
    if (find_side(sides_, end) >= 0)
      throw Error(fmt::format("a side of the section has the name of an end of the prism, \"{}\"", end));
    sides_.push_back({end});
  }
  planes_.push_back({in_space({}, axis_, -1.0), 0.0, first_end});
  planes_.push_back({in_space({}, axis_, 1.0), length, first_end + 1});
  low_ = in_space(section_.box().low, axis_, 0.0);
  high_ = in_space(section_.box().high, axis_, length);
  volume_ = whole_ = section_.extent() * length;
  if (walls_.empty()) return;
  std::vector<Vec<2>> corners;
  for (const Piece& piece : around_) corners.push_back(piece.from);
  whole_ = area(corners) * length;
}

Vec<3> in_space(const Vec<2>& of_section, Prism::Axis axis, double along) {
  if (axis == Prism::Axis::z) return {{of_section[0], of_section[1], along}};
  return {{of_section[1], along, of_section[0]}};
}

Vec<2> Prism::in_section(const Vec<3>& place) const {
  if (axis_ == Axis::z) return {{place[0], place[1]}};
  return {{place[2], place[0]}};
}

double Prism::distance_from_planes(const Vec<3>& point) const {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_) farthest = std::max(farthest, plane.distance(point));
  return farthest;
}

double Prism::distance(const Vec<3>& point) const {
  const double outer = distance_from_planes(point);
  return walls_.empty() ? outer : std::max(outer, section_.distance(in_section(point)));
}

double Prism::distance_before_cuts(const Vec<3>& point) const {
  const double outer = distance_from_planes(point);
  return walls_.empty() ? outer : std::max(outer, section_.distance_before_cuts(in_section(point)));
}

double Prism::distance_from_walls(const Vec<3>& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Piece& wall : walls_)
    nearest = std::min(nearest, distance_from_segment(in_section(point), wall.from, wall.to));
  return nearest;
}

std::vector<FlatPart> Prism::flat_parts() const {
  std::vector<FlatPart> parts;
  for (const Plane& plane : planes_) parts.push_back({{}, plane.normal, plane.side});
  const auto along_axis = [&](const Piece& piece) -> std::vector<Vec<3>> {
    return {in_space(piece.from, axis_, 0.0), in_space(piece.to, axis_, 0.0),
            in_space(piece.to, axis_, length()), in_space(piece.from, axis_, length())};
  };
  for (std::size_t i = 0; i < around_.size(); ++i) {
    parts[i].corners = along_axis(around_[i]);
    for (const bool is_far : {false, true})
      parts[around_.size() + (is_far ? 1 : 0)].corners.push_back(
          in_space(around_[i].from, axis_, is_far ? length() : 0.0));
  }
  for (const Piece& wall : walls_)
    parts.push_back({along_axis(wall), in_space(out_of(wall), axis_, 0.0), wall.side});
  return parts;
}

Room<3> room_in(const Prism& body) {
  return {body.low(), body.high(), body.extent(),
          [&body](const Vec<3>& point) { return body.distance_before_cuts(point); }};
}

Room<3> room_of_blocks(const Prism& body) {
  return {body.low(), body.high(), body.extent(),
          [&body](const Vec<3>& point) { return body.distance(point); }};
}

}  // namespace pyroclast::specimen
