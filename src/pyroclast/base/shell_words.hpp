#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pyroclast {

/// Returns a word as a shell takes it: in quotes where it holds anything but letters and digits of ASCII and
/// "@%+=:,./_-", by the rule of Python's shlex.quote. A word with control characters is written as $'...',
/// which bash, zsh and ksh know, so that it stays on its line.
std::string shell_word(std::string_view word);

/// Returns a path as a shell takes it for a command that is to be given next. A path that begins with a dash
/// gets "./" in front, as it would be an option otherwise.
std::string shell_path(const std::filesystem::path& path);

/// Returns a command as a shell takes it, word by word.
std::string shell_command(const std::vector<std::string>& words);

}  // namespace pyroclast
