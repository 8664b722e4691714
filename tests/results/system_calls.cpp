#include "results/system_calls.hpp"

#include <array>
#include <cerrno>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace pyroclast {

namespace {

SystemCalls* watching = nullptr;

std::string last_part(const std::filesystem::path& path) {
  return path.filename().string();
}

}  // namespace

SystemCalls::SystemCalls() {
  watching = this;
}

SystemCalls::~SystemCalls() {
  watching = nullptr;
}

}  // namespace pyroclast

using pyroclast::watching;

extern "C" int fsync(int file) {
  if (watching != nullptr) {
    const auto path = std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", file));
    watching->log.push_back("fsync " + pyroclast::last_part(path));
    if (watching->fsync_error != 0) {
      errno = watching->fsync_error;
      return -1;
    }
  }
  return static_cast<int>(syscall(SYS_fsync, file));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (watching != nullptr)
    watching->log.push_back(
        fmt::format("rename {} {}", pyroclast::last_part(from), pyroclast::last_part(to)));
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

extern "C" int mkdir(const char* path, mode_t mode) noexcept {
  if (watching != nullptr && watching->before_mkdir) watching->before_mkdir(path);
  return mkdirat(AT_FDCWD, path, mode);
}
