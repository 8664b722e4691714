#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pyroclast/specimen/cells.hpp"

/// Polyhedral cells that fill a body.
namespace pyroclast::specimen {

/// Calls `f(a, b, c)` for the triangles of a cell's faces, with their vertices counter-clockwise seen from
/// outside of the cell.
template <class F>
void for_each_triangle(const Cells<3>& cells, std::size_t cell, F f) {
  for (const int number : cells.cells[cell]) {
    const Facet<3>& face = cells.faces[number];
    const auto& corner = face.corners;
    const bool is_inner = face.inner == static_cast<int>(cell);
    for (std::size_t i = 1; i + 1 < corner.size(); ++i)
      f(corner[0], corner[is_inner ? i : i + 1], corner[is_inner ? i + 1 : i]);
  }
}

/// Returns the vector of a face's area, m²: out of the cell `inner`, as long as the area is large. On a bent
/// face it is that of its mean plane.
Vec<3> area_vector(const Cells<3>& cells, const Facet<3>& face);

/// Returns the bend of a face, rad: the largest angle between a triangle of its fan and its mean plane.
/// \param at       places of vertices
/// \param corners  vertices of the face
double bend(const std::vector<Vec<3>>& at, const std::vector<int>& corners);

/// Returns the height of the lowest triangle of a face's fan over its longest edge, m.
double lowest_of_fan(const std::vector<Vec<3>>& at, const std::vector<int>& corners);

/// Lets a face begin with the corner whose fan has the highest lowest triangle. Returns false where each fan
/// is bent by more than `largest_bend`, rad.
bool turn_to_best_fan(const std::vector<Vec<3>>& at, std::vector<int>& corners, double largest_bend);

/// Returns how flat the zones of a cell are: the sum over zones of volume / r^4, in units of `size`, where r
/// is the radius of the ball in the zone; infinite where a zone has no volume. Stiffness, and with it the
/// mass of density scaling, goes with volume / r^2; the steps of real mass and of heat with the least r. The
/// fourth power stands between both.
double flatness(const Cells<3>& cells, std::size_t cell, double size);

/// Returns the volume that a cell has in common with a ball, m³. Exact up to rounding.
double common_volume(const Cells<3>& cells, std::size_t cell, const Vec<3>& centre, double radius);

/// Returns why a cell cannot be a block; null where it can: it is closed and has the Euler number of a ball,
/// each vertex of a face stands once on it, and each of its zones has a volume.
const char* fault_of(const Cells<3>& cells, std::size_t cell);

/// Throws Error, which begins with `what`, unless each cell can be a block, and the volumes of all cells fill
/// that of the body, before holes and notches are taken out, to 1e-9.
void require_valid(const Cells<3>& cells, const Prism& body, const std::string& what);

}  // namespace pyroclast::specimen
