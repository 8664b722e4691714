#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroclast {

/// File with the mesh of a run, to which the frames beside it link.
inline constexpr const char* kMeshFile = "mesh.h5";

/// HDF5 file of a run's fields, open to read: the only door to such files. The data of a run lie in its
/// folder. A file is damaged where a dataset of it lies in another file (external storage, virtual datasets),
/// where a link leads elsewhere than a frame's links into the mesh beside it, and where a filter that is not
/// a part of HDF5 packs data, for HDF5 would load code. The reader itself follows no link.
class Hdf5Reader {
 public:
  /// Throws Error where the file is no file of HDF5, or is damaged so.
  explicit Hdf5Reader(const std::filesystem::path& path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  /// Reads a dataset, row-major. Throws Error where there is no such dataset.
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& name) const;

 private:
  template <class Number>
  std::vector<Number> read(const std::string& name, std::int64_t type) const;

  std::filesystem::path path_;
  std::int64_t file_ = -1;
};

}  // namespace pyroclast
