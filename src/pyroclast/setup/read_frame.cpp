#include "pyroclast/setup/read_frame.hpp"

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"

namespace pyroclast {

namespace {

constexpr int kPlace = 3;  // components of a point in VTK files

}  // namespace

StressFree read_frame_temperatures(const std::filesystem::path& path, int dimension) {
  const auto of_file = [&](const std::filesystem::path& file, const auto& read) {
    try {
      return read(Hdf5Reader(file));
    } catch (const Error& error) {
      throw Error(fmt::format(
          "{}; it must be a frame of the blocks of a run, fields/blocks_0000.hdf or a later one, with "
          "{} beside it",
          error.what(), kMeshFile));
    }
  };
  const auto temperature = of_file(path, [](const Hdf5Reader& frame) {
    return frame.numbers(fmt::format("/VTKHDF/{}", kFrameTemperature));
  });
  const auto [points, corners, bearing] = of_file(path.parent_path() / kMeshFile, [](const Hdf5Reader& mesh) {
    return std::tuple(mesh.numbers("/blocks/Points"), mesh.integers("/blocks/Connectivity"),
                      mesh.integers("/blocks/bearing"));
  });
  const std::size_t of_a_zone = bearing.empty() ? 0 : corners.size() / bearing.size();
  if (of_a_zone == 3 + 4 - (dimension + 1U) && corners.size() == of_a_zone * bearing.size())
    throw Error(fmt::format("{}: is of a body in {}, but this one is in {}", path.string(),
                            dimension == 2 ? "space" : "the plane", dimension == 2 ? "the plane" : "space"));
  if (points.size() != kPlace * temperature.size() || of_a_zone != dimension + 1U ||
      corners.size() != of_a_zone * bearing.size())
    throw Error(fmt::format("{}: does not belong to the mesh.h5 beside it", path.string()));
  std::vector<bool> is_seen(temperature.size());
  StressFree field;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (bearing[i / of_a_zone] != 0) continue;
    const auto point = static_cast<std::size_t>(corners[i]);
    if (point >= temperature.size())
      throw Error(fmt::format("{}: does not belong to the mesh.h5 beside it", path.string()));
    if (is_seen[point]) continue;
    is_seen[point] = true;
    const double* const at = &points[kPlace * point];
    field.places.push_back({{at[0], at[1], at[2]}});
    field.temperatures.push_back(temperature[point]);
  }
  return field;
}

}  // namespace pyroclast
