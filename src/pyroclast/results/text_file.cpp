#include "pyroclast/results/text_file.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"

namespace pyroclast {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw Error(fmt::format("{}: cannot be written ({})", path.string(), std::strerror(errno)));
}

}  // namespace

void write_text_file(const std::filesystem::path& path, const std::string& text) {
  if (path.empty()) return;
  std::filesystem::path partial = path;
  partial += ".partial";
  {
    const int file = open_aside(partial);
    if (file < 0 || !write_all(file, text.data(), text.size())) {
      const int cause = errno;
      if (file >= 0) close(file);
      std::error_code ignored;
      std::filesystem::remove(partial, ignored);
      errno = cause;
      fail(path);
    }
    close(file);
  }
  publish(partial, path);
}

LineFile::LineFile(std::filesystem::path path, const std::string& text) : path_(std::move(path)) {
  write_text_file(path_, text);
  if (path_.empty()) return;
  stream_.open(path_, std::ios::binary | std::ios::app);
  if (!stream_) fail(path_);
}

void LineFile::lines(const std::string& text) {
  if (path_.empty()) return;
  stream_ << text << std::flush;
  if (!stream_) fail(path_);
}

}  // namespace pyroclast
