#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Cells of a Neper tessellation, and the groups into which its file puts them.
struct NeperTess {
  Cells<2> cells;
  std::vector<int> group;  ///< group of each cell in the file (*group); empty where it has none
  int group_line = 0;      ///< line of the file with *group
  std::vector<int> empty;  ///< numbers of the cells without vertices, from 1, which are left out
};

/// Size of a tessellation: one of the two members.
struct TessSize {
  double width = 0.0;  ///< width of the box around the tessellation, m
  double unit = 0.0;   ///< unit of the file's coordinates, m
};

/// Reads a two-dimensional Neper tessellation (.tess, format 2.0 to 3.x; Quey et al., CMAME 200, 2011) and
/// scales it to [0, width] x [0, height] (m). Its domain must be an upright rectangle of the same aspect
/// ratio (to 1e-6). Cells come in the file's order, counter-clockwise; vertices that no cell uses are
/// dropped, and so are cells without vertices. A cell that bends inwards, as Neper's regularisation leaves
/// some, is cut into convex parts. A tessellation in any plane of space is laid flat: x stays the file's x as
/// far as this lies in the plane, or else its y; y points to where the file's y does, or else its z. Throws
/// Error, with file and line, when the file does not follow the format, when it is periodic, and when the
/// cells do not lie in a plane or do not tile the domain; messages count cells from 1, as the file does.
NeperTess read_neper_tess(const std::filesystem::path& file, double width, double height);
/// Reads a Neper tessellation from a stream; `name` takes the file's place in messages.
NeperTess read_neper_tess(std::istream& stream, const std::string& name, double width, double height);
/// Reads a Neper tessellation with a domain of any outline, which becomes the specimen's outline
/// (`outline_of`). The box around it begins at [0, 0].
NeperTess read_neper_tess(const std::filesystem::path& file, const TessSize& size);
NeperTess read_neper_tess(std::istream& stream, const std::string& name, const TessSize& size);

}  // namespace pyroclast::specimen
