#pragma once

#include <cstdint>
#include <filesystem>

namespace pyroclast {

/// File by its descriptor, read and written at any place. Throws Error that names the file and the cause.
class File {
 public:
  static File to_read(const std::filesystem::path& path);
  /// Makes a file to write, see open_aside. \param named  its name in messages
  static File to_write(const std::filesystem::path& path, const std::filesystem::path& named);
  /// Opens a file to write that the first rank has made.
  static File of_other(const std::filesystem::path& path);
  ~File();
  File(File&& other) noexcept;
  File& operator=(File&&) = delete;

  void write(std::uint64_t from, const void* data, std::uint64_t bytes);
  /// Makes the file this long; what was not written is 0.
  void resize(std::uint64_t bytes);
  /// Waits until all is on disk.
  void sync();
  /// Reads bytes from a place on; returns false where the file ends before.
  bool read(std::uint64_t from, void* data, std::uint64_t bytes) const;
  std::uint64_t size() const;

 private:
  File(std::filesystem::path path, int descriptor, const char* why);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace pyroclast
