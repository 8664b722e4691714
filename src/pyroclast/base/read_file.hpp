#pragma once

#include <filesystem>
#include <string>

namespace pyroclast {

/// All bytes of a file. Throws Error, which names it, when it cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace pyroclast
