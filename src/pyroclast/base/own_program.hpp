#pragma once

#include <filesystem>

namespace pyroclast {

/// Returns the file of the program that runs. A program of the tarball is run by the loader that lies beside
/// it in lib/; of it this is bin/pyroclast, which starts the loader. Empty where the system does not tell.
std::filesystem::path own_program();

/// Returns the folder into which the program is installed, above its bin/.
inline std::filesystem::path own_prefix() {
  return own_program().parent_path().parent_path();
}

}  // namespace pyroclast
