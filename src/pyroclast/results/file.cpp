#include "pyroclast/results/file.hpp"

#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"

namespace pyroclast {

namespace {

constexpr const char* kNotRead = "cannot be read";
constexpr const char* kNotWritten = "cannot be written";

}  // namespace

File File::to_read(const std::filesystem::path& path) {
  return {path, open(path.c_str(), O_RDONLY | O_CLOEXEC), kNotRead};
}

File File::to_write(const std::filesystem::path& path, const std::filesystem::path& named) {
  return {named, open_aside(path), kNotWritten};
}

File File::of_other(const std::filesystem::path& path) {
  return {path, open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC),
          "cannot be opened by this rank, though the first one has made it: all ranks need one file system"};
}

File::File(std::filesystem::path path, int descriptor, const char* why)
    : path_(std::move(path)), descriptor_(descriptor) {
  if (descriptor_ < 0) fail(why);
}

File::~File() {
  if (descriptor_ >= 0) close(descriptor_);
}

File::File(File&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

void File::write(std::uint64_t from, const void* data, std::uint64_t bytes) {
  for (std::span rest(static_cast<const char*>(data), bytes); !rest.empty();) {
    const ssize_t done =
        pwrite(descriptor_, rest.data(), rest.size(), static_cast<off_t>(from + bytes - rest.size()));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail(kNotWritten);
    rest = rest.subspan(static_cast<std::size_t>(done));
  }
}

void File::resize(std::uint64_t bytes) {
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) fail(kNotWritten);
}

void File::sync() {
  if (fsync(descriptor_) != 0) fail(kNotWritten);
}

bool File::read(std::uint64_t from, void* data, std::uint64_t bytes) const {
  for (std::span rest(static_cast<char*>(data), bytes); !rest.empty();) {
    const ssize_t done =
        pread(descriptor_, rest.data(), rest.size(), static_cast<off_t>(from + bytes - rest.size()));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(kNotRead);
    if (done == 0) return false;
    rest = rest.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

std::uint64_t File::size() const {
  const off_t end = lseek(descriptor_, 0, SEEK_END);
  if (end < 0) fail(kNotRead);
  return static_cast<std::uint64_t>(end);
}

void File::fail(const char* what) const {
  throw Error(fmt::format("{}: {} ({})", path_.string(), what, std::strerror(errno)));
}

}  // namespace pyroclast
