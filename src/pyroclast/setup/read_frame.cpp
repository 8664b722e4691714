#include "pyroclast/setup/read_frame.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <hdf5.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

constexpr int kPlace = 3;  // components of a point in VTK files

/// Frame that is open for reading. Links from it lead into the mesh beside it.
class Frame {
 public:
  explicit Frame(const std::filesystem::path& path) : path_(path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file_ < 0)
      throw Error(
          fmt::format("{}: is no file of HDF5; a frame of a run is fields/blocks_0000.hdf or a later one",
                      path.string()));
  }
  ~Frame() { H5Fclose(file_); }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  std::vector<double> numbers(const char* name) const { return read<double>(name, H5T_NATIVE_DOUBLE); }
  std::vector<std::int64_t> integers(const char* name) const {
    return read<std::int64_t>(name, H5T_NATIVE_INT64);
  }

 private:
  template <class Number>
  std::vector<Number> read(const char* name, hid_t type) const {
    const auto refuse = [&] {
      throw Error(
          fmt::format("{}: /VTKHDF/{} cannot be read: it must be a frame of the blocks of a run, with "
                      "mesh.h5 beside it",
                      path_.string(), name));
    };
    const hid_t set = H5Dopen2(file_, fmt::format("/VTKHDF/{}", name).c_str(), H5P_DEFAULT);
    if (set < 0) refuse();
    const hid_t space = H5Dget_space(set);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    std::vector<Number> values(count > 0 ? static_cast<std::size_t>(count) : 0);
    const bool is_read = count > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
    H5Dclose(set);
    if (!is_read) refuse();
    return values;
  }

  std::filesystem::path path_;
  hid_t file_ = -1;
};

}  // namespace

StressFree read_frame_temperatures(const std::filesystem::path& path, int dimension) {
  const Frame frame(path);
  const auto temperature = frame.numbers(kFrameTemperature);
  const auto points = frame.numbers("Points");
  const auto corners = frame.integers("Connectivity");
  const auto bearing = frame.integers("CellData/bearing");
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
