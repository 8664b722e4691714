#pragma once

#include <filesystem>
#include <istream>
#include <string>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Reads a two-dimensional Neper tessellation (.tess, format 2.0 to 3.x; Quey et al., CMAME 200, 2011) and
/// scales it to [0, width] x [0, height] (m). Its domain must be an upright rectangle of the same aspect
/// ratio (to 1e-6). Cells come in the file's order, counter-clockwise; vertices that no cell uses are
/// dropped. Throws Error, with file and line, when the file does not follow the format, and when the cells do
/// not tile the domain.
Tessellation read_neper_tess(const std::filesystem::path& file, double width, double height);
/// The same from a stream; `name` takes the file's place in messages.
Tessellation read_neper_tess(std::istream& stream, const std::string& name, double width, double height);
/// The same for a domain of any outline, which becomes that of the specimen (`outline_of`). It is scaled to a
/// width (m), and the box around it begins at [0, 0].
Tessellation read_neper_tess(const std::filesystem::path& file, double width);
Tessellation read_neper_tess(std::istream& stream, const std::string& name, double width);

}  // namespace pyroclast::specimen
