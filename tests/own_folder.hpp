#pragma once

#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace pyroclast {

/// Returns a folder for temporary files of this process: tests run side by side. It goes as the process ends.
inline const std::filesystem::path& own_folder() {
  struct Folder {
    Folder() : path(std::filesystem::temp_directory_path() / fmt::format("pyroclast_{}", ::getpid())) {
      std::filesystem::create_directories(path);
    }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
  };
  static const Folder folder;
  return folder.path;
}

}  // namespace pyroclast
