#pragma once

#include <filesystem>
#include <vector>

namespace pyroclast {

/// Lock on a folder for one process at a time, while the object lives, by a lock on the file `lock` in the
/// folder. When the process dies in any way, the system gives the folder back.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Throws Error when another process holds it, or it cannot be made.
  explicit FolderLock(std::filesystem::path folder);
  /// Removes the file, and folders that the lock made and that are still empty.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;
  int descriptor_ = -1;
};

/// Makes a folder and those above it that are missing. Throws Error when that is not possible.
/// \return the folders that were missing, the outermost first
std::vector<std::filesystem::path> make_folders(const std::filesystem::path& path);

}  // namespace pyroclast
