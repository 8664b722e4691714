#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace pyroclast {

/// The text of an error: nothing is written through a link in the folder of a run, for it leads elsewhere.
std::string is_a_link(const std::filesystem::path& path);

/// Opens a new file to write; what had its name is gone, and no link is followed. Returns its descriptor, or
/// -1 with errno.
int open_aside(const std::filesystem::path& partial);
/// Writes all of it; false, with errno, where that fails.
bool write_all(int descriptor, const void* data, std::size_t bytes);

/// Gives a file that was written aside its name, in place of what has that name. Whenever the machine fails,
/// the name stands for the whole new file or for the old one: the contents are on disk before the name
/// changes, and the name before this returns. \param partial  closed, in the same folder as `path`; gone
/// afterwards, also after an error Throws Error naming `path`.
void publish(const std::filesystem::path& partial, const std::filesystem::path& path);

}  // namespace pyroclast
