#include "pyroclast/setup/read_faces.hpp"

#include <cmath>
#include <limits>

namespace pyroclast {

namespace {

/// Reads a corner of a box. In a solid a pair stands for all z.
/// \param end  z of the box where it has no end
Vec<3> read_corner(const Section& s, std::string_view key, const DeckSpace& space, double end,
                   Meaning meaning) {
  const StatedPlace at = s.place(key, unit::length, space.of_extrusion(), meaning).value_or(StatedPlace{});
  Vec<3> corner = vec_of(at);
  if (space.is_solid() && !at.z) corner[2] = end;
  return corner;
}

}  // namespace

BoundaryFaces read_faces(const Section& s, const DeckSpace& space) {
  s.know({"box_low", "box_high"});
  BoundaryFaces faces;
  faces.part = s.word_or_text(
      "faces",
      {{BoundaryFaces::kOutline, 0, "all sides, also of holes and notches"},
       {BoundaryFaces::kBox, 1, "faces of the outline whose centres lie in a box"}},
      "the name of a side of the specimen, such as left, of the patch under a bearing, also under "
      "a platen, or of a set",
      "where the boundary acts", "where the boundary acts is needed, such as \"left\"");
  if (faces.part != BoundaryFaces::kBox) return faces;
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  faces.box_low = read_corner(s, "box_low", space, -kEndless,
                              "lower left corner: x and y from the lower left corner of a rectangle, the "
                              "middle of a disc; in a solid z too, from its front, or all z");
  faces.box_high = read_corner(s, "box_high", space, kEndless, "upper right corner, likewise");
  if (s.ok() && std::isinf(faces.box_low[2]) != std::isinf(faces.box_high[2]))
    s.error("box_high", "must be a pair, which stands for all z, like box_low, or both three numbers");
  for (int i = 0; i < space.dimension() && s.ok(); ++i)
    if (faces.box_low[i] > faces.box_high[i])
      s.error("box_high", "the box is inside out: no coordinate may be less than in box_low");
  return faces;
}

bool overlap(const BoundaryFaces& a, const BoundaryFaces& b) {
  if (a.part == BoundaryFaces::kBox || b.part == BoundaryFaces::kBox)
    return a.part == BoundaryFaces::kOutline || b.part == BoundaryFaces::kOutline;
  return a.part == b.part || a.part == BoundaryFaces::kOutline || b.part == BoundaryFaces::kOutline;
}

}  // namespace pyroclast
