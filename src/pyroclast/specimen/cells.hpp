#pragma once

#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "pyroclast/base/vec.hpp"
#include "pyroclast/specimen/prism.hpp"
#include "pyroclast/specimen/region.hpp"

/// Convex cells, from which blocks are made.
namespace pyroclast::specimen {

/// Outline of cells: a region of the plane, or a prism in space.
template <int Dim>
using OutlineOf = std::conditional_t<Dim == 2, Region, Prism>;

/// Facet of one cell, or between two: an edge in the plane, a face in space.
template <int Dim>
struct Facet {
  /// Vertices: the ends of an edge, with `inner` on its left; around a face counter-clockwise, seen from
  /// outside of `inner`. Zones meet a face in the triangles of the fan from its first vertex.
  std::conditional_t<Dim == 2, std::array<int, 2>, std::vector<int>> corners;
  int inner = -1;  ///< cell
  int outer = -1;  ///< other cell; -1 on the outline
  int side = -1;   ///< side of the outline on which the facet lies; -1 within, or where it is not known
};

/// Returns the side of the square of an area, m, or the edge of the cube of a volume.
template <int Dim>
double side_of(double extent) {
  if constexpr (Dim == 2)
    return std::sqrt(extent);
  else
    return std::cbrt(extent);
}

template <int Dim>
struct Cells;

/// Cells that tile a region exactly; neighbours share vertices.
template <>
struct Cells<2> {
  std::vector<Vec<2>> vertices;         ///< m
  std::vector<std::vector<int>> cells;  ///< vertices of each cell, counter-clockwise
};

/// Cells that fill a body; neighbours share faces, faces share vertices.
template <>
struct Cells<3> {
  std::vector<Vec<3>> vertices;  ///< m
  std::vector<Facet<3>> faces;
  std::vector<std::vector<int>> cells;  ///< faces of each cell
};

/// Numbering of cells in messages.
struct Numbering {
  std::vector<int>
      in_file;  ///< number of each cell in a file that counts from 1; empty: numbers from 0, as they stand

  /// Returns the name of a cell, "cell 3 (from 0)", "cell 4 (from 1)".
  std::string cell(std::size_t number) const;
};

/// Returns the facets of cells of the plane, each once, in the order in which the cells meet them. Throws
/// Error when an edge belongs to more than two cells or two cells see it in the same sense.
std::vector<Facet<2>> facets(const Cells<2>& cells, const Numbering& numbering = {});
/// Returns the facets of cells in space.
inline const std::vector<Facet<3>>& facets(const Cells<3>& cells) {
  return cells.faces;
}

/// Returns the area of a cell, m².
double extent(const Cells<2>& cells, std::size_t cell);
/// Returns the volume of a cell, m³.
double extent(const Cells<3>& cells, std::size_t cell);

/// Returns the centroid of a cell, m.
Vec<2> centroid(const Cells<2>& cells, std::size_t cell);
Vec<3> centroid(const Cells<3>& cells, std::size_t cell);

/// Cell cut into zones.
template <int Dim>
struct ZonedCell {
  std::vector<int> vertices;                    ///< vertices of the cell, in the order in which it meets them
  std::vector<Vec<Dim>> gridpoints;             ///< places of the vertices, then the centroid; m
  std::vector<std::array<int, Dim + 1>> zones;  ///< gridpoints, positively oriented, the centroid last
};

/// Cuts a convex cell (corners counter-clockwise, m) into triangles around its centroid, one for each edge.
ZonedCell<2> zone_block(const std::vector<Vec<2>>& corners);
/// Cuts a cell into triangles around its centroid, one for each edge.
ZonedCell<2> zone_cell(const Cells<2>& cells, std::size_t cell);
/// Cuts a cell into tetrahedra around its centroid, one for each triangle of the fans of its faces.
ZonedCell<3> zone_cell(const Cells<3>& cells, std::size_t cell);

/// Seeds of a Laguerre (power) tessellation: a point belongs to the seed with the least
/// |x - position|^2 - radius^2.
template <int Dim>
struct Seeds {
  std::vector<Vec<Dim>> position;  ///< m
  std::vector<double> radius;      ///< radius of each seed, m; all equal: a Voronoi tessellation
};

}  // namespace pyroclast::specimen
