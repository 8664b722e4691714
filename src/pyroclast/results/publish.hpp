#pragma once

#include <cstddef>
#include <filesystem>

#include <sys/stat.h>

namespace pyroclast {

/// Throws Error where a file or folder, which may be missing, is a link: nothing is written through a link in
/// the folder of a run. A file that has another name (a hard link) is one, for the other name may lie
/// elsewhere.
void require_no_link(const std::filesystem::path& path);
/// Throws Error where an opened file has another name. \param there  result of fstat
void require_one_name(const std::filesystem::path& path, const struct stat& there);

/// Opens a new file to write and read; a file that had its name is removed, and no link is followed. Returns
/// the descriptor, or -1 with errno.
int open_aside(const std::filesystem::path& partial);
/// Writes all bytes; returns false, with errno, where that fails.
bool write_all(int descriptor, const void* data, std::size_t bytes);

/// Gives a file that was written aside its name, in place of the file that has that name. Whenever the
/// machine fails, the name stands for the whole new file or for the old one: the contents are on disk before
/// the name changes, and the name before this function returns. Throws Error naming `path`.
/// \param partial  closed, in the same folder as `path`; gone afterwards, also after an error
void publish(const std::filesystem::path& partial, const std::filesystem::path& path);

}  // namespace pyroclast
