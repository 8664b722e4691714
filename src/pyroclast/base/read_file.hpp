#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pyroclast {

/// Throws Error, which names it, for a device, a pipe or a folder: reading one may never end.
void require_regular_file(const std::filesystem::path& file);

/// How a path with backslashes is written in a deck.
inline constexpr std::string_view kPathsInToml =
    "in double quotes \"\\\" begins an escape: write \"/\" in paths, or set them in single quotes";
/// What to do about a path that holds control characters, as "sub\furnace.csv" in double quotes does; else
/// empty. To end a message with.
std::string remedy_of_path(std::string_view path);

/// All bytes of a regular file. Throws Error, which names it, when it is none or cannot be read.
std::string read_file(const std::filesystem::path& file);
/// The same of what the user names, which may be a pipe.
std::string read_named_file(const std::filesystem::path& file);

}  // namespace pyroclast
