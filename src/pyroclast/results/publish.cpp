#include "pyroclast/results/publish.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Waits until a file or folder is on disk.
std::error_code sync(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {errno, std::system_category()};
  const int cause = fsync(file) == 0 ? 0 : errno;
  close(file);
  return {cause, std::system_category()};
}

}  // namespace

void publish(const std::filesystem::path& partial, const std::filesystem::path& path) {
  std::error_code error = sync(partial);
  if (!error) std::filesystem::rename(partial, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
  } else {
    error = sync(path.has_parent_path() ? path.parent_path() : ".");
    // some file systems cannot sync a folder, and say so in this way
    if (error == std::errc::invalid_argument) error.clear();
  }
  if (error) throw Error(fmt::format("{}: cannot be written ({})", path.string(), error.message()));
}

}  // namespace pyroclast
