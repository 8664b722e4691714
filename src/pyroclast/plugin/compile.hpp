#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "pyroclast/mechanics/instruction_set.hpp"

namespace pyroclast {

/// How a law's header becomes a shared object.
struct LawCompiler {
  std::string program = "c++";  ///< the system's compiler
  /// Folder of the shared objects that were compiled before; only its owner may read and write it.
  std::filesystem::path cache;
  /// That the packs are compiled for.
  InstructionSet instructions = best_instruction_set();
  int dimension = 2;  ///< of the bodies that it is compiled for
  /// Is shown the command before it is run.
  std::function<void(const std::string& command)> tell = [](const std::string&) {};
  /// Called many times a second while the compiler runs; what it throws ends the compiler.
  std::function<void()> poll = [] {};
};

/// The type of the law in a header, such as "mine::Law": the struct that holds `static constexpr const char*
/// name`. Throws Error when there is none, or more than one.
/// \param file  that the text is of
std::string law_type(const std::filesystem::path& file, const std::string& text);

/// The shared object of a law, from the cache where the same was compiled before: the same text of all its
/// headers, wherever they lie, compiler, flags and layout. Throws Error with the compiler's words where it
/// does not compile.
///
/// \param type  of the law, as C++ names it
std::filesystem::path compile_law(const std::filesystem::path& header, const std::string& type,
                                  const LawCompiler& compiler);

}  // namespace pyroclast
