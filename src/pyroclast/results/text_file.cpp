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

/// Writes a text beside the file whose name it is to have, and returns its path. Throws Error naming the
/// file.
std::filesystem::path written_aside(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path partial = path;
  partial += ".partial";
  const int file = open_aside(partial);
  if (file < 0 || !write_all(file, text.data(), text.size())) {
    const int cause = errno;
    if (file >= 0) {
      close(file);
      unlink(partial.c_str());
    }
    errno = cause;
    fail(path);
  }
  close(file);
  return partial;
}

}  // namespace

void write_text_file(const std::filesystem::path& path, const std::string& text) {
  if (!path.empty()) publish(written_aside(path, text), path);
}

void write_text_files(const std::vector<TextFile>& files) {
  std::vector<std::filesystem::path> partials;
  try {
    for (const TextFile& file : files) partials.push_back(written_aside(file.path, file.text));
  } catch (const Error&) {
    std::error_code ignored;
    for (const auto& partial : partials) std::filesystem::remove(partial, ignored);
    throw;
  }
  for (std::size_t i = 0; i < files.size(); ++i) publish(partials[i], files[i].path);
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
