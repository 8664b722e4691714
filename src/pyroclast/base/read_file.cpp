#include "pyroclast/base/read_file.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

void require_regular_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored))
    throw Error(fmt::format("{}: is no regular file", file.string()));
}

std::string remedy_of_path(std::string_view path) {
  const bool has_control = std::ranges::any_of(path, [](unsigned char c) { return c < 0x20; });
  return has_control ? fmt::format("; {}", kPathsInToml) : "";
}

std::string read_file(const std::filesystem::path& file) {
  require_regular_file(file);
  return read_named_file(file);
}

std::string read_named_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw Error(fmt::format("{}: cannot be read{}", file.string(), remedy_of_path(file.string())));
  return bytes;
}

std::string entry_of(const std::filesystem::path& file, std::string_view name) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(name)) continue;
    const auto begin = line.find_first_not_of("=:\t \"", name.size());
    const auto end = line.find_last_not_of(" \"");
    if (begin != std::string::npos && end >= begin) return line.substr(begin, end - begin + 1);
  }
  return "unknown";
}

}  // namespace pyroclast
