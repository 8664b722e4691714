#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/base/ranks.hpp"
#include "pyroclast/results/file.hpp"

namespace pyroclast {

/// HDF5 file being made. It appears under its name only when `close` succeeded, so a reader never meets a
/// half-written file. Every failure (a full disk, say) is an Error that names the file.
///
/// The library writes what describes the datasets. Their rows go to the disk as they come, so a file takes
/// little memory however large it is.
class Hdf5File {
 public:
  /// \param path   empty: nothing is made, and all functions do nothing; but see `share`
  /// \param ranks  ranks that make the file together: all call the same functions in the same order, but
  ///               `rows`. Only the first has a path.
  explicit Hdf5File(std::filesystem::path path, Ranks& ranks = one_rank());
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void group(const std::string& name);
  /// Makes a dataset whose rows come later; `columns` 0 gives a one-dimensional one.
  /// \tparam T  double, float, std::int64_t, std::int32_t or std::uint8_t
  template <class T>
  void room(const std::string& name, std::int64_t rows, int columns = 0);
  /// Lets each rank write rows of the datasets that have room so far: a collective. Rows that come before it
  /// are written by the first rank alone.
  void share();
  /// Writes rows of a dataset, from a row on.
  /// \tparam T  type of the dataset
  template <class T>
  void rows(const std::string& name, std::int64_t first, const std::vector<T>& values) {
    write(name, first, values.data(), values.size() * sizeof(T));
  }
  /// Writes a whole dataset, row-major.
  template <class T>
  void dataset(const std::string& name, const std::vector<T>& values, int columns = 0) {
    room<T>(name, static_cast<std::int64_t>(values.size()) / (columns > 0 ? columns : 1), columns);
    rows(name, 0, values);
  }
  void dataset(const std::string& name, const std::vector<std::string>& values);
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, const std::vector<std::int64_t>& values);
  /// Links to an object of another file of the same folder.
  void external_link(const std::string& name, const std::string& file, const std::string& object);

  /// Returns the place of a dataset's bytes in the file; 0 where it has none.
  std::uint64_t place_of(const std::string& name) const { return rooms_.at(name).place; }
  /// Ends what HDF5 knows of, and appends what `more` makes of the file as it is then.
  void append(const std::function<std::string(const File&)>& more);
  /// Waits until the rows of all ranks are on disk, and gives the file its name: a collective. A rank whose
  /// rows cannot be written throws its Error here.
  void close();

  /// Tells whether a file is there, was written to its end and holds its data, see Hdf5Reader.
  static bool is_whole(const std::filesystem::path& path);

 private:
  friend struct Hdf5Driver;
  struct Room {
    std::uint64_t place = 0, row = 0;  // of its first byte; bytes of a row
  };

  bool describes() const { return file_ >= 0; }
  void make_room(const std::string& name, std::int64_t type, std::int64_t rows, int columns);
  void write(const std::string& name, std::int64_t first, const void* data, std::size_t bytes);
  void write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                       std::int64_t space, const void* data);
  void give_up();
  std::filesystem::path partial() const { return path_.string() + ".partial"; }
  /// Calls `act`, whose Error the library must not meet: `end` throws it.
  void attempt(const std::function<void()>& act);
  void end();
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  Ranks* ranks_;
  std::optional<File> disk_;
  std::exception_ptr failure_;
  std::int64_t file_ = -1;
  std::map<std::string, Room> rooms_;
};

}  // namespace pyroclast
