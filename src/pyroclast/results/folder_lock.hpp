#pragma once

#include <filesystem>
#include <vector>

namespace pyroclast {

/// Holds a folder for one process at a time, as long as it is there, by a lock on the file `lock` in it; when
/// the process dies in any way, the system gives it back.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Throws Error when another process holds it, or it cannot be made.
  explicit FolderLock(std::filesystem::path folder);
  /// Takes the file away, and folders that it made and that are still empty.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;
  int descriptor_ = -1;
};

/// Makes a folder and those above it that are missing. Throws Error when that is not possible.
/// \return those that were not there, the outermost first
std::vector<std::filesystem::path> make_folders(const std::filesystem::path& path);

}  // namespace pyroclast
