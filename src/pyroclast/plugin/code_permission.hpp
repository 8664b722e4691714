#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// Error of code that came with a deck or a study and that the user did not allow.
class CodeNotAllowed : public Error {
 public:
  CodeNotAllowed(const std::string& message, std::string code) : Error(message), code_(std::move(code)) {}

  /// Returns the name of the code, see CodePermission::require: of a law its file.
  const std::string& code() const { return code_; }

 private:
  std::string code_;
};

/// Policy on code: `never` runs only code that the command line names, `ask` also code that was allowed once,
/// `always` everything.
enum class CodePolicy : std::uint8_t { never, ask, always };

/// Permission of a user for code that comes with files: contact laws, functions and commands of studies. Code
/// is known by its hash, whatever its file is called and wherever it lies.
struct CodePermission {
  CodePolicy policy = CodePolicy::ask;
  bool allow = false;          ///< true where code met now is allowed from now on (--allow-code)
  std::filesystem::path list;  ///< list of the hashes that were allowed; empty where there is no place for it

  /// Returns the permission from the environment: PYROCLAST_CODE (never, ask or always), XDG_CONFIG_HOME or
  /// HOME (for the list). Throws Error for another word.
  static CodePermission of_environment();

  /// Returns where the code may run. Throws CodeNotAllowed where it may not, and Error where others may write
  /// the list, or it cannot be written.
  /// \param what   name of the code, for messages and in the list
  /// \param hash   SHA-256 of all code that runs
  /// \param named  true where the command line, or a script, names the code: it is then allowed from now on
  void require(const std::string& what, const std::string& hash, bool named = false) const;
};

/// Returns a header and, recursively, all files beside it that it includes in quotes. Throws Error where a
/// file cannot be read, or is included by a macro, so that it is not known.
std::vector<std::filesystem::path> files_of_header(const std::filesystem::path& header);

/// Returns the SHA-256 of code in several texts, or files, whatever these are called.
std::string hash_of_texts(const std::vector<std::string>& texts);
std::string hash_of_files(const std::vector<std::filesystem::path>& files);

}  // namespace pyroclast
