#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "pyroclast/base/lasting.hpp"
#include "pyroclast/laws/table.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/plugin/compile.hpp"

namespace pyroclast {

/// Where contact laws that are not part of the program come from.
struct LawSources {
  /// Searched for NAME.so, after the folder of the deck.
  std::vector<std::filesystem::path> folders;
  bool may_compile = true;
  CodePermission permission;
  /// Whose words the deck and changes of it are: a script's deck, and what --set says, name laws as the user
  /// does; the values of a study file do not.
  bool deck_names = false, changes_name = true;
  LawCompiler compiler;

  /// As the environment says: PYROCLAST_LAW_PATH (folders, with colons between them), PYROCLAST_NO_COMPILE
  /// (anything but empty or 0), CXX (the compiler), PYROCLAST_CACHE or XDG_CACHE_HOME (for compiled laws),
  /// and the user's word on code (CodePermission).
  static LawSources of_environment();
};

/// The law that a deck states:
///
///     cohesive              one that is part of the program
///     mine                  mine.so beside the deck, or in one of the folders
///     path/mine.so          a shared object that pyroclast_add_law made
///     path/mine.hpp         a header, which is compiled first
///     path/mine.hpp:a::Law  likewise, where it holds more than one law
///
/// Relative paths are taken from the folder of the deck. The law lives as long as the process.
/// Throws CodeNotAllowed where it is code that the user did not allow, and Error when there is no such law,
/// or it is refused (open_law, compile_law). \param named  the command line or a script names it, and no
/// file; so it does what lies in the folders
PYROCLAST_LASTING const LawTable& find_law(std::string_view stated, const std::filesystem::path& deck_folder,
                                           const LawSources& sources, bool named = false);

}  // namespace pyroclast
