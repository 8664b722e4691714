#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pyroclast {

/// A contact law that is not part of the program.
struct OwnLaw {
  std::string name;
  std::filesystem::path shared_object;
  std::filesystem::path header;  ///< that it was compiled from; may be empty
  std::string header_text;
  std::string compiler;
};

/// What a run was made from.
struct Manifest {
  std::string deck_name;
  std::string deck_text;  ///< as read, byte by byte
  std::uint64_t seed = 0;
  int threads = 1;
  std::string instructions;  ///< instruction set of the step
  std::string command;
  std::vector<OwnLaw> laws;
};

/// One folder holding everything of one run. Refused when it holds anything, unless overwriting was asked
/// for; even then only a folder with the manifest of a run is taken, and only files that a run writes are
/// removed from it.
class RunFolder {
 public:
  /// Checks that the folder can be made; leaves nothing behind. Throws Error otherwise.
  static void check(const std::filesystem::path& path, bool overwrite);

  /// Makes the folder, with `deck.toml` and `manifest.json` in it.
  RunFolder(std::filesystem::path path, bool overwrite, const Manifest& manifest);

  const std::filesystem::path& path() const { return path_; }
  /// Files that were in the folder and that no run writes: they are still there. Relative to it, in order.
  const std::vector<std::filesystem::path>& foreign() const { return foreign_; }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> foreign_;
};

}  // namespace pyroclast
