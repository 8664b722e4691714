#pragma once

#include <filesystem>

namespace pyroclast {

/// Gives a file that was written aside its name, in place of what has that name. Whenever the machine fails,
/// the name stands for the whole new file or for the old one: the contents are on disk before the name
/// changes, and the name before this returns. \param partial  closed, in the same folder as `path`; gone
/// afterwards, also after an error Throws Error naming `path`.
void publish(const std::filesystem::path& partial, const std::filesystem::path& path);

}  // namespace pyroclast
