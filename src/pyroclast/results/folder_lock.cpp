#include "pyroclast/results/folder_lock.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"
#include "pyroclast/results/run_folder.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

std::error_code make_folders(const fs::path& path, std::vector<fs::path>& made) {
  // A folder above may vanish between two calls, where another run that was only checking removes it.
  constexpr int kAttempts = 10;
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) return {};
    if (fs::exists(status)) return std::make_error_code(std::errc::not_a_directory);
    const fs::path parent = path.parent_path();
    if (parent != path)
      if (const auto above = make_folders(parent, made)) return above;
    if (fs::create_directory(path, error)) made.push_back(path);
    if (error != std::errc::no_such_file_or_directory) return error;
  }
  return error;
}

/// Returns a path that is absolute, without dots and without a slash at the end.
fs::path plain(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

void remove_if_empty(const std::vector<fs::path>& folders) {
  std::error_code not_empty;
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) fs::remove(*folder, not_empty);
}

/// Tells whether the name still stands for the opened file, which the process that held it before may have
/// removed.
bool stands_for(const fs::path& name, int descriptor) {
  struct stat of_name {
  }, of_file{};
  return lstat(name.c_str(), &of_name) == 0 && fstat(descriptor, &of_file) == 0 &&
         of_name.st_ino == of_file.st_ino && of_name.st_dev == of_file.st_dev;
}

}  // namespace

std::vector<fs::path> make_folders(const fs::path& path) {
  std::vector<fs::path> made;
  if (const std::error_code error = make_folders(plain(path), made)) {
    remove_if_empty(made);
    throw Error(fmt::format("{}: cannot be made ({})", path.string(), error.message()));
  }
  return made;
}

FolderLock::FolderLock(fs::path folder) : folder_(std::move(folder)), made_(make_folders(folder_)) {
  const fs::path file = folder_ / "lock";
  require_no_link(file);
  struct stat there {};
  if (lstat(file.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
    throw Error(fmt::format("{}: is no regular file, and a run's lock is one", file.string()));
  do {
    if (descriptor_ >= 0) close(descriptor_);
    // The lock is not opened through a link to another file, and nobody waits for a pipe that nobody reads.
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (descriptor_ < 0) {
      const int cause = errno;
      remove_if_empty(made_);
      throw Error(fmt::format("{}: cannot be written ({})", file.string(), std::strerror(cause)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int cause = errno;
      close(descriptor_);
      std::string holder;
      std::ifstream(file) >> holder;
      if (cause != EWOULDBLOCK)
        throw Error(fmt::format("{}: cannot be locked ({})", file.string(), std::strerror(cause)));
      throw Error(
          holder == std::to_string(getpid())
              ? fmt::format("{}: another run of this process writes into this folder; close that run "
                            "first, or choose another folder",
                            folder_.string())
              : fmt::format("{}: another process{} writes into this folder; wait for its end, or choose "
                            "another folder",
                            folder_.string(), holder.empty() ? "" : fmt::format(" ({})", holder)));
    }
  } while (!stands_for(file, descriptor_));
  try {
    if (fstat(descriptor_, &there) == 0) require_one_name(file, there);
    RunFolder::require_no_links(folder_);
  } catch (const Error&) {
    fs::remove(file);
    close(descriptor_);
    throw;
  }
  const std::string self = fmt::format("{}\n", getpid());
  if (ftruncate(descriptor_, 0) == 0) [[maybe_unused]]
    const auto told = pwrite(descriptor_, self.data(), self.size(), 0);
}

FolderLock::~FolderLock() {
  std::error_code ignored;
  fs::remove(folder_ / "lock", ignored);
  close(descriptor_);
  remove_if_empty(made_);
}

}  // namespace pyroclast
