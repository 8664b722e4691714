#include "pyroclast/setup/read_space.hpp"

namespace pyroclast {

namespace {

/// Usual range of a specimen's depth, m.
constexpr Range kDepth = Range::positive().usually(0.01, 10.0);

/// Tells whether a shape can be drawn out along z into a solid.
bool has_section(Shape shape) {
  return shape == Shape::rectangle || shape == Shape::polygon || shape == Shape::disc;
}

}  // namespace

DeckSpace read_space(const Section& root) {
  const Section s = root.section("specimen", "size of the specimen, and its seed");
  DeckSpace space;
  space.shape = s.choice<Shape, Shape>(
      "shape",
      {{"rectangle", Shape::rectangle,
        "with its lower left corner at [0, 0]; sides bottom, right, top, left"},
       {"disc", Shape::disc, "around [0, 0]; its one side is called rim"},
       {"ring", Shape::ring, "the same with a hole in the middle, called bore"},
       {"polygon", Shape::polygon, "of any corners; its sides are called side_1 from the first corner on"},
       {"tessellation", Shape::tessellation,
        "that of the blocks in `blocks.file`; its sides are called side_1 from its lowest corner on, holes "
        "hole_1"},
       {"cells", Shape::cells, "of blocks that are made elsewhere, as the specimen is in all"},
       {"cylinder", Shape::cylinder,
        "a solid that stands around the y axis, from y = 0 up; its sides are called bottom, top and rim"},
       {"polyhedra", Shape::polyhedra,
        "of blocks in space that were made before, as the specimen is in all"}},
      Shape::rectangle, "outline of the specimen");
  if (!s.has("depth")) return space;
  space.depth =
      s.quantity("depth", unit::length, kDepth,
                 "makes a rectangle, polygon or disc a solid: drawn out along z, from z = 0, its side front, "
                 "to this depth, its side back; see [Solids](../do/bodies.md#solids)");
  if (space.shape == Shape::cylinder)
    s.error("depth", "has no meaning here: a cylinder has a diameter and a height");
  else if (space.shape == Shape::polyhedra)
    s.error("depth", "has no meaning here: the file says how deep the body is");
  else if (!has_section(space.shape))
    s.error("depth",
            "is for a rectangle, polygon, disc; a solid with a hole, or of blocks made elsewhere, cannot be "
            "made yet");
  return space;
}

Vec<3> vec_of(const StatedPlace& place) {
  return {{place.x, place.y, place.z.value_or(0.0)}};
}

TwoPlaces read_two_places(const Section& s, const char* key, const DeckSpace& space, Meaning meaning) {
  const auto places = s.places(key, unit::length, 2, space.of_extrusion(), meaning);
  if (places.size() > 2) s.error(key, "must be two places, [[x, y], [x, y]]");
  if (places.size() < 2) return {};
  if (places[0].z.has_value() != places[1].z.has_value())
    s.error(key, "must be two pairs, which stand for all z, or two places [x, y, z]");
  return {{vec_of(places[0]), vec_of(places[1])}, space.is_solid() && !places[0].z};
}

void require_upright(const Section& s, const char* key, const TwoPlaces& box) {
  const auto& [low, high] = box.places;
  if (s.ok() && (low[0] > high[0] || low[1] > high[1] || low[2] > high[2]))
    s.error(key, "is inside out: the lower left corner comes first");
}

}  // namespace pyroclast
