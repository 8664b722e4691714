#include "pyroclast/setup/read_bodies.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/place_text.hpp"
#include "pyroclast/specimen/convex_hull.hpp"
#include "pyroclast/specimen/region.hpp"

namespace pyroclast {

namespace {

/// Fewest edges of a round body.
constexpr double kFewestEdges = 12.0;

/// Makes the body a polygon with the area of a disc, or a polyhedron with the volume of a ball.
void make_round(LooseBody& body, const Vec<3>& centre, double diameter, const DeckSpace& space) {
  if (space.is_solid()) {
    auto ball = specimen::ball_of_facets(centre, diameter, body.edge);
    body.corners = std::move(ball.corners);
    body.faces = std::move(ball.faces);
    return;
  }
  const double side = std::min(body.edge, std::numbers::pi * diameter / kFewestEdges);
  for (const Vec<2>& corner : specimen::circle_corners(resized<2>(centre), diameter, side))
    body.corners.push_back(resized<3>(corner));
}

/// Records an error where corners are not those of a convex body; in space finds its faces.
void read_faces(const Section& s, LooseBody& body, const DeckSpace& space) {
  if (!space.is_solid()) {
    if (!goes_round_convex_area(body)) s.error("corners", "must go round a convex area");
    return;
  }
  body.faces = specimen::convex_hull(body.corners);
  if (body.faces.empty()) s.error("corners", "must not all lie in one plane");
  for (int i = 0; s.ok() && i < std::ssize(body.corners); ++i)
    if (std::ranges::none_of(body.faces, [&](const auto& face) { return std::ranges::count(face, i) > 0; }))
      s.error("corners", fmt::format("must be those of a convex body: number {} (from 1), {} m, lies in the "
                                     "hull of the others",
                                     i + 1, place_text(body.corners[i], 3, "{:.6g}")));
}

ReadBody read_body(const Section& s, const DeckSpace& space, double block_size) {
  ReadBody read{s, {}, {}};
  LooseBody& body = read.body;
  body.name = s.text("name", "of the body, and of its sets `<name>` and `<name>_outline`");
  body.deck_place = fmt::format("{}: {}", s.where("name"), s.path());
  body.edge = block_size;
  if (s.has("edge"))
    body.edge = s.quantity("edge", unit::length, Range::positive(),
                           "of the body's zones, about; without it the size of the specimen's blocks");
  else if (block_size == 0.0)
    s.error("edge",
            "is needed: the size of the specimen's blocks, which it is else, is not known before they are");
  if (s.has("diameter")) {
    if (s.has("corners")) s.error("corners", "either corners, or centre and diameter; not both");
    const double diameter = s.quantity("diameter", unit::length, Range::positive(), "of a round body");
    const auto centre = s.place("centre", unit::length, space.of_point(), "of a round body");
    if (s.ok()) make_round(body, vec_of(*centre), diameter, space);
  } else {
    for (const StatedPlace& place :
         s.places("corners", unit::length, space.is_solid() ? 4 : 3, space.of_point(),
                  "of a convex body, in the plane around it in either sense, in a solid in any order"))
      body.corners.push_back(vec_of(place));
    if (s.ok()) read_faces(s, body, space);
  }
  s.know({"corners", "centre", "diameter", "edge"});
  body.material = s.text("material", "platen", "of the body: a table of [materials], at 20 °C in every run");
  read.interface.name = body.name;
  read.interface.friction =
      s.number("friction", Range::non_negative().usually(0.0, 1.0),
               "coefficient of friction between the body and all that it meets; of two bodies that of the "
               "later one");
  return read;
}

}  // namespace

std::vector<ReadBody> read_bodies(const Section& root, const DeckSpace& space, double block_size) {
  std::vector<ReadBody> bodies;
  for (const Section& s : root.optional_sections(
           "bodies",
           "blocks that are not made with the specimen, any number: plates, strips, things that fall; see "
           "[Bodies of their own](../do/bodies.md#bodies-of-their-own)")) {
    ReadBody read = read_body(s, space, block_size);
    const auto same = [&](const ReadBody& other) { return other.body.name == read.body.name; };
    if (s.ok() && std::ranges::any_of(bodies, same))
      s.error("name", fmt::format("\"{}\" is the name of another body", read.body.name));
    bodies.push_back(std::move(read));
  }
  return bodies;
}

std::vector<StartVelocity> read_velocities(const Section& root, const DeckSpace& space) {
  std::vector<StartVelocity> velocities;
  for (const Section& s :
       root.optional_sections("velocities", "velocities at the start of the run, of any number of sets")) {
    StartVelocity start;
    start.set = s.text("set", "set of gridpoints that moves; see [Sets](../do/bodies.md#sets)");
    start.deck_place = fmt::format("{}: {}", s.where("set"), s.path());
    const auto velocity =
        s.quantities("velocity", unit::velocity, Range::any(), "as [x, y], in a solid [x, y, z]");
    if (s.ok() && std::ssize(velocity) != space.dimension())
      s.error("velocity", fmt::format("must be {}, got {} numbers", space.is_solid() ? "[x, y, z]" : "[x, y]",
                                      velocity.size()));
    else if (s.ok())
      std::ranges::copy(velocity, start.velocity.c.begin());
    velocities.push_back(std::move(start));
  }
  return velocities;
}

}  // namespace pyroclast
