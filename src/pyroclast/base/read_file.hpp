#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pyroclast {

/// Throws Error, which names the path, for a device, a pipe or a folder: reading one may never end.
void require_regular_file(const std::filesystem::path& file);

/// Advice on how to write a path with backslashes in a deck.
inline constexpr std::string_view kPathsInToml =
    "in double quotes \"\\\" begins an escape: write \"/\" in paths, or set them in single quotes";
/// Returns advice for a path that holds control characters, as "sub\furnace.csv" in double quotes does; else
/// empty. The advice ends a message.
std::string remedy_of_path(std::string_view path);

/// Returns all bytes of a regular file. Throws Error, which names the path, when it is no regular file or
/// cannot be read.
std::string read_file(const std::filesystem::path& file);
/// Returns all bytes of a file that the user names, which may also be a pipe.
std::string read_named_file(const std::filesystem::path& file);

/// Returns the rest of the first line of a file of the system that begins with a name, without `=`, `:`,
/// blanks and quotes around it; "unknown" without one.
std::string entry_of(const std::filesystem::path& file, std::string_view name);

}  // namespace pyroclast
