#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pyroclast {

/// Text that the compiler's preprocessor makes of a law's header. This text is hashed and compiled; the
/// header is not read again.
struct LawText {
  std::filesystem::path header;
  /// Files of the user that the text comes from, the header first: all but those of the compiler, of the
  /// system and of this program.
  std::vector<std::filesystem::path> files;
  std::string text;        ///< preprocessed text with the compiler's line marks
  std::string own;         ///< part of the text that stands in the header itself
  std::string normalised;  ///< text that does not tell where the user's files lie
  std::string hash;        ///< SHA-256 of the user's files and of the user's part of the text
  std::string version;     ///< version of the compiler
};

/// Returns the files of a rule of Make, as compilers and assemblers write it (`-MD`), without the target.
std::vector<std::filesystem::path> files_of_rule(const std::string& rule);

/// Reads a preprocessed text. Throws Error where a line of the text is a directive that a compiler would
/// follow, or a file of the user cannot be read.
/// \param rule          rule of Make that names the files of the text
/// \param is_installed  tells of a file whether it belongs to the compiler, the system or this program
LawText read_law_text(const std::filesystem::path& header, std::string text, const std::string& rule,
                      const std::function<bool(const std::filesystem::path&)>& is_installed);

}  // namespace pyroclast
