#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace pyroclast {

/// Returns the text of an error: nothing is written through a link in the folder of a run, for it leads
/// elsewhere.
std::string is_a_link(const std::filesystem::path& path);

/// Opens a new file to write; a file that had its name is removed, and no link is followed. Returns the
/// descriptor, or -1 with errno.
int open_aside(const std::filesystem::path& partial);
/// Writes all bytes; returns false, with errno, where that fails.
bool write_all(int descriptor, const void* data, std::size_t bytes);

/// Gives a file that was written aside its name, in place of the file that has that name. Whenever the
/// machine fails, the name stands for the whole new file or for the old one: the contents are on disk before
/// the name changes, and the name before this function returns. Throws Error naming `path`.
/// \param partial  closed, in the same folder as `path`; gone afterwards, also after an error
void publish(const std::filesystem::path& partial, const std::filesystem::path& path);

}  // namespace pyroclast
