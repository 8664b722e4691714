#pragma once

#include <filesystem>
#include <string>

namespace pyroclast {

/// Throws Error, which names it, for a device, a pipe or a folder: reading one may never end.
void require_regular_file(const std::filesystem::path& file);

/// All bytes of a regular file. Throws Error, which names it, when it is none or cannot be read.
std::string read_file(const std::filesystem::path& file);
/// The same of what the user names, which may be a pipe.
std::string read_named_file(const std::filesystem::path& file);

}  // namespace pyroclast
