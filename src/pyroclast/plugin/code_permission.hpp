#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

/// Code that came with a deck or a study.
struct Code {
  std::string what;                          ///< name for messages and for the list; of a law its file
  std::string hash;                          ///< SHA-256 of all its texts
  std::vector<std::filesystem::path> files;  ///< files of a law, the first that which the deck names
  /// Reason why the hash does not cover all that runs; such code needs the user's permission each time. Else
  /// empty.
  std::string unknown;
};

/// Error of code that came with a deck or a study and that the user did not allow.
class CodeNotAllowed : public Error {
 public:
  CodeNotAllowed(const std::string& message, Code code) : Error(message), code_(std::move(code)) {}

  const Code& code() const { return code_; }

 private:
  Code code_;
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
  /// \param named  true where the command line, or a script, names the code: it is then allowed from now on
  void require(const Code& code, bool named = false) const;
};

}  // namespace pyroclast
