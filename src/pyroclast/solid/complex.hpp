#pragma once

#include <array>
#include <string>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/solid/prism.hpp"

/// Polyhedral cells that fill a body.
namespace pyroclast::solid {

/// Face of one cell, or between two.
struct CellFace {
  /// Vertices, counter-clockwise seen from outside of `inner`. Zones meet the face in the triangles of the
  /// fan from the first one.
  std::vector<int> corners;
  int inner = -1;  ///< cell
  int outer = -1;  ///< other cell; -1 on the surface of the body
  int side = -1;   ///< side of the body on which the face lies; -1 within the body
};

/// Cells that fill a body; neighbours share faces, faces share vertices.
struct Complex {
  std::vector<Vec<3>> vertices;  ///< m
  std::vector<CellFace> faces;
  std::vector<std::vector<int>> cells;  ///< faces of each cell
};

/// Calls `f(a, b, c)` for the triangles of a cell's faces, with their vertices counter-clockwise seen from
/// outside of the cell.
template <class F>
void for_each_triangle(const Complex& complex, std::size_t cell, F f) {
  for (const int number : complex.cells[cell]) {
    const CellFace& face = complex.faces[number];
    const auto& corner = face.corners;
    const bool is_inner = face.inner == static_cast<int>(cell);
    for (std::size_t i = 1; i + 1 < corner.size(); ++i)
      f(corner[0], corner[is_inner ? i : i + 1], corner[is_inner ? i + 1 : i]);
  }
}

/// Returns the vector of a face's area, m²: out of the cell `inner`, as long as the area is large. On a bent
/// face it is that of its mean plane.
Vec<3> area_vector(const Complex& complex, const CellFace& face);

/// Returns the volume of a cell, m³.
double volume(const Complex& complex, std::size_t cell);

/// Throws Error, which begins with `what`, unless cells are closed and each has the Euler number of a ball,
/// each vertex of a face stands once on it, and the volumes of all cells fill that of the body to 1e-9.
void require_valid(const Complex& complex, const Prism& body, const std::string& what);

/// Cell cut into zones.
struct ZonedCell {
  std::vector<int> vertices;              ///< vertices of the cell, in the order in which its faces meet them
  std::vector<Vec<3>> gridpoints;         ///< places of the vertices, then the centroid; m
  std::vector<std::array<int, 4>> zones;  ///< gridpoints, positively oriented, the centroid last
};

/// Cuts a cell into tetrahedra around its centroid, one for each triangle of the fans of its faces.
ZonedCell zone_cell(const Complex& complex, std::size_t cell);

}  // namespace pyroclast::solid
