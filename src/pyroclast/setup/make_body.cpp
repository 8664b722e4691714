#include "pyroclast/setup/make_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"

namespace pyroclast {

namespace {

/// Circle of the outline.
struct Circle {
  Vec<2> centre{};
  double diameter = 0.0;
};

/// Largest distance of a seat from the circle on which it lies, in diameters.
constexpr double kOnCircle = 1e-3;
/// Largest distance of a corner of blocks from the side on which it lies, over that of a seat.
constexpr double kOnSide = 1e-6;

/// Returns half of the angle that a bearing covers on a circle, radians; none where the bearing lies
/// elsewhere.
std::optional<double> half_angle(const ReadBearing& b, const Circle& circle) {
  if (!b.at || std::abs(norm(*b.at - circle.centre) - 0.5 * circle.diameter) > kOnCircle * circle.diameter)
    return std::nullopt;
  return std::asin(std::min(1.0, b.width / circle.diameter));
}

double angle_on(const ReadBearing& b, const Circle& circle) {
  const Vec<2> from_centre = *b.at - circle.centre;
  return std::atan2(from_centre[1], from_centre[0]);
}

/// Returns the angles at which a circle must have corners, the ends of bearings, radians; one at least.
std::vector<double> angles_of(const Circle& circle, std::span<const ReadBearing> bearings) {
  std::vector<double> angles;
  for (const ReadBearing& b : bearings)
    if (const auto half = half_angle(b, circle))
      for (const double angle : {angle_on(b, circle) - *half, angle_on(b, circle) + *half})
        angles.push_back(angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle);
  if (angles.empty()) angles.push_back(0.0);
  return angles;
}

/// Returns the ends of a bearing on a straight side, with the body on the left. Throws Error where the
/// bearing's middle is not on the outline.
/// \param corners  corners of blocks that are there already, of which the ends are the nearest; empty: the
///                 ends may be anywhere
std::array<Vec<2>, 2> ends_on_side(const specimen::Region& region, const ReadBearing& b,
                                   std::span<const Vec<2>> corners) {
  const auto& box = region.box();
  const double near = kOnCircle * std::max(box.width(), box.height());
  for (const specimen::Piece& piece : region.pieces()) {
    if (region.sides()[piece.side].is_round ||
        specimen::distance_from_segment(*b.at, piece.from, piece.to) > near)
      continue;
    const Vec<2> along = (piece.to - piece.from) * (1.0 / norm(piece.to - piece.from));
    const Vec<2> middle = piece.from + dot(*b.at - piece.from, along) * along;
    std::array<Vec<2>, 2> ends{middle - 0.5 * b.width * along, middle + 0.5 * b.width * along};
    if (!corners.empty())
      for (Vec<2>& end : ends)
        end = *std::ranges::min_element(corners, {}, [&](const Vec<2>& corner) {
          const bool is_on = specimen::distance_from_segment(corner, piece.from, piece.to) <= kOnSide * near;
          return is_on ? norm(corner - end) : std::numeric_limits<double>::infinity();
        });
    return ends;
  }
  throw Error(fmt::format("its middle ({:.6g}, {:.6g}) m is not on the outline", (*b.at)[0], (*b.at)[1]));
}

/// Returns the ends of a bearing on a circle: two of its corners.
std::array<Vec<2>, 2> ends_on_circle(const specimen::Region& region, const Circle& circle,
                                     const ReadBearing& b, double half) {
  std::array<Vec<2>, 2> ends;
  const double middle = angle_on(b, circle);
  const bool is_hole = region.distance(circle.centre) > 0.0;
  for (const int end : {0, 1}) {
    const double angle = middle + (end == 0 ? -half : half) * (is_hole ? -1.0 : 1.0);
    const Vec<2> at = circle.centre + 0.5 * circle.diameter * Vec<2>{{std::cos(angle), std::sin(angle)}};
    ends[end] = std::ranges::min_element(region.pieces(), {}, [&](const specimen::Piece& piece) {
                  return norm(piece.from - at);
                })->from;
  }
  return ends;
}

/// Returns the region with the seats of bearings as patches.
specimen::Region with_seats(const specimen::Region& region, std::span<const Circle> circles,
                            std::span<const ReadBearing> bearings, std::span<const Vec<2>> corners = {}) {
  std::vector<specimen::Patch> patches;
  for (const ReadBearing& b : bearings) {
    if (!b.at) continue;
    try {
      const auto circle =
          std::ranges::find_if(circles, [&](const Circle& c) { return half_angle(b, c).has_value(); });
      const auto [from, to] = circle == circles.end()
                                  ? ends_on_side(region, b, corners)
                                  : ends_on_circle(region, *circle, b, *half_angle(b, *circle));
      std::vector<specimen::Patch> more = patches;
      more.push_back({b.bearing.side, from, to});
      region.with_patches(more);
      patches = std::move(more);
    } catch (const Error& error) {
      b.section.error("at", error.what());
    }
  }
  return region.with_patches(patches);
}

/// Least number of sides of the polygon by which a solid has a circle.
constexpr double kFewestSides = 24.0;

/// Returns the corners of a circle, with sides about a block long.
/// \param sizes  sizes of blocks where they are finer in parts; else they are of `size`
template <class SizeAt>
std::vector<Vec<2>> corners_of(const Circle& circle, double size, const specimen::BlockSizes* sizes,
                               std::span<const ReadBearing> bearings, SizeAt size_at) {
  const auto angles = angles_of(circle, bearings);
  if (!sizes) return specimen::circle_corners(circle.centre, circle.diameter, size, angles);
  return specimen::circle_corners(circle.centre, circle.diameter, size_at, angles);
}

/// Round body of space.
struct RoundBody {
  Circle circle;
  specimen::Prism::Axis axis;
  double length;  ///< m
};

/// Number of places along a round body at which it is asked for the size of blocks.
constexpr int kPlacesAlong = 64;

/// Returns a polygon of a circle's area, with the seats of bearings. Its sides are about as long as the
/// largest blocks along them: narrow strips of surface would make flat blocks.
specimen::Region round_section(const RoundBody& body, const ReadBlocks& read,
                               const specimen::BlockSizes* sizes, std::span<const ReadBearing> bearings) {
  const double diameter = body.circle.diameter, area = 0.25 * std::numbers::pi * diameter * diameter,
               longest = std::numbers::pi * diameter / kFewestSides;
  const auto side = [&](const Vec<2>& place) {
    double largest = 0.0;
    for (int i = 0; i < kPlacesAlong; ++i) {
      const double along = (i + 0.5) / kPlacesAlong * body.length;
      largest = std::max(largest, sizes->at(specimen::in_space(place, body.axis, along)));
    }
    return std::min(largest, longest);
  };
  const double even = std::min(read.size_in_solid(area * body.length), longest);
  const auto rim =
      specimen::Region::polygon(corners_of(body.circle, even, sizes, bearings, side), {"rim"}, true);
  return with_seats(rim, std::array{body.circle}, bearings);
}

/// Returns the outline of blocks that were made before, with the seats of bearings, whose ends are corners
/// that are there already.
specimen::Region with_seats(const specimen::GivenCells<2>& cells, std::span<const ReadBearing> bearings) {
  return with_seats(cells.outline, {}, bearings, cells.cells.vertices);
}

/// Does the same in space, where a disc alone has seats.
specimen::Prism with_seats(const specimen::GivenCells<3>& cells, std::span<const ReadBearing> bearings) {
  const specimen::Prism& body = cells.outline;
  const specimen::Region& section = body.section();
  if (body.axis() != specimen::Prism::Axis::z || !section.sides().front().is_round) return body;
  const Circle circle{0.5 * (section.box().low + section.box().high),
                      2.0 * std::sqrt(section.extent() / std::numbers::pi)};
  return {with_seats(section, std::array{circle}, bearings), body.axis(), body.length()};
}

std::vector<std::string> side_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("side_{}", i + 1));
  return names;
}

/// Takes the holes and notches of a deck out of a region.
/// \param round    returns the corners of a circle
/// \param size_at  returns the size of blocks at a place, m
template <class Round, class SizeAt>
specimen::Region cut_out(const specimen::Region& region, const ReadOutline& o, Round round, SizeAt size_at) {
  std::vector<specimen::Hole> holes;
  for (const auto& hole : o.holes)
    holes.push_back(hole.corners.empty()
                        ? specimen::Hole{hole.name, round({hole.centre, hole.diameter}), true}
                        : specimen::Hole{hole.name, hole.corners, false});
  std::vector<specimen::Notch> notches = o.notches;
  for (specimen::Notch& n : notches) n.point = specimen::slot_point(n.length(), n.width, size_at(n.tip));
  return region.with_holes(holes).with_notches(notches);
}

/// Returns the solid of a deck.
specimen::Prism prism_of(const ReadOutline& o, double depth, const ReadBlocks& read,
                         std::span<const ReadBearing> bearings, const specimen::BlockSizes* sizes) {
  using enum specimen::Prism::Axis;
  if (o.shape == Shape::cylinder)
    return {round_section({{{}, o.diameter}, y, o.height}, read, sizes, {}), y, o.height};
  const auto cut = [&](const specimen::Region& section) {
    const double even = read.size_in_solid(section.extent() * depth);
    const auto size_at = [&](const Vec<2>& place) {
      return sizes ? sizes->at(specimen::in_space(place, z, 0.5 * depth)) : even;
    };
    return cut_out(
        section, o, [&](const Circle& c) { return corners_of(c, even, sizes, bearings, size_at); }, size_at);
  };
  if (o.shape == Shape::rectangle) return {cut(specimen::Region::rectangle(o.width, o.height)), z, depth};
  if (o.shape == Shape::polygon)
    return {cut(specimen::Region::polygon(o.corners, side_names(o.corners.size()))), z, depth};
  return {cut(round_section({{{}, o.diameter}, z, depth}, read, sizes, bearings)), z, depth};
}

/// Returns the region of a deck in the plane.
specimen::Region region_of(const ReadOutline& o, const ReadBlocks& read,
                           std::span<const ReadBearing> bearings, const specimen::BlockSizes* sizes) {
  const specimen::BlockParameters& blocks = read.parameters;
  if (o.shape == Shape::tessellation)
    return with_seats(specimen::outline_of(*blocks.cells), {}, bearings, blocks.cells->vertices);
  std::vector<Circle> circles;
  const auto round = [&](const Circle& circle, double size) {
    circles.push_back(circle);
    return corners_of(circle, size, sizes, bearings, [&](const Vec<2>& place) { return sizes->at(place); });
  };
  const double area =
      std::numbers::pi / 4.0 * (o.diameter * o.diameter - o.inner_diameter * o.inner_diameter);
  double size = read.size_in(area);
  specimen::Region region;
  if (o.shape == Shape::rectangle) {
    region = specimen::Region::rectangle(o.width, o.height);
  } else if (o.shape == Shape::polygon) {
    region = specimen::Region::polygon(o.corners, side_names(o.corners.size()));
  } else {
    region = specimen::Region::polygon(round({{}, o.diameter}, size), {"rim"}, true);
    if (o.shape == Shape::ring)
      region =
          region.with_holes(std::array{specimen::Hole{"bore", round({{}, o.inner_diameter}, size), true}});
  }
  size = read.size_in(region.extent());
  region = cut_out(
      region, o, [&](const Circle& circle) { return round(circle, size); },
      [&](const Vec<2>& place) { return sizes ? sizes->at(place) : size; });
  return with_seats(region, circles, bearings);
}

}  // namespace

std::variant<specimen::Region, specimen::Prism> make_outline(const Section& s, const ReadOutline& o,
                                                             const DeckSpace& space, const ReadBlocks& read,
                                                             std::span<const ReadBearing> bearings,
                                                             const specimen::BlockSizes* sizes) {
  using Outline = std::variant<specimen::Region, specimen::Prism>;
  const bool is_file = o.shape == Shape::cells || o.shape == Shape::polyhedra;
  const bool is_missing = o.shape == Shape::tessellation && !read.parameters.cells;  // an error already
  try {
    if (s.ok() && o.cells)
      return std::visit([&](const auto& cells) -> Outline { return with_seats(cells, bearings); }, *o.cells);
    if (s.ok() && !is_missing && !is_file) {
      if (space.is_solid()) return prism_of(o, space.depth.value_or(0.0), read, bearings, sizes);
      specimen::Region region = region_of(o, read, bearings, sizes);
      if (o.shape != Shape::tessellation && read.parameters.count == 0 && read.size == 0.0 &&
          !region.is_rectangle())
        s.error(
            "shape",
            "with blocks.file must be \"rectangle\" or \"tessellation\", which is the outline of the file");
      return region;
    }
  } catch (const Error& error) {
    if (o.cells)
      s.error("file", error.what());
    else if (space.is_solid() && o.shape == Shape::polygon)
      s.error("corners", error.what());
    else
      s.error(error.what());
  }
  const specimen::Region square = specimen::Region::rectangle(1.0, 1.0);
  return space.is_solid() ? Outline(specimen::Prism(square, specimen::Prism::Axis::z, 1.0)) : Outline(square);
}

bool is_outline_known(const Section& root, const specimen::SpecimenParameters& specimen) {
  return root.section("specimen").ok() && (specimen.blocks.count > 0 || specimen.blocks.cells);
}

void check_bearings(const specimen::SpecimenParameters& specimen, std::span<const ReadBearing> bearings) {
  const std::vector<std::string> sides = specimen::names_of(specimen.sides());
  std::vector<std::string> names = sides;
  if (specimen.prism())
    for (const specimen::Side& side : specimen.sides())
      if (side.is_round) std::erase(names, side.name);  // no bearing of a solid lies on a bent side yet
  const auto has_seat = [&](const ReadBearing& b) {
    return std::ranges::find(sides, b.bearing.side) != sides.end();
  };
  for (const ReadBearing& b : bearings)
    if (b.at && specimen.prism() && b.section.ok() && !has_seat(b))
      b.section.error("at",
                      fmt::format("a bearing on a part of a side can be made in a solid only on the rim of "
                                  "a disc yet; side = ... lays one on all of {}",
                                  fmt::join(names, ", ")));
  for (const ReadBearing& b : bearings) {
    if (!b.z || !specimen.prism() || !b.section.ok()) continue;
    const double middle = 0.5 * (specimen.low()[2] + specimen.high()[2]);
    if (std::abs(*b.z - middle) > kOnCircle * (specimen.high()[2] - specimen.low()[2]))
      b.section.error("at",
                      fmt::format("a seat lies over all of the depth, so the z of its middle is {:g} m; got "
                                  "{:g} m",
                                  middle, *b.z));
  }
  for (std::size_t i = 0; i < bearings.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!bearings[i].at && !bearings[j].at && bearings[i].section.ok() &&
          bearings[i].bearing.side == bearings[j].bearing.side)
        bearings[i].section.error("side", fmt::format("the bearing \"{}\" lies on \"{}\" already",
                                                      bearings[j].bearing.name, bearings[j].bearing.side));
  for (const ReadBearing& b : bearings)
    if (!b.at && b.section.ok() && std::ranges::find(names, b.bearing.side) == names.end())
      b.section.error("side",
                      fmt::format("must be a{} side of the specimen, one of {}; got \"{}\"",
                                  specimen.prism() ? " plane" : "", fmt::join(names, ", "), b.bearing.side));
}

}  // namespace pyroclast
