#pragma once

#include <array>
#include <vector>

#include "pyroclast/mechanics/body.hpp"

namespace pyroclast {

/// End of a pair of edges that presses: a contact point that was found, at the displacements of the last
/// forces.
struct FoundPoint {
  std::array<int, 2> blocks{};
  int face = -1;  ///< face of the model that was handed over and whose sides press each other; else -1
  int interface = 0;
  Vec<2> position{};                 ///< of the end, midway between both edges, m
  Vec<2> middle{};                   ///< likewise, of the overlap of both edges, m
  Vec<2> normal{};                   ///< unit normal, from the first block to the second
  double area = 0.0, length = 0.0;   ///< m², and that over the thickness, m
  double opening = 0.0, slip = 0.0;  ///< jumps across and along the edges, m
  Vec<2> force{};                ///< force on the first block, but for what the change of the area adds, N
  double normal_traction = 0.0;  ///< Pa, tension positive, with the damping of the last step
  double shear_traction = 0.0, stored = 0.0;  ///< Pa, J/m²
};

/// Returns the ends that press, in the order of the pairs' keys; none where nothing is found.
std::vector<FoundPoint> found_points(const Body<2>& body);

}  // namespace pyroclast
