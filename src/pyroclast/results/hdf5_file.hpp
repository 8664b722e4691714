#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroclast {

/// HDF5 file being made, in memory. It appears under its name only when `close` succeeded, so a reader never
/// meets a half-written file. Every failure (a full disk, say) is an Error that names the file.
class Hdf5File {
 public:
  /// \param path  empty: the file is made, and written nowhere
  explicit Hdf5File(std::filesystem::path path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void group(const std::string& name);
  /// Writes a dataset, row-major; `columns` 0 gives a one-dimensional dataset.
  void dataset(const std::string& name, const std::vector<double>& values, int columns = 0);
  void dataset(const std::string& name, const std::vector<float>& values, int columns = 0);
  void dataset(const std::string& name, const std::vector<std::int64_t>& values, int columns = 0);
  void dataset(const std::string& name, const std::vector<std::int32_t>& values, int columns = 0);
  void dataset(const std::string& name, const std::vector<std::uint8_t>& values, int columns = 0);
  void dataset(const std::string& name, const std::vector<std::string>& values);
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, const std::vector<std::int64_t>& values);
  /// Links to an object of another file of the same folder.
  void external_link(const std::string& name, const std::string& file, const std::string& object);

  /// Returns the place of a dataset's bytes in the file; 0 where it has none.
  std::uint64_t place_of(const std::string& name) const;
  void close();
  /// Returns the bytes of the file in place of `close`, which writes them.
  std::string image();

  /// Tells whether a file is there, was written to its end and holds its data, see Hdf5Reader.
  static bool is_whole(const std::filesystem::path& path);

 private:
  void write(const std::string& name, std::int64_t type, const void* data, std::size_t count, int columns);
  void write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                       std::int64_t space, const void* data);
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::int64_t file_ = -1;
};

}  // namespace pyroclast
