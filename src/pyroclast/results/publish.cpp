#include "pyroclast/results/publish.hpp"

#include <cerrno>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
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

std::string is_a_link(const std::filesystem::path& path, const char* more) {
  return fmt::format("{}: is a link, and nothing outside of a run's folder is written through it{}",
                     path.string(), more);
}

}  // namespace

void require_no_link(const std::filesystem::path& path) {
  struct stat there {};
  if (lstat(path.c_str(), &there) != 0) return;
  if (S_ISLNK(there.st_mode)) throw Error(is_a_link(path, "; remove it"));
  require_one_name(path, there);
}

void require_one_name(const std::filesystem::path& path, const struct stat& there) {
  if (S_ISREG(there.st_mode) && there.st_nlink > 1)
    throw Error(is_a_link(
        path,
        ": the same file has another name, as where a folder is copied by links (cp -l, rsync --link-dest); "
        "copy the folder whole (cp -r), and use the copy"));
}

int open_aside(const std::filesystem::path& partial) {
  constexpr mode_t kMode = 0666;  // as far as the user's mask allows
  unlink(partial.c_str());
  return open(partial.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode);
}

bool write_all(int descriptor, const void* data, std::size_t bytes) {
  for (std::span rest(static_cast<const char*>(data), bytes); !rest.empty();) {
    const ssize_t done = write(descriptor, rest.data(), rest.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    rest = rest.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

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
