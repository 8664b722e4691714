#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "pyroclast/base/lasting.hpp"
#include "pyroclast/laws/table.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/plugin/compile.hpp"

namespace pyroclast {

/// Sources of contact laws that are not part of the program.
struct LawSources {
  /// Folders that are searched for NAME.so, after the folder of the deck.
  std::vector<std::filesystem::path> folders;
  bool may_compile = true;
  CodePermission permission;
  /// Origin of the deck and of its changes: true where they name laws as the user does. This holds for the
  /// deck of a script and for values of --set, not for the values of a study file.
  bool deck_names = false, changes_name = true;
  LawCompiler compiler;

  /// Returns the sources from the environment: PYROCLAST_LAW_PATH (folders, with colons between them),
  /// PYROCLAST_NO_COMPILE (anything but empty or 0), CXX (the compiler), PYROCLAST_CACHE or XDG_CACHE_HOME
  /// (for compiled laws), and the user's permission for code (CodePermission).
  static LawSources of_environment();
};

/// Finds the law that a deck states:
///
///     cohesive              a law that is part of the program
///     mine                  mine.so beside the deck, or in one of the folders
///     path/mine.so          a shared object that pyroclast_add_law made
///     path/mine.hpp         a header, which is compiled first
///     path/mine.hpp:a::Law  a header that holds more than one law
///
/// Relative paths are taken from the folder of the deck. The law lives as long as the process. Throws
/// CodeNotAllowed where the law is code that the user did not allow, and Error when there is no such law, or
/// it is refused (open_law, compile_law).
/// \param named  true where the command line or a script, and no file, names the law: its code may then run.
///               Code in the folders may run in any case, because the user named them
PYROCLAST_LASTING const LawTable& find_law(std::string_view stated, const std::filesystem::path& deck_folder,
                                           const LawSources& sources, bool named = false);

}  // namespace pyroclast
