#pragma once

#include <array>
#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// Point of a pair of facets that presses: a contact point that was found, at the displacements of the last
/// forces. Places and directions of the plane have no third component.
struct FoundPoint {
  std::array<int, 2> blocks{};
  int face = -1;  ///< face of the model that was handed over and whose sides press each other; else -1
  int interface = 0;
  Vec<3> position{};  ///< of the point, midway between both facets, m
  Vec<3> middle{};    ///< likewise, of the overlap of both facets, m
  Vec<3> normal{};    ///< unit normal, from the first block to the second
  Vec<3> tangent{};   ///< unit vector along the shear; in the plane along the edges; zero where there is none
  double area = 0.0;  ///< m²
  double opening = 0.0;          ///< jump across the facets, m
  double slip = 0.0;             ///< jump along the facets, m; in space its size
  Vec<3> force{};                ///< force on the first block, but for what the change of the area adds, N
  double normal_traction = 0.0;  ///< Pa, tension positive, with the damping of the last step
  double shear_traction = 0.0;   ///< along the tangent, Pa
  double stored = 0.0;           ///< J/m²
};

/// Returns the points that press, in the order of the pairs' keys; none where nothing is found. Where several
/// ranks hold the body, a collective: the first has all points, the others none.
template <int Dim>
std::vector<FoundPoint> found_points(const Body<Dim>& body);

extern template std::vector<FoundPoint> found_points(const Body<2>&);
extern template std::vector<FoundPoint> found_points(const Body<3>&);

}  // namespace pyroclast
