#pragma once

#include <array>
#include <utility>
#include <vector>

#include "pyroclast/base/vec.hpp"

namespace pyroclast {

/// Adds a zone in space, its gridpoints in the order that makes its volume positive.
inline void add_zone(std::array<int, 4> zone, const std::vector<Vec<3>>& gridpoints,
                     std::vector<std::array<int, 4>>& zones) {
  const Vec<3>& x = gridpoints[zone[0]];
  if (dot(cross(gridpoints[zone[1]] - x, gridpoints[zone[2]] - x), gridpoints[zone[3]] - x) < 0.0)
    std::swap(zone[1], zone[2]);
  zones.push_back(zone);
}

/// Adds three tetrahedra of the prism over a triangle between two rows. Its side faces are cut by the
/// diagonals from the lower column at the inner row to the higher one at the outer row, so that neighbours
/// cut them alike.
inline void add_prism(const std::array<int, 3>& columns, int inner, int outer,
                      const std::vector<Vec<3>>& gridpoints, std::vector<std::array<int, 4>>& zones) {
  auto [a, b, c] = columns;
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  for (const std::array<int, 4>& zone : {std::array{inner + a, inner + b, inner + c, outer + c},
                                         std::array{inner + a, inner + b, outer + b, outer + c},
                                         std::array{inner + a, outer + a, outer + b, outer + c}})
    add_zone(zone, gridpoints, zones);
}

}  // namespace pyroclast
