#pragma once

#include <string>
#include <vector>

#include "pyroclast/model/outline.hpp"

namespace pyroclast {

/// Faces of the specimen's outline on which a boundary condition acts, those under bearings included.
struct BoundaryFaces {
  static constexpr const char *kOutline = "outline", *kBox = "box";

  std::string part = kOutline;   ///< whole outline, the faces in a box, or else the name of a side or patch
  Vec<3> box_low{}, box_high{};  ///< corners of the box, m; faces whose centres lie in it or on its bounds
};

/// Returns the places of these faces in the outline: a collective. Throws Error where there are none.
template <int Dim>
std::vector<int> faces_of(const ModelOf<Dim>& model, const std::vector<OutlineFace<Dim>>& outline,
                          const BoundaryFaces& faces);

}  // namespace pyroclast
