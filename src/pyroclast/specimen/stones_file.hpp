#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pyroclast/specimen/specimen.hpp"

namespace pyroclast::specimen {

/// Reads stones in space from a file in the Wavefront format: vertices (`v`), faces (`f`), which are cut into
/// triangles, and objects (`o`), each a stone. `usemtl` names its phase, and `s 1` or more tells that it is
/// smooth; other lines are not read. Throws Error, with the line, for what is no stone.
/// \param unit   length of 1 in the file, m
/// \param phase  phase of stones without a name of their own
std::vector<KnownStone<3>> read_stones_obj(const std::filesystem::path& file, double unit,
                                           const std::string& phase);

/// Returns the text of such a file, in m: of all stones, balls among them as many triangles.
std::string stones_obj(std::span<const Stone<3>> stones, std::span<const std::string> phases);

}  // namespace pyroclast::specimen
